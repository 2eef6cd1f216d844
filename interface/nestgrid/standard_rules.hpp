// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The standard refinement rules. Each is built on first use, checked, and lives until the program
// ends; ask for those you need in the constructor of your grid, not in split().
#pragma once

#include <nestgrid/rule.hpp>

namespace nestgrid {

/// Maubach's bisection of a simplex with the tag `tag` (1995): the edge from corner 0 to corner
/// `tag` is cut at its midpoint z. With the corners x0 ... xn the children are
///     x0 ... x(tag-1)  z  x(tag+1) ... xn    and    x1 ... x(tag)  z  x(tag+1) ... xn ;
/// both carry the tag tag - 1, or n after 1. The second one is mirrored where `tag` is odd.
/// \param shape triangle or tetrahedron; \param tag 1 ... dimension.
inline const Rule& bisection_rule(Shape shape, int tag) {
    static const auto build = [](Shape s, int k) {
        const int corners = topology(s).corners;
        Child first{s, {}, 1, {}};
        Child second{s, {}, static_cast<std::int8_t>(k % 2 == 0 ? 1 : -1), {}};
        for (int i = 0; i < corners; ++i) {
            const auto at = static_cast<std::size_t>(i);
            first.corner[at] = static_cast<std::uint8_t>(i == k ? corners : i);
            second.corner[at] = static_cast<std::uint8_t>(i < k ? i + 1 : i == k ? corners : i);
        }
        return make_rule(
            "bisection of a " + std::string(topology(s).name) + ", tag " + std::to_string(k), s,
            {mean_of({0, k})}, {first, second});
    };
    static const std::array<Rule, 2> triangle{build(Shape::triangle, 1), build(Shape::triangle, 2)};
    static const std::array<Rule, 3> tetrahedron{
        build(Shape::tetrahedron, 1), build(Shape::tetrahedron, 2), build(Shape::tetrahedron, 3)};
    const auto at = static_cast<std::size_t>(tag - 1);
    return shape == Shape::triangle ? triangle.at(at) : tetrahedron.at(at);
}

/// Red refinement of a tetrahedron into eight, the inner octahedron cut along the diagonal from
/// the midpoint of the edge 02 to that of the edge 13 (Bey 1995).
inline const Rule& red_tetrahedron_rule() {
    // 4: 01, 5: 02, 6: 03, 7: 12, 8: 13, 9: 23
    static const Rule rule = make_rule("red refinement of a tetrahedron", Shape::tetrahedron,
                                       {mean_of({0, 1}), mean_of({0, 2}), mean_of({0, 3}),
                                        mean_of({1, 2}), mean_of({1, 3}), mean_of({2, 3})},
                                       {{Shape::tetrahedron, {0, 4, 5, 6}, 1, {}},
                                        {Shape::tetrahedron, {4, 1, 7, 8}, 1, {}},
                                        {Shape::tetrahedron, {5, 7, 2, 9}, 1, {}},
                                        {Shape::tetrahedron, {6, 8, 9, 3}, 1, {}},
                                        {Shape::tetrahedron, {4, 5, 6, 8}, 1, {}},
                                        {Shape::tetrahedron, {4, 5, 7, 8}, -1, {}},
                                        {Shape::tetrahedron, {5, 6, 8, 9}, 1, {}},
                                        {Shape::tetrahedron, {5, 7, 8, 9}, -1, {}}});
    return rule;
}

/// Refinement of a segment, quadrilateral or hexahedron into 2, 4 or 8 by halving every direction.
/// New nodes: first the midpoints of the edges in the order of the topology, then the centres of
/// the quadrilateral faces in the order of the topology, then the centre.
inline const Rule& dyadic_rule(Shape shape) {
    static const auto build = [](Shape s) {
        const Topology& t = topology(s);
        const unsigned n = t.dimension;
        std::vector<Stencil> nodes;
        std::vector<std::vector<int>> parents;
        for (int i = 0; i < t.corners; ++i) parents.push_back({i});
        const auto add = [&](std::vector<int> of) {
            Stencil stencil;
            for (const int p : of) {
                stencil.parent[stencil.count] = static_cast<std::uint8_t>(p);
                stencil.weight[stencil.count++] = 1.0 / static_cast<double>(of.size());
            }
            nodes.push_back(stencil);
            std::sort(of.begin(), of.end());
            parents.push_back(std::move(of));
        };
        for (std::size_t e = 0; e < t.edges; ++e) add({t.edge[e][0], t.edge[e][1]});
        for (std::size_t f = 0; n == 3 && f < t.faces; ++f) {
            add({t.face[f].tensor_corner(0), t.face[f].tensor_corner(1), t.face[f].tensor_corner(2),
                 t.face[f].tensor_corner(3)});
        }
        if (n == 2) add({0, 1, 2, 3});
        if (n == 3) add({0, 1, 2, 3, 4, 5, 6, 7});
        std::vector<Child> children;
        for (unsigned c = 0; c < 1U << n; ++c) {
            Child child{s, {}, 1, {}};
            for (unsigned i = 0; i < 1U << n; ++i) {
                std::vector<int> of;  // the mean of all corners between corner c and corner i
                for (unsigned p = 0; p < 1U << n; ++p) {
                    if (((p ^ c) & ~(c ^ i)) == 0) of.push_back(static_cast<int>(p));
                }
                child.corner[i] = static_cast<std::uint8_t>(
                    std::find(parents.begin(), parents.end(), of) - parents.begin());
            }
            children.push_back(child);
        }
        return make_rule("halving of a " + std::string(t.name), s, nodes, children);
    };
    static const Rule segment = build(Shape::segment);
    static const Rule quadrilateral = build(Shape::quadrilateral);
    static const Rule hexahedron = build(Shape::hexahedron);
    return shape == Shape::segment         ? segment
           : shape == Shape::quadrilateral ? quadrilateral
                                           : hexahedron;
}

}  // namespace nestgrid
