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

/// Red refinement of a triangle into four.
inline const Rule& red_triangle_rule() {
    static const Rule rule = make_rule("red refinement of a triangle", Shape::triangle,
                                       {mean_of({0, 1}), mean_of({0, 2}), mean_of({1, 2})},
                                       {{Shape::triangle, {0, 3, 4}, 1, {}},
                                        {Shape::triangle, {3, 1, 5}, 1, {}},
                                        {Shape::triangle, {4, 5, 2}, 1, {}},
                                        {Shape::triangle, {5, 4, 3}, 1, {}}});
    return rule;
}

/// Red refinement of a tetrahedron into eight. The inner octahedron is cut along the diagonal from
/// the midpoint of the edge 02 to that of the edge 13 (diagonal 0: with Bey's numbering, 1995,
/// three classes of similar tetrahedra at most), of 01 to 23 (diagonal 1), or of 03 to 12 (diagonal
/// 2).
inline const Rule& red_tetrahedron_rule(int diagonal = 0) {
    // 4: 01, 5: 02, 6: 03, 7: 12, 8: 13, 9: 23
    static const auto build = [](const std::string& name, const std::vector<Child>& inner) {
        std::vector<Child> children{{Shape::tetrahedron, {0, 4, 5, 6}, 1, {}},
                                    {Shape::tetrahedron, {4, 1, 7, 8}, 1, {}},
                                    {Shape::tetrahedron, {5, 7, 2, 9}, 1, {}},
                                    {Shape::tetrahedron, {6, 8, 9, 3}, 1, {}}};
        children.insert(children.end(), inner.begin(), inner.end());
        return make_rule("red refinement of a tetrahedron, diagonal " + name, Shape::tetrahedron,
                         {mean_of({0, 1}), mean_of({0, 2}), mean_of({0, 3}), mean_of({1, 2}),
                          mean_of({1, 3}), mean_of({2, 3})},
                         std::move(children));
    };
    static const std::array<Rule, 3> rules{
        build("02-13", {{Shape::tetrahedron, {4, 5, 6, 8}, 1, {}},
                        {Shape::tetrahedron, {4, 5, 7, 8}, -1, {}},
                        {Shape::tetrahedron, {5, 6, 8, 9}, 1, {}},
                        {Shape::tetrahedron, {5, 7, 8, 9}, -1, {}}}),
        build("01-23", {{Shape::tetrahedron, {4, 5, 6, 9}, 1, {}},
                        {Shape::tetrahedron, {4, 7, 5, 9}, 1, {}},
                        {Shape::tetrahedron, {4, 8, 7, 9}, 1, {}},
                        {Shape::tetrahedron, {4, 6, 8, 9}, 1, {}}}),
        build("03-12", {{Shape::tetrahedron, {6, 4, 5, 7}, 1, {}},
                        {Shape::tetrahedron, {6, 8, 4, 7}, 1, {}},
                        {Shape::tetrahedron, {6, 9, 8, 7}, 1, {}},
                        {Shape::tetrahedron, {6, 5, 9, 7}, 1, {}}})};
    return rules.at(static_cast<std::size_t>(diagonal));
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

/// How a prism, triangle times segment, is refined.
enum class PrismSplit : std::uint8_t { isotropic, horizontal, vertical };

/// Refinement of a prism into four along the triangle (horizontal), two along the segment
/// (vertical), or eight. The isotropic rule is horizontal, then vertical: the node in the middle of
/// a quadrilateral face lies between the midpoints of its lower and upper edge.
inline const Rule& prism_rule(PrismSplit split) {
    static const auto build = [](PrismSplit s) {
        const bool across = s != PrismSplit::vertical;
        const bool along = s != PrismSplit::horizontal;
        std::vector<Stencil> nodes;
        // layer[h][v]: the nodes of the triangle at height h; v < 3 its corners, then 01, 02, 12.
        std::array<std::array<int, 6>, 3> layer{};
        for (int v = 0; v < 3; ++v) {
            layer[0][static_cast<std::size_t>(v)] = v;
            layer[2][static_cast<std::size_t>(v)] = v + 3;
        }
        const auto add = [&](int a, int b) {
            nodes.push_back(mean_of({a, b}));
            return 5 + static_cast<int>(nodes.size());
        };
        for (const std::size_t h : {0U, 2U}) {
            auto& l = layer[h];
            if (across) l = {l[0], l[1], l[2], add(l[0], l[1]), add(l[0], l[2]), add(l[1], l[2])};
        }
        for (std::size_t v = 0; along && v < (across ? 6U : 3U); ++v) {
            layer[1][v] = add(layer[0][v], layer[2][v]);
        }
        std::vector<std::array<std::size_t, 3>> triangles{{0, 1, 2}};
        if (across) triangles = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}, {5, 4, 3}};
        std::vector<Child> children;
        for (std::size_t h = 0; h < (along ? 2U : 1U); ++h) {
            for (const auto& t : triangles) {
                Child child{Shape::prism, {}, 1, {}};
                for (std::size_t i = 0; i < 3; ++i) {
                    child.corner[i] = static_cast<std::uint8_t>(layer[h][t[i]]);
                    child.corner[i + 3] = static_cast<std::uint8_t>(layer[along ? h + 1 : 2][t[i]]);
                }
                children.push_back(child);
            }
        }
        const std::string name = !across ? "vertical" : !along ? "horizontal" : "isotropic";
        return make_rule(name + " refinement of a prism", Shape::prism, nodes, children);
    };
    static const std::array<Rule, 3> rules{
        build(PrismSplit::isotropic), build(PrismSplit::horizontal), build(PrismSplit::vertical)};
    return rules.at(static_cast<std::size_t>(split));
}

}  // namespace nestgrid
