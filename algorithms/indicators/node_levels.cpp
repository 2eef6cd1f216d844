// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/node_levels.hpp>

#include <algorithm>
#include <limits>

#include <indicators/fine_to_coarse.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>
#include <walk/for_each_element.hpp>
#include <walk/hanging_nodes.hpp>

namespace nestgrid {

namespace {

/// Minus the level: what is greater is coarser.
using Heights = engine::NodeMaxima<std::int16_t>;

constexpr std::int16_t unknown = std::numeric_limits<std::int16_t>::min();
constexpr std::int16_t outside = 1;

/// Sets the heights of the corners of coarse elements and of the new nodes of a split.
void add_element(const engine::Walk<float>& walk, const engine::ElementView<float>& view,
                 const engine::Split& split, Heights& heights) {
    const std::size_t corners = view.corner_count();
    std::array<NodeKey, max_corners> keys;
    std::array<std::size_t, max_corners + max_new_nodes> nodes;
    walk.corners(view, keys.data(), nullptr);
    heights.find(std::span(keys).first(corners), nodes);
    for (std::size_t i = 0; view.level == 0 && i < corners; ++i) heights[nodes[i]] = 0;
    if (split.rule == nullptr) return;
    heights.find(split.keys, std::span(nodes).subspan(corners));
    const auto height = static_cast<std::int16_t>(-view.level - 1);
    for (std::size_t n = 0; n < split.keys.size(); ++n) {
        std::int16_t& at = heights[nodes[corners + n]];
        if (at != outside) at = at == unknown ? height : std::min(at, height);
        if ((split.outside >> n & 1U) != 0) at = outside;
    }
    heights.add_split(view.level, *split.rule, std::span(nodes).first(corners + split.keys.size()));
}

}  // namespace

NodeLevels::NodeLevels(const Hierarchy<float>& hierarchy) : epoch_{hierarchy.epoch()} {
    HangingNodes hanging;  // S holds at no crossing node
    if (hierarchy.offers(Feature::hanging_parents)) {
        hanging = engine::derive_hanging_nodes(hierarchy);
    }
    const engine::SharedNodes* const shared = hierarchy.facts().shared;
    Heights heights(hierarchy.facts().node_count, unknown);
    engine::together(shared, "levels of nodes", [&] {
        if (shared != nullptr) engine::require_same_state(hierarchy);
        const engine::Walk<float> walk(hierarchy, {.values = false, .keys = true, .on_ranks = true},
                                       &hanging);
        engine::for_each_element(
            walk, true, [&](const engine::ElementView<float>& view, const engine::Split& split) {
                add_element(walk, view, split, heights);
            });
    });
    // No node is outside on distributed grids, which have no elements outside.
    if (shared != nullptr) heights.lower_across(*shared);
    heights.saturate(shared);
    heights_ = heights.take_table();
    std::ranges::replace(heights_.dense, unknown, std::int16_t{0});
}

}  // namespace nestgrid
