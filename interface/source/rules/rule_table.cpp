// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <nestgrid/detail/shape_functions.hpp>
#include <nestgrid/rule_table.hpp>

#include "derived_members.hpp"

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
std::uint64_t key(Shape parent, std::span<const PlacedChild> children, const ParentAxes& axes) {
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
    for (const Axes a : axes.face) add(a);
    add(axes.inside);
    return sum;
}

std::string text(const Point& x) {
    std::string s = "(";
    for (const double at : x) {
        std::array<char, 32> digits;
        std::snprintf(digits.data(), digits.size(), "%g", at);
        s += (s.size() > 1 ? ", " : "") + std::string(digits.data());
    }
    return s + ")";
}

/// Adds the other axis of the triangle of a prism to one of them.
Axes together(Shape parent, Axes axes) {
    const Axes triangle = axis_x | axis_y;
    return parent == Shape::prism && (axes & triangle) != 0 ? axes | triangle : axes;
}

/// Collects the nodes of a rule and their stencils.
class NodeList {
public:
    /// \param name of the rule
    NodeList(const std::string& name, Shape parent, std::span<const PlacedChild> children,
             const ParentAxes& axes)
        : name_{name}, parent_{parent}, axes_{axes} {
        const Topology& t = topology(parent);
        const bool has_axes =
            parent == Shape::quadrilateral || parent == Shape::hexahedron || parent == Shape::prism;
        if (!has_axes && axes != ParentAxes{}) {
            throw InvalidInput("rule '" + name + "': a " + std::string(t.name) +
                               " is not divided along axes");
        }
        for (std::size_t i = 0; i < t.corners; ++i) nodes_.push_back(place(t.reference[i]));
        for (const PlacedChild& child : children) {
            for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
                places_.insert(place(child.corners[i]));
            }
        }
    }

    /// The number of the node at x, which is added after its parents where it is not in the list.
    std::uint8_t number(const Point& x) {
        const auto at = std::find(nodes_.begin(), nodes_.end(), place(x));
        if (at != nodes_.end()) return static_cast<std::uint8_t>(at - nodes_.begin());
        const Stencil stencil = stencil_at(x);
        nodes_.push_back(place(x));
        stencils_.push_back(stencil);
        return static_cast<std::uint8_t>(nodes_.size() - 1);
    }

    std::vector<Stencil> take_stencils() { return std::move(stencils_); }

private:
    /// Along which axes the parents of a node lie.
    /// \param weight of the corners of the father
    Axes axes_of(std::span<const double> weight) const {
        const Topology& t = topology(parent_);
        int face = -1;
        int faces = 0;
        for (int f = 0; f < t.faces; ++f) {
            const FaceTopology& of = t.face[static_cast<std::size_t>(f)];
            double sum = 0;
            for (std::size_t i = 0; i < of.corners; ++i) sum += weight[of.corner[i]];
            if (sum < 1 - 0x1p-20) continue;
            face = f;
            ++faces;
        }
        if (faces > 1 || (faces == 1 && t.dimension == 2)) return all_axes;  // on an edge
        const Axes axes = faces == 0 ? axes_.inside : axes_.face[static_cast<std::size_t>(face)];
        return together(parent_, axes);
    }

    Stencil stencil_at(const Point& x) {
        const Topology& t = topology(parent_);
        const auto weight = shape_functions(parent_, x);
        const Axes axes = axes_of(weight);
        std::vector<std::pair<Point, double>> parents;
        double sum = 0;
        for (std::size_t i = 0; i < t.corners; ++i) {
            if (weight[i] < 0x1p-20) continue;
            Point p = x;
            for (std::size_t d = 0; d < 3; ++d) {
                if ((axes >> d & 1U) != 0) p[d] = t.reference[i][d];
            }
            const auto at = std::find_if(parents.begin(), parents.end(), [&](const auto& known) {
                return place(known.first) == place(p);
            });
            if (at == parents.end()) {
                parents.emplace_back(p, weight[i]);
            } else {
                at->second += weight[i];
            }
            sum += weight[i];
        }
        Stencil s;
        for (const auto& [p, w] : parents) {
            const bool is_node = places_.contains(place(p)) && place(p) != place(x);
            if (!is_node && axes != all_axes) {
                throw InvalidInput("rule '" + name_ + "': the new node at " + text(x) +
                                   " has no parent at " + text(p) + " along its axes");
            }
            s.parent[s.count] = number(p);
            s.weight[s.count++] = w / sum;
        }
        return s;
    }

    const std::string& name_;
    Shape parent_;
    const ParentAxes& axes_;
    std::vector<Place> nodes_;
    std::set<Place> places_;  // where children have corners
    std::vector<Stencil> stencils_;
};

Rule make(Shape parent, std::span<const PlacedChild> placed, const ParentAxes& axes) {
    const std::string name =
        std::string(topology(parent).name) + " into " + std::to_string(placed.size());
    NodeList nodes(name, parent, placed, axes);
    std::vector<Child> children;
    for (const PlacedChild& from : placed) {
        Child child{from.shape, {}, 1, {}};
        const std::size_t corners = topology(from.shape).corners;
        for (std::size_t i = 0; i < corners; ++i) child.corner[i] = nodes.number(from.corners[i]);
        const std::span<const Point> x(from.corners.data(), corners);
        child.orientation = detail::signed_reference_measure(from.shape, x) < 0 ? -1 : 1;
        children.push_back(child);
    }
    return make_rule(name, parent, nodes.take_stencils(), std::move(children));
}

}  // namespace

ParentAxes in_steps(Shape parent, std::initializer_list<Axes> steps) {
    const Topology& t = topology(parent);
    Axes divided = 0;
    for (const Axes step : steps) {
        const Axes along = together(parent, step);
        if ((divided & along) != 0) {
            throw InvalidInput(
                "a rule in steps divides its father once along each axis; a second step along an "
                "axis divides the children by rules of their own");
        }
        divided = static_cast<Axes>(divided | along);
    }
    ParentAxes result;
    const auto last_along = [&](Axes of) {
        for (auto step = steps.end(); step != steps.begin();) {
            if ((*--step & of) != 0) return *step;
        }
        return all_axes;
    };
    for (std::size_t f = 0; t.dimension == 3 && f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        Axes varying = 0;
        for (std::size_t i = 1; i < face.corners; ++i) {
            for (std::size_t d = 0; d < 3; ++d) {
                const bool varies =
                    t.reference[face.corner[i]][d] != t.reference[face.corner[0]][d];
                varying = static_cast<Axes>(varying | (unsigned{varies} << d));
            }
        }
        result.face[f] = last_along(together(parent, varying));
    }
    result.inside = last_along(t.dimension == 3 ? all_axes : axis_x | axis_y);
    return result;
}

const Rule& RuleTable::add(Shape parent, std::span<const PlacedChild> children,
                           const ParentAxes& axes) {
    const std::uint64_t name = key(parent, children, axes);
    if (const Rule* const* const known = by_children_.find(name)) return **known;
    const Rule& rule = rules_.emplace_back(make(parent, children, axes));
    by_children_.insert(name, &rule);
    return rule;
}

const Rule* RuleTable::find(Shape parent, std::span<const PlacedChild> children,
                            const ParentAxes& axes) const {
    const Rule* const* const rule = by_children_.find(key(parent, children, axes));
    return rule == nullptr ? nullptr : *rule;
}

}  // namespace nestgrid
