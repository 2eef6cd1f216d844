// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How PatchDrawing finds and makes vertices. Included at the end of patch_drawing.hpp.
#pragma once

namespace nestgrid::engine {

/// Finds the vertices on the cuts, and numbers new ones in the order of the cuts. Each step is a
/// branch-free loop of its own, because whether a vertex is known is unpredictable.
template <int dimension, class Real, class Patches>
NESTGRID_NOINLINE void PatchDrawing<dimension, Real, Patches>::find_vertices(
    std::span<const BatchEdge> cuts, Number* v) {
    using InSubtree = SubtreeNodes<pattern_>;
    constexpr std::size_t room = Run::most_cuts + 1;
    const NodeKey* const key = patches_->keys[0];
    const SubtreeNode* const in_subtree = patches_->in_subtree[0];

    // Step 1: list the cuts that the subtree tables do not know (`fresh`), and among these the cuts
    // that other subtrees may know (`shared`).
    std::array<std::uint16_t, room> fresh;
    SubtreeVertices& within = surface_->within();
    VertexNumbers& numbers = surface_->numbers();
    const std::size_t fresh_count = within.find(
        cuts.size(),
        [&](std::size_t i) NESTGRID_INLINE_LAMBDA {
            return InSubtree::edge_number(in_subtree[cuts[i].low], in_subtree[cuts[i].high]);
        },
        v, fresh.data());
    std::array<std::uint16_t, room> shared;  // indices into `fresh`
    std::size_t shared_count = 0;
    for (std::size_t i = 0; i < fresh_count; ++i) {
        const auto& [low, high] = cuts[fresh[i]];
        shared[shared_count] = static_cast<std::uint16_t>(i);
        shared_count += InSubtree::is_inside(in_subtree[low], in_subtree[high]) ? 0 : 1;
    }

    // Step 2: look the shared cuts up by name. A new one gets the number that it has when all
    // fresh cuts before it are new.
    std::array<VertexNumbers::Name, room> names;
    numbers.reserve(shared_count);
    for (std::size_t k = 0; k < shared_count; ++k) {
        const auto& [low, high] = cuts[fresh[shared[k]]];
        names[k] = numbers.name({key[low], key[high]});
        numbers.prefetch(names[k]);
    }
    const std::span<Number> number = within.new_numbers();
    std::fill(number.begin(), number.end(), Surface::none);
    const Number first_new = surface_->builder().next_vertex();
    if (Surface::none - first_new < fresh_count) throw_too_many_vertices();
    Number next = first_new;  // minus the number of shared cuts that were known
    for (std::size_t k = 0; k < shared_count; ++k) {
        const std::size_t at = shared[k];
        const auto found = numbers.find_or_add(names[k], next + static_cast<Number>(at));
        number[at] = found.number | (found.is_new ? Surface::none : 0U);
        next -= found.is_new ? 0U : 1U;
    }

    // Step 3: number the new vertices, and add them.
    std::array<BatchEdge, room> added;
    std::size_t count = 0;
    for (std::size_t i = 0; i < fresh_count; ++i) {
        const bool is_new = number[i] == Surface::none;
        number[i] = std::min(number[i], first_new + static_cast<Number>(count));
        added[count] = cuts[fresh[i]];
        count += is_new ? 1 : 0;
    }
    add_vertices(std::span(added).first(count));
    within.end({v, cuts.size()});
    if (surface_->verifies()) verify_vertices(cuts, v);
}

/// Makes a new vertex on every cut.
template <int dimension, class Real, class Patches>
NESTGRID_NOINLINE void PatchDrawing<dimension, Real, Patches>::make_vertices(
    std::span<const BatchEdge> cuts, Number* v) {
    const Number first_new = surface_->builder().next_vertex();
    for (std::size_t i = 0; i < cuts.size(); ++i) v[i] = first_new + static_cast<Number>(i);
    add_vertices(cuts);
}

/// Adds a vertex on each of these cuts to the builder, in order.
template <int dimension, class Real, class Patches>
NESTGRID_INLINE void PatchDrawing<dimension, Real, Patches>::add_vertices(
    std::span<const BatchEdge> cuts) {
    std::array<WidePoint, Run::most_cuts> x;
    cut(cuts, true, x.data());
    std::array<double, Run::most_cuts> carried;
    if (target_->carries) carry(cuts, carried.data());
    const auto attributes = [&](std::size_t i) -> std::span<const double> {
        return {carried.data() + i, target_->carries ? 1U : 0U};
    };
    auto& builder = surface_->builder();
    if (!builder.lists_shared()) {
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            builder.add_vertex(Point(x[i]), attributes(i));
        }
        return;
    }
    const NodeKey* const key = patches_->keys[0];
    const SubtreeNode* const in_subtree = patches_->in_subtree[0];
    constexpr double not_asked_for = 0;  // patches make normals at once
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const auto& [low, high] = cuts[i];
        if (is_within_root(in_subtree[low], in_subtree[high])) {
            builder.add_vertex(Point(x[i]), attributes(i));
        } else {
            builder.add_shared({key[low], key[high]}, not_asked_for, Point(x[i]), attributes(i));
        }
    }
}

