// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/hanging_nodes.hpp>

#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/detail/hanging_probe.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid {

namespace engine {

template <class Real>
HangingNodes derive_hanging_nodes(const Hierarchy<Real>& hierarchy) {
    const Walk<Real> walk(hierarchy, {.values = false, .keys = true});
    detail::HangingProbe probe;
    std::array<NodeKey, max_corners> keys;
    for_each_element(walk, true, [&](const ElementView<Real>& view, const Split& split) {
        if (split.rule == nullptr) return;
        walk.corners(view, keys.data(), nullptr);
        probe.add_nodes(*split.rule, keys, split.keys);
    });
    probe.finish();
    for_each_element(walk, false, [&](const ElementView<Real>& view, const Split& split) {
        if (split.rule != nullptr || view.member->hidden == Hidden::wholly) return;
        walk.corners(view, keys.data(), nullptr);
        probe.probe_leaf(view.shape, keys);
    });
    return probe.take();
}

template HangingNodes derive_hanging_nodes(const Hierarchy<float>&);
template HangingNodes derive_hanging_nodes(const Hierarchy<double>&);

}  // namespace engine

HangingNodes derive_hanging_nodes(const Hierarchy<float>& hierarchy) {
    return engine::derive_hanging_nodes(hierarchy);
}

}  // namespace nestgrid
