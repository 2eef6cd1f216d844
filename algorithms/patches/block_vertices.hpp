// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The vertices on the cuts of all that is drawn together of known bisections; included by
// block_drawing.hpp.
#pragma once

#include <patches/block_drawing.hpp>

namespace nestgrid::engine {

/// The vertices on the cuts, numbered in their order. Each step is a loop of its own, without a
/// branch that depends on which of them are known.
template <class Visitor, class Blocks>
NESTGRID_NOINLINE void BlockDrawing<Visitor, Blocks>::find_vertices(std::span<const BatchEdge> cuts,
                                                                    Number* v) {
    using InSubtree = SubtreeNodes<pattern_>;
    constexpr std::size_t room = Run::most_cuts + 1;
    const NodeKey* const key = blocks_->keys[0];
    const SubtreeNode* const in_subtree = blocks_->in_subtree[0];

    // Which of them the subtrees do not know, and of those the ones that may be known elsewhere.
    std::array<std::uint16_t, room> fresh;
    const std::size_t fresh_count = layer_->within.find(
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
    layer_->number_of.reserve(shared_count);
    for (std::size_t k = 0; k < shared_count; ++k) {
        const auto& [low, high] = cuts[fresh[shared[k]]];
        names[k] = layer_->number_of.name({key[low], key[high]});
        layer_->number_of.prefetch(names[k]);
    }
    const std::span<Number> number = layer_->within.new_numbers();
    std::fill(number.begin(), number.end(), Visitor::none);
    if (Visitor::none - layer_->vertex_count < fresh_count) throw_too_many_vertices();
    Number next = layer_->vertex_count;  // less the shared ones that are known
    for (std::size_t k = 0; k < shared_count; ++k) {
        const std::size_t at = shared[k];
        const auto found = layer_->number_of.find_or_add(names[k], next + static_cast<Number>(at));
        number[at] = found.number | (found.is_new ? Visitor::none : 0U);
        next -= found.is_new ? 0U : 1U;
    }

    // What is new gets its number, and is added.
    std::array<BatchEdge, room> added;
    std::size_t count = 0;
    for (std::size_t i = 0; i < fresh_count; ++i) {
        const bool is_new = number[i] == Visitor::none;
        number[i] = std::min(number[i], layer_->vertex_count + static_cast<Number>(count));
        added[count] = cuts[fresh[i]];
        count += is_new ? 1 : 0;
    }
    add_vertices(std::span(added).first(count));
    layer_->within.end({v, cuts.size()});
    if (visitor_->options_->verify) verify_vertices(cuts, v);
}

template <class Visitor, class Blocks>
NESTGRID_INLINE void BlockDrawing<Visitor, Blocks>::add_vertices(std::span<const BatchEdge> cuts) {
    std::array<WidePoint, Run::most_cuts> x;
    blocks_->cuts(cuts, layer_->isovalue, x.data());
    layer_->vertex_count += static_cast<Number>(cuts.size());
    if (!visitor_->is_task_) {
        for (std::size_t i = 0; i < cuts.size(); ++i) layer_->sink.add_vertex(Point(x[i]), {});
    } else {
        const NodeKey* const key = blocks_->keys[0];
        const SubtreeNode* const in_subtree = blocks_->in_subtree[0];
        constexpr double not_asked_for = 0;  // with normals bisections are not walked
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            const auto& [low, high] = cuts[i];
            if (is_within_root(in_subtree[low], in_subtree[high])) {
                layer_->sink.add_vertex(Point(x[i]), {});
            } else {
                layer_->sink.add_shared({key[low], key[high]}, not_asked_for, Point(x[i]), {});
            }
        }
    }
}

template <class Visitor, class Blocks>
NESTGRID_NOINLINE void BlockDrawing<Visitor, Blocks>::verify_vertices(
    std::span<const BatchEdge> cuts, const Number* v) {
    std::array<WidePoint, Run::most_cuts> x;
    blocks_->cuts(cuts, layer_->isovalue, x.data());
    for (std::size_t i = 0; i < cuts.size(); ++i) visitor_->verify(*layer_, v[i], Point(x[i]));
}

}  // namespace nestgrid::engine