/// Sets to[i] to the point at which the level cuts cuts[i].
/// \param adds whether these are new vertices, whose normals are added, too, where they have some
template <int dimension, class Real, class Patches>
NESTGRID_INLINE void PatchDrawing<dimension, Real, Patches>::cut(std::span<const BatchEdge> cuts,
                                                                 bool adds, WidePoint* to) {
    if (!target_->finest && !target_->normals) return patches_->cuts(cuts, cut_level(), to);
    cut_pieces(cuts, adds, to);
}

/// Sets to[i] as cut() does, but piece by piece: for normals, and for cuts on finest pieces.
template <int dimension, class Real, class Patches>
NESTGRID_NOINLINE void PatchDrawing<dimension, Real, Patches>::cut_pieces(
    std::span<const BatchEdge> cuts, bool adds, WidePoint* to) {
    const bool normals = adds && target_->normals;
    const Real* const value = patches_->values[0];
    std::array<EdgePiece, most_pieces> some;
    while (!cuts.empty()) {
        const auto now = cuts.first(std::min(cuts.size(), some.size()));
        patches_->pieces(now, {level_->value, target_->finest, normals}, some.data());
        for (std::size_t i = 0; i < now.size(); ++i) {
            const EdgePiece& piece = some[i];
            const double fraction = level_->fraction(piece.value[0], piece.value[1]);
            const WidePoint low(piece.x[0]);
            *to++ = low + fraction * (WidePoint(piece.x[1]) - low);
            if (normals) {
                surface_->add_normal((1 - fraction) * piece.gradient[0] +
                                     fraction * piece.gradient[1]);
            }
            if (adds && piece.along[1] - piece.along[0] < 1) {
                const double along = piece.along[0] + fraction * (piece.along[1] - piece.along[0]);
                const double low_u = static_cast<double>(value[now[i].low]) - level_->value;
                const double high_u = static_cast<double>(value[now[i].high]) - level_->value;
                surface_->report().raise_off_level(low_u + along * (high_u - low_u));
            }
        }
        cuts = cuts.subspan(now.size());
    }
}

/// Sets to[i] to the value that the vertex on cuts[i] carries.
template <int dimension, class Real, class Patches>
NESTGRID_NOINLINE void PatchDrawing<dimension, Real, Patches>::carry(
    std::span<const BatchEdge> cuts, double* to) const {
    std::array<std::uint16_t, 2 * Run::most_cuts> places;
    std::array<double, 2 * Run::most_cuts> at;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        places[2 * i] = cuts[i].low;
        places[2 * i + 1] = cuts[i].high;
    }
    patches_->carried(std::span(places).first(2 * cuts.size()), at.data());
    const Real* const value = patches_->values[0];
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const double fraction = level_->fraction(static_cast<double>(value[cuts[i].low]),
                                                 static_cast<double>(value[cuts[i].high]));
        to[i] = at[2 * i] + fraction * (at[2 * i + 1] - at[2 * i]);
    }
}

/// Tells the surface which of the cuts' vertices lie at nodes.
template <int dimension, class Real, class Patches>
NESTGRID_NOINLINE void PatchDrawing<dimension, Real, Patches>::put_at_nodes(
    std::span<const BatchEdge> cuts, const Number* v) {
    const Real* const value = patches_->values[0];
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const std::uint16_t node = cuts[i].high;
        if (static_cast<double>(value[node]) != level_->value || surface_->is_at_node(v[i])) {
            continue;
        }
        double carried = 0;
        if (target_->carries) patches_->carried(std::span(&node, 1), &carried);
        surface_->put_at_node(v[i], {patches_->keys[0][node], patches_->position(node)},
                              {&carried, target_->carries ? 1U : 0U});
    }
}

/// Verifies that the vertex on every cut lies there.
template <int dimension, class Real, class Patches>
NESTGRID_NOINLINE void PatchDrawing<dimension, Real, Patches>::verify_vertices(
    std::span<const BatchEdge> cuts, const Number* v) {
    std::array<WidePoint, Run::most_cuts> x;
    cut(cuts, false, x.data());
    for (std::size_t i = 0; i < cuts.size(); ++i) surface_->verify(v[i], Point(x[i]));
}

}  // namespace nestgrid::engine
