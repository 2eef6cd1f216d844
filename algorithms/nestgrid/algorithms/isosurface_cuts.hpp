// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cuts of all that is drawn together of known bisections: where they lie, and the vertices on
// them; included by isosurface_steps.hpp.
#pragma once

#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid::detail {

/// The vertices on the cuts, numbered in their order. Each step is a loop of its own, without a
/// branch that depends on which of them are known.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_NOINLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::find_vertices(
    const Blocks& blocks, Layer& layer, std::span<const BatchEdge> cuts, Number* v) {
    using InSubtree = SubtreeNodes<Blocks::pattern>;
    constexpr std::size_t room = BlockContourRun<Blocks::pattern>::most_cuts + 1;
    const NodeKey* const key = blocks.keys[0];
    const SubtreeNode* const in_subtree = blocks.in_subtree[0];

    // Which of them the subtrees do not know, and of those the ones that may be known elsewhere.
    std::array<std::uint16_t, room> fresh;
    const std::size_t fresh_count = layer.within.find(
        cuts.size(),
        [&](std::size_t i) NESTGRID_INLINE_LAMBDA {
            return InSubtree::edge_number(in_subtree[cuts[i].low], in_subtree[cuts[i].high]);
        },
        v, fresh.data());
    std::array<std::uint16_t, room> shared;  // of `fresh`
    std::size_t shared_count = 0;
    for (std::size_t i = 0; i < fresh_count; ++i) {
        const auto& [low, high] = cuts[fresh[i]];
        shared[shared_count] = static_cast<std::uint16_t>(i);
        shared_count += InSubtree::is_inside(in_subtree[low], in_subtree[high]) ? 0 : 1;
    }

    // Those are looked up; all before them count that are new.
    std::array<VertexNumbers::Name, room> names;
    layer.number_of.reserve(shared_count);
    for (std::size_t k = 0; k < shared_count; ++k) {
        const auto& [low, high] = cuts[fresh[shared[k]]];
        names[k] = layer.number_of.name({key[low], key[high]});
        layer.number_of.prefetch(names[k]);
    }
    const std::span<Number> number = layer.within.new_numbers();
    std::fill(number.begin(), number.end(), none);
    if (none - layer.vertex_count < fresh_count) throw_too_many_vertices();
    Number next = layer.vertex_count;  // less the shared ones that are known
    for (std::size_t k = 0; k < shared_count; ++k) {
        const std::size_t at = shared[k];
        const auto found = layer.number_of.find_or_add(names[k], next + static_cast<Number>(at));
        number[at] = found.number | (found.is_new ? none : 0U);
        next -= found.is_new ? 0U : 1U;
    }

    // What is new gets its number, and is added.
    std::array<BatchEdge, room> added;
    std::size_t count = 0;
    for (std::size_t i = 0; i < fresh_count; ++i) {
        const bool is_new = number[i] == none;
        number[i] = std::min(number[i], layer.vertex_count + static_cast<Number>(count));
        added[count] = cuts[fresh[i]];
        count += is_new ? 1 : 0;
    }
    add_vertices(blocks, layer, std::span(added).first(count));
    layer.within.end({v, cuts.size()});
    if (options_->verify) verify_vertices(blocks, layer, cuts, v);
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::add_vertices(
    const Blocks& blocks, Layer& layer, std::span<const BatchEdge> cuts) {
    std::array<WidePoint, BlockContourRun<Blocks::pattern>::most_cuts> x;
    blocks.cuts(cuts, layer.isovalue, x.data());
    layer.vertex_count += static_cast<Number>(cuts.size());
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        if constexpr (logs) {
            const auto& [low, high] = cuts[i];
            const SubtreeNode* const in_subtree = blocks.in_subtree[0];
            if (!is_within_root(in_subtree[low], in_subtree[high])) {
                const NodeKey* const key = blocks.keys[0];
                constexpr double not_asked_for = 0;  // with normals bisections are not walked
                layer.sink.add_cut({Point(x[i]), {key[low], key[high]}, not_asked_for, {}});
                continue;
            }
        }
        layer.sink.add_vertex(Point(x[i]), {});
    }
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_NOINLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::verify_vertices(
    const Blocks& blocks, const Layer& layer, std::span<const BatchEdge> cuts, const Number* v) {
    std::array<WidePoint, BlockContourRun<Blocks::pattern>::most_cuts> x;
    blocks.cuts(cuts, layer.isovalue, x.data());
    for (std::size_t i = 0; i < cuts.size(); ++i) verify(layer, v[i], Point(x[i]));
}

}  // namespace nestgrid::detail
