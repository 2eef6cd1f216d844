// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rules found in a grid: for solvers that tell where children lie in their father, but not by which
// rule they were made.
#pragma once

#include <deque>

#include <nestgrid/key_table.hpp>
#include <nestgrid/rule.hpp>
#include <nestgrid/shape_functions.hpp>

namespace nestgrid {

/// A child as it lies in the reference element of its father.
struct PlacedChild {
    Shape shape = Shape::point;
    std::array<Point, max_corners> corners{};
};

/// Rules by how the children lie, each made and checked once. Add those of a whole grid in the
/// constructor of its adapter: find() is const, and rules keep their addresses.
class RuleTable {
public:
    /// The rule of an element of a shape with these children. New nodes are numbered as the corners
    /// of the children name them first; their weights are the shape functions of the parent.
    /// \throw InvalidInput with the sentence of find_violation() where the children do not tile the
    ///        parent
    const Rule& add(Shape parent, std::span<const PlacedChild> children) {
        const NodeKey name = key(parent, children);
        if (const Rule* const* const known = by_children_.find(name)) return **known;
        const Rule& rule = rules_.emplace_back(make(parent, children));
        by_children_.insert(name, &rule);
        return rule;
    }

    /// The same without adding: null where there is no such rule.
    const Rule* find(Shape parent, std::span<const PlacedChild> children) const {
        const Rule* const* const rule = by_children_.find(key(parent, children));
        return rule == nullptr ? nullptr : *rule;
    }

    std::size_t size() const { return rules_.size(); }

private:
    using Place = std::array<std::int32_t, 3>;

    static Place place(const Point& x) {
        Place at;
        for (std::size_t d = 0; d < 3; ++d) {
            at[d] = static_cast<std::int32_t>(std::lround(x[d] * 0x1p20));
        }
        return at;
    }

    static NodeKey key(Shape parent, std::span<const PlacedChild> children) {
        NodeKey sum = coarse_key(static_cast<std::uint64_t>(parent));
        const auto add = [&](std::int64_t x) {
            sum = detail::mix(sum + static_cast<std::uint64_t>(x));
        };
        for (const PlacedChild& child : children) {
            add(static_cast<std::int64_t>(child.shape));
            for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
                for (const std::int32_t x : place(child.corners[i])) add(x);
            }
        }
        return sum;
    }

    static Stencil stencil(Shape parent, const Point& x) {
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

    static Rule make(Shape parent, std::span<const PlacedChild> placed) {
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
                stencils.push_back(stencil(parent, from.corners[i]));
            }
            const std::span<const Point> x(from.corners.data(), corners);
            child.orientation = detail::signed_reference_measure(from.shape, x) < 0 ? -1 : 1;
            children.push_back(child);
        }
        const std::string name = std::string(t.name) + " into " + std::to_string(children.size());
        return make_rule(name, parent, std::move(stencils), std::move(children));
    }

    std::deque<Rule> rules_;
    KeyTable<NodeKey, const Rule*> by_children_;
};

}  // namespace nestgrid
