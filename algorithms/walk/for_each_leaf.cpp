// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/detail/for_each_leaf.hpp>

#include <walk/for_each_element.hpp>

namespace nestgrid::detail {

void for_each_leaf(const Hierarchy<float>& hierarchy, const LeafFunction& function) {
    const engine::Walk<float> walk(
        hierarchy, {.values = false, .keys = true, .positions = true, .on_ranks = true});
    std::array<NodeKey, max_corners> keys;
    std::array<Point, max_corners> positions;
    engine::for_each_element(
        walk, false, [&](const engine::ElementView<float>& view, const engine::Split& split) {
            if (split.rule != nullptr || view.member->hidden == Hidden::wholly) return;
            walk.corners(view, keys.data(), positions.data());
            const std::size_t count = view.corner_count();
            function({view.element(), view.shape, std::span(keys).first(count),
                      std::span(positions).first(count)});
        });
}

}  // namespace nestgrid::detail
