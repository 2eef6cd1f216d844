// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prerolls.hpp"

#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::python {

namespace {

/// The entry of a key, made by make() where there is none.
template <class Map, class Make>
typename Map::mapped_type kept(Map& map, const typename Map::key_type& key, const Make& make) {
    const auto found = map.find(key);
    if (found != map.end()) return found->second;
    return map.emplace(key, make()).first->second;
}

template <class Real>
SweptIndicator swept_indicator(const Hierarchy<Real>& hierarchy, const std::string& name,
                               double range, const Spread& spread) {
    if (name == "visual") {
        return visual_indicator(hierarchy, {.tau = 0x1p-20 * range, .spread = spread});
    }
    if (name == "numerical") return numerical_indicator(hierarchy, {.spread = spread});
    if (name == "wavelet") return wavelet_indicator(hierarchy, {.spread = spread});
    if (name != "geometry") {
        throw InvalidInput("the indicator '" + name +
                           "' is none of offset, deviation, visual, numerical, wavelet and "
                           "geometry");
    }
    if (!hierarchy.offers(Feature::new_positions)) {
        throw InvalidInput(
            "the indicator geometry is for curved grids: on this one it is 0 everywhere");
    }
    return geometry_indicator(hierarchy, {.spread = spread});
}

}  // namespace

std::shared_ptr<const HierarchicalIndicator> Prerolls::of_nodes(NodeError error, double blend,
                                                                const Call& call) {
    const std::scoped_lock lock(mutex_);
    return kept(of_nodes_, {error, blend}, [&] {
        return call.with(hierarchy_, [&](const auto& hierarchy) {
            return std::make_shared<const HierarchicalIndicator>(hierarchy, error, call.executor(),
                                                                 Spread{.factor = blend});
        });
    });
}

std::shared_ptr<const SweptIndicator> Prerolls::swept(const std::string& name, double blend,
                                                      const Call& call) {
    const auto all = offsets(1, call);
    const std::scoped_lock lock(mutex_);
    return kept(swept_, {name, blend}, [&] {
        return call.with(hierarchy_, [&](const auto& hierarchy) {
            return std::make_shared<const SweptIndicator>(swept_indicator(
                hierarchy, name, all->greatest() - all->least(), {.factor = blend}));
        });
    });
}

std::shared_ptr<const SweptIndicator> Prerolls::sizes(double slope, const Call& call) {
    const std::scoped_lock lock(mutex_);
    return kept(sizes_, slope, [&] {
        return call.with(hierarchy_, [&](const auto& hierarchy) {
            return std::make_shared<const SweptIndicator>(
                mesh_size(hierarchy, Spread{.slope = slope}));
        });
    });
}

void Prerolls::clear() {
    const std::scoped_lock lock(mutex_);
    of_nodes_.clear();
    swept_.clear();
    sizes_.clear();
}

}  // namespace nestgrid::python
