// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <nestgrid/detail/shape_functions.hpp>
#include <nestgrid/rule_table.hpp>

#include "rule_steps.hpp"

namespace nestgrid {

namespace {

/// A point in units of 2^-20: points that differ by rounding share one.
using Place = std::array<std::int32_t, 3>;

Place place(const Point& x) {
    Place at;
    for (std::size_t d = 0; d < 3; ++d) {
        at[d] = static_cast<std::int32_t>(std::lround(x[d] * 0x1p20));
    }
    return at;
}

/// A hash of how children lie; no NodeKey, so that wide keys do not change it.
std::uint64_t key(Shape parent, std::span<const PlacedChild> children) {
    std::uint64_t sum = detail::mix64(static_cast<std::uint64_t>(parent));
    const auto add = [&](std::int64_t x) {
        sum = detail::mix64(sum + static_cast<std::uint64_t>(x));
    };
    for (const PlacedChild& child : children) {
        add(static_cast<std::int64_t>(child.shape));
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            for (const std::int32_t x : place(child.corners[i])) add(x);
        }
    }
    return sum;
}

/// The stencil over the corners of the parent that makes a node at x.
Stencil stencil_at(Shape parent, const Point& x) {
    const auto weight = shape_functions(parent, x);
    Stencil s;
    double sum = 0;
    for (std::uint8_t i = 0; i < topology(parent).corners; ++i) {
        if (weight[i] < 0x1p-20) continue;
        s.parent[s.count] = i;
        s.weight[s.count++] = weight[i];
        sum += weight[i];
    }
    for (std::size_t i = 0; i < s.count; ++i) s.weight[i] /= sum;
    return s;
}

Rule make(Shape parent, std::span<const PlacedChild> placed) {
    const Topology& t = topology(parent);
    std::vector<Place> nodes;
    for (std::size_t i = 0; i < t.corners; ++i) nodes.push_back(place(t.reference[i]));
    std::vector<Stencil> stencils;
    std::vector<Child> children;
    for (const PlacedChild& from : placed) {
        Child child{from.shape, {}, 1, {}};
        const std::size_t corners = topology(from.shape).corners;
        for (std::size_t i = 0; i < corners; ++i) {
            const auto at = std::find(nodes.begin(), nodes.end(), place(from.corners[i]));
            child.corner[i] = static_cast<std::uint8_t>(at - nodes.begin());
            if (at != nodes.end()) continue;
            nodes.push_back(place(from.corners[i]));
            stencils.push_back(stencil_at(parent, from.corners[i]));
        }
        const std::span<const Point> x(from.corners.data(), corners);
        child.orientation = detail::signed_reference_measure(from.shape, x) < 0 ? -1 : 1;
        children.push_back(child);
    }
    const std::string name = std::string(t.name) + " into " + std::to_string(children.size());
    return make_rule(name, parent, std::move(stencils), std::move(children));
}

}  // namespace

const Rule& RuleTable::add(Shape parent, std::span<const PlacedChild> children) {
    const std::uint64_t name = key(parent, children);
    if (const Rule* const* const known = by_children_.find(name)) return **known;
    const Rule& rule = rules_.emplace_back(make(parent, children));
    by_children_.insert(name, &rule);
    return rule;
}

const Rule* RuleTable::find(Shape parent, std::span<const PlacedChild> children) const {
    const Rule* const* const rule = by_children_.find(key(parent, children));
    return rule == nullptr ? nullptr : *rule;
}

}  // namespace nestgrid
