// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/detail/for_each_leaf.hpp>

#include <walk/for_each_element.hpp>

namespace nestgrid::detail {

void for_each_leaf(const Hierarchy<float>& hierarchy, const LeafFunction& function) {
    const engine::Walk<float> walk(hierarchy, {.values = false, .keys = true});
    std::array<NodeKey, max_corners> keys;
    engine::for_each_element(
        walk, false, [&](const engine::ElementView<float>& view, const engine::Split& split) {
            if (split.rule != nullptr || view.member->hidden == Hidden::wholly) return;
            walk.corners(view, keys.data(), nullptr);
            function(view.element(), std::span(keys).first(view.corner_count()));
        });
}

}  // namespace nestgrid::detail
