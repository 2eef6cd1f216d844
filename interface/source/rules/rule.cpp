// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Making rules: stencils, and the derived members that follow from one node or child at a time.
#include <algorithm>
#include <cmath>
#include <utility>

#include <nestgrid/error.hpp>
#include <nestgrid/rule.hpp>

#include "derived_members.hpp"

namespace nestgrid {

namespace {

/// Puts the parents of a plain mean over a quadrilateral face into tensor order.
bool order_as_face(const Rule& rule, Stencil& stencil) {
    if (stencil.count != 4) return false;
    const Topology& t = topology(rule.parent);
    std::array<std::uint8_t, 4> wanted{};
    std::copy_n(stencil.parent.begin(), 4, wanted.begin());
    std::sort(wanted.begin(), wanted.end());
    const auto matches = [&](std::array<std::uint8_t, 4> candidate) {
        auto sorted = candidate;
        std::sort(sorted.begin(), sorted.end());
        if (sorted != wanted) return false;
        std::copy_n(candidate.begin(), 4, stencil.parent.begin());
        return true;
    };
    if (rule.parent == Shape::quadrilateral && matches({0, 1, 2, 3})) return true;
    for (std::size_t f = 0; f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        if (face.corners != 4) continue;
        if (matches({face.tensor_corner(0), face.tensor_corner(1), face.tensor_corner(2),
                     face.tensor_corner(3)})) {
            return true;
        }
    }
    return false;
}

/// Fills Stencil::rank and Stencil::mean.
void complete_stencil(const Rule& rule, Stencil& s) {
    std::vector<double> distinct(s.weight.begin(), s.weight.begin() + s.count);
    std::sort(distinct.rbegin(), distinct.rend());
    distinct.erase(std::unique(distinct.begin(), distinct.end(),
                               [](double a, double b) { return std::abs(a - b) < 1e-12; }),
                   distinct.end());
    for (std::size_t i = 0; i < s.count; ++i) {
        const auto place = std::find_if(distinct.begin(), distinct.end(), [&](double w) {
            return std::abs(w - s.weight[i]) < 1e-12;
        });
        s.rank[i] = static_cast<std::uint8_t>(place - distinct.begin());
    }
    s.mean = Mean::weighted;
    if (distinct.size() != 1) return;
    if (s.count == 2) s.mean = Mean::midpoint;
    if (s.count == 8) s.mean = Mean::cell;
    if (order_as_face(rule, s)) s.mean = Mean::face;
}

/// Fills Rule::old_corner and Rule::new_corner: prefers a child's first corner, then its last one,
/// then any other.
void find_corners(Rule& rule) {
    const auto old = static_cast<std::size_t>(rule.corner_count());
    rule.old_corner.resize(old);
    rule.new_corner.resize(rule.new_nodes.size());
    std::vector<int> rank(old + rule.new_nodes.size(), 3);
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        const Child& child = rule.children[c];
        const std::size_t corners = topology(child.shape).corners;
        for (std::size_t i = 0; i < corners; ++i) {
            const std::size_t n = child.corner[i];
            const int here = i == 0 ? 0 : i + 1 == corners ? 1 : 2;
            if (here >= rank[n]) continue;
            rank[n] = here;
            ChildCorner& at = n < old ? rule.old_corner[n] : rule.new_corner[n - old];
            at = {static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(i)};
        }
    }
}

/// Fills Child::parent_face of every child.
void mark_nodes(Rule& rule) {
    if (rule.new_nodes.size() + topology(rule.parent).corners > 64) return;
    for (Child& child : rule.children) {
        child.nodes = 0;
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            child.nodes |= std::uint64_t{1} << child.corner[i];
        }
    }
}

void find_parent_faces(Rule& rule) {
    const std::vector<unsigned> incidence = detail::face_incidence(rule);
    for (Child& child : rule.children) {
        child.parent_face.fill(no_face);
        const Topology& t = topology(child.shape);
        for (std::size_t f = 0; f < t.faces; ++f) {
            unsigned common = ~0U;
            for (std::size_t i = 0; i < t.face[f].corners; ++i) {
                common &= incidence[child.corner[t.face[f].corner[i]]];
            }
            for (std::uint8_t g = 0; g < topology(rule.parent).faces; ++g) {
                if ((common >> g & 1U) != 0) child.parent_face[f] = g;
            }
        }
    }
}

/// Fills Rule::steps.
void count_steps(Rule& rule) {
    std::vector<int> steps(static_cast<std::size_t>(rule.corner_count()), 0);
    for (const Stencil& s : rule.new_nodes) {
        int step = 0;
        for (std::size_t i = 0; i < s.count; ++i) step = std::max(step, steps[s.parent[i]]);
        steps.push_back(step + 1);
        rule.steps = std::max(rule.steps, step + 1);
    }
}

}  // namespace

Stencil weighted_mean_of(std::initializer_list<std::pair<int, double>> parents, int number) {
    Stencil s;
    for (const auto& [parent, weight] : parents) {
        if (s.count == max_corners) throw InvalidInput("a stencil has at most 8 parents");
        s.parent[s.count] = static_cast<std::uint8_t>(parent);
        s.weight[s.count++] = weight;
    }
    s.number = static_cast<std::uint8_t>(number);
    return s;
}

Stencil mean_of(std::initializer_list<int> parents) {
    Stencil s;
    for (const int parent : parents) {
        if (s.count == max_corners) throw InvalidInput("a stencil has at most 8 parents");
        s.parent[s.count] = static_cast<std::uint8_t>(parent);
        s.weight[s.count++] = 1.0 / static_cast<double>(parents.size());
    }
    return s;
}

std::vector<Point> reference_nodes(const Rule& rule) {
    const Topology& t = topology(rule.parent);
    std::vector<Point> nodes(t.reference.begin(), t.reference.begin() + t.corners);
    for (const Stencil& s : rule.new_nodes) {
        Point x{0, 0, 0};
        for (std::size_t i = 0; i < s.count; ++i) x = x + s.weight[i] * nodes[s.parent[i]];
        nodes.push_back(x);
    }
    return nodes;
}

Rule make_rule(std::string name, Shape parent, std::vector<Stencil> new_nodes,
               std::vector<Child> children) {
    Rule rule;
    rule.name = std::move(name);
    rule.parent = parent;
    rule.new_nodes = std::move(new_nodes);
    rule.children = std::move(children);
    if (auto violation = find_violation(rule)) throw InvalidInput(*violation);
    for (Stencil& s : rule.new_nodes) complete_stencil(rule, s);
    find_corners(rule);
    mark_nodes(rule);
    find_parent_faces(rule);
    count_steps(rule);
    detail::find_parts(rule);
    detail::place_in_parts(rule);
    return rule;
}

}  // namespace nestgrid
