// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>
#include <utility>

#include <nestgrid/error.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

namespace {

Rule make_bisection(Shape s, int tag) {
    const int corners = topology(s).corners;
    Child first{s, {}, 1, {}};
    Child second{s, {}, static_cast<std::int8_t>(tag % 2 == 0 ? 1 : -1), {}};
    for (int i = 0; i < corners; ++i) {
        const auto at = static_cast<std::size_t>(i);
        first.corner[at] = static_cast<std::uint8_t>(i == tag ? corners : i);
        second.corner[at] = static_cast<std::uint8_t>(i < tag ? i + 1 : i == tag ? corners : i);
    }
    return make_rule(
        "bisection of a " + std::string(topology(s).name) + ", tag " + std::to_string(tag), s,
        {mean_of({0, tag})}, {first, second});
}

/// \param inner the children that the inner octahedron is cut into
Rule make_red_tetrahedron(const std::string& diagonal, const std::vector<Child>& inner) {
    // 4: 01, 5: 02, 6: 03, 7: 12, 8: 13, 9: 23
    std::vector<Child> children{{Shape::tetrahedron, {0, 4, 5, 6}, 1, {}},
                                {Shape::tetrahedron, {4, 1, 7, 8}, 1, {}},
                                {Shape::tetrahedron, {5, 7, 2, 9}, 1, {}},
                                {Shape::tetrahedron, {6, 8, 9, 3}, 1, {}}};
    children.insert(children.end(), inner.begin(), inner.end());
    return make_rule("red refinement of a tetrahedron, diagonal " + diagonal, Shape::tetrahedron,
                     {mean_of({0, 1}), mean_of({0, 2}), mean_of({0, 3}), mean_of({1, 2}),
                      mean_of({1, 3}), mean_of({2, 3})},
                     std::move(children));
}

/// For every new node of a dyadic rule the corners whose mean it is, as its stencil lists them.
std::vector<std::vector<int>> dyadic_means(const Topology& t) {
    std::vector<std::vector<int>> means;
    for (std::size_t e = 0; e < t.edges; ++e) means.push_back({t.edge[e][0], t.edge[e][1]});
    for (std::size_t f = 0; t.dimension == 3 && f < t.faces; ++f) {
        means.push_back({t.face[f].tensor_corner(0), t.face[f].tensor_corner(1),
                         t.face[f].tensor_corner(2), t.face[f].tensor_corner(3)});
    }
    if (t.dimension == 2) means.push_back({0, 1, 2, 3});
    if (t.dimension == 3) means.push_back({0, 1, 2, 3, 4, 5, 6, 7});
    return means;
}

/// The child at corner c: its corner i is the mean of all corners between corners c and i.
/// \param parents for every node of the rule the corners whose mean it is, sorted
Child dyadic_child(Shape s, unsigned c, const std::vector<std::vector<int>>& parents) {
    const unsigned corners = topology(s).corners;
    Child child{s, {}, 1, {}};
    for (unsigned i = 0; i < corners; ++i) {
        std::vector<int> between;
        for (unsigned p = 0; p < corners; ++p) {
            if (((p ^ c) & ~(c ^ i)) == 0) between.push_back(static_cast<int>(p));
        }
        child.corner[i] = static_cast<std::uint8_t>(
            std::find(parents.begin(), parents.end(), between) - parents.begin());
    }
    return child;
}

Rule make_dyadic(Shape s) {
    const Topology& t = topology(s);
    std::vector<Stencil> nodes;
    std::vector<std::vector<int>> parents;
    for (int i = 0; i < t.corners; ++i) parents.push_back({i});
    for (std::vector<int>& mean : dyadic_means(t)) {
        Stencil stencil;
        for (const int p : mean) {
            stencil.parent[stencil.count] = static_cast<std::uint8_t>(p);
            stencil.weight[stencil.count++] = 1.0 / static_cast<double>(mean.size());
        }
        nodes.push_back(stencil);
        std::sort(mean.begin(), mean.end());
        parents.push_back(std::move(mean));
    }
    std::vector<Child> children;
    for (unsigned c = 0; c < t.corners; ++c) children.push_back(dyadic_child(s, c, parents));
    return make_rule("halving of a " + std::string(t.name), s, nodes, children);
}

/// The nodes of a refined prism in layers.
struct PrismNodes {
    std::vector<Stencil> stencils;
    /// layer[h][v]: the nodes of the triangle at height h; v < 3 its corners, then 01, 02, 12.
    std::array<std::array<int, 6>, 3> layer{};

    /// Adds the mean of nodes and returns its number.
    int add(std::initializer_list<int> parents) {
        stencils.push_back(mean_of(parents));
        return 5 + static_cast<int>(stencils.size());
    }
};

/// \param across, along whether the triangles and whether the segments are divided
/// \param at_once whether the middles of quadrilaterals are means of their corners, not of the
///        midpoints below and above
PrismNodes prism_nodes(bool across, bool along, bool at_once) {
    constexpr std::array<std::array<int, 2>, 3> side{{{0, 1}, {0, 2}, {1, 2}}};
    PrismNodes nodes;
    auto& layer = nodes.layer;
    for (int v = 0; v < 3; ++v) {
        layer[0][static_cast<std::size_t>(v)] = v;
        layer[2][static_cast<std::size_t>(v)] = v + 3;
    }
    for (const std::size_t h : {0U, 2U}) {
        if (!across) continue;
        const auto [a, b, c] = std::array{layer[h][0], layer[h][1], layer[h][2]};
        layer[h] = {a, b, c, nodes.add({a, b}), nodes.add({a, c}), nodes.add({b, c})};
    }
    for (std::size_t v = 0; along && v < (across ? 6U : 3U); ++v) {
        if (at_once && v >= 3) {
            const auto [a, b] = side[v - 3];
            layer[1][v] = nodes.add({a, b, a + 3, b + 3});
        } else {
            layer[1][v] = nodes.add({layer[0][v], layer[2][v]});
        }
    }
    return nodes;
}

Rule make_prism(PrismSplit split, bool at_once = false) {
    const bool across = split != PrismSplit::vertical;
    const bool along = split != PrismSplit::horizontal;
    const PrismNodes nodes = prism_nodes(across, along, at_once);
    std::vector<std::array<std::size_t, 3>> triangles{{0, 1, 2}};
    if (across) triangles = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}, {5, 4, 3}};
    std::vector<Child> children;
    for (std::size_t h = 0; h < (along ? 2U : 1U); ++h) {
        const auto& below = nodes.layer[h];
        const auto& above = nodes.layer[along ? h + 1 : 2];
        for (const auto& t : triangles) {
            Child child{Shape::prism, {}, 1, {}};
            for (std::size_t i = 0; i < 3; ++i) {
                child.corner[i] = static_cast<std::uint8_t>(below[t[i]]);
                child.corner[i + 3] = static_cast<std::uint8_t>(above[t[i]]);
            }
            children.push_back(child);
        }
    }
    const std::string name = at_once   ? "red"
                             : !across ? "vertical"
                             : !along  ? "horizontal"
                                       : "isotropic";
    return make_rule(name + " refinement of a prism", Shape::prism, nodes.stencils, children);
}

Rule make_red_pyramid() {
    // 5: 01, 6: 02, 7: 13, 8: 23, 9 to 12: from the base to the apex, 13: the middle of the base
    std::vector<Stencil> nodes;
    for (const auto& [a, b] : std::span(topology(Shape::pyramid).edge).first(8)) {
        nodes.push_back(mean_of({a, b}));
    }
    nodes.push_back(mean_of({0, 1, 2, 3}));
    return make_rule("red refinement of a pyramid", Shape::pyramid, nodes,
                     {{Shape::pyramid, {0, 5, 6, 13, 9}, 1, {}},
                      {Shape::pyramid, {5, 1, 13, 7, 10}, 1, {}},
                      {Shape::pyramid, {6, 13, 2, 8, 11}, 1, {}},
                      {Shape::pyramid, {13, 7, 8, 3, 12}, 1, {}},
                      {Shape::pyramid, {9, 10, 11, 12, 4}, 1, {}},
                      {Shape::pyramid, {9, 11, 10, 12, 13}, 1, {}},
                      {Shape::tetrahedron, {5, 13, 9, 10}, 1, {}},
                      {Shape::tetrahedron, {6, 13, 11, 9}, 1, {}},
                      {Shape::tetrahedron, {7, 13, 10, 12}, 1, {}},
                      {Shape::tetrahedron, {8, 13, 12, 11}, 1, {}}});
}

}  // namespace

const Rule& bisection_rule(Shape shape, int tag) {
    static const std::array<Rule, 2> triangle{make_bisection(Shape::triangle, 1),
                                              make_bisection(Shape::triangle, 2)};
    static const std::array<Rule, 3> tetrahedron{make_bisection(Shape::tetrahedron, 1),
                                                 make_bisection(Shape::tetrahedron, 2),
                                                 make_bisection(Shape::tetrahedron, 3)};
    const auto at = static_cast<std::size_t>(tag - 1);
    return shape == Shape::triangle ? triangle.at(at) : tetrahedron.at(at);
}

const Rule& red_triangle_rule() {
    static const Rule rule = make_rule("red refinement of a triangle", Shape::triangle,
                                       {mean_of({0, 1}), mean_of({0, 2}), mean_of({1, 2})},
                                       {{Shape::triangle, {0, 3, 4}, 1, {}},
                                        {Shape::triangle, {3, 1, 5}, 1, {}},
                                        {Shape::triangle, {4, 5, 2}, 1, {}},
                                        {Shape::triangle, {5, 4, 3}, 1, {}}});
    return rule;
}

const Rule& red_tetrahedron_rule(int diagonal) {
    static const std::array<Rule, 3> rules{
        make_red_tetrahedron("02-13", {{Shape::tetrahedron, {4, 5, 6, 8}, 1, {}},
                                       {Shape::tetrahedron, {4, 5, 7, 8}, -1, {}},
                                       {Shape::tetrahedron, {5, 6, 8, 9}, 1, {}},
                                       {Shape::tetrahedron, {5, 7, 8, 9}, -1, {}}}),
        make_red_tetrahedron("01-23", {{Shape::tetrahedron, {4, 5, 6, 9}, 1, {}},
                                       {Shape::tetrahedron, {4, 7, 5, 9}, 1, {}},
                                       {Shape::tetrahedron, {4, 8, 7, 9}, 1, {}},
                                       {Shape::tetrahedron, {4, 6, 8, 9}, 1, {}}}),
        make_red_tetrahedron("03-12", {{Shape::tetrahedron, {6, 4, 5, 7}, 1, {}},
                                       {Shape::tetrahedron, {6, 8, 4, 7}, 1, {}},
                                       {Shape::tetrahedron, {6, 9, 8, 7}, 1, {}},
                                       {Shape::tetrahedron, {6, 5, 9, 7}, 1, {}}})};
    return rules.at(static_cast<std::size_t>(diagonal));
}

const Rule& dyadic_rule(Shape shape) {
    static const Rule segment = make_dyadic(Shape::segment);
    static const Rule quadrilateral = make_dyadic(Shape::quadrilateral);
    static const Rule hexahedron = make_dyadic(Shape::hexahedron);
    return shape == Shape::segment         ? segment
           : shape == Shape::quadrilateral ? quadrilateral
                                           : hexahedron;
}

const Rule& red_rule(Shape shape) {
    static const Rule prism = make_prism(PrismSplit::isotropic, true);
    static const Rule pyramid = make_red_pyramid();
    switch (shape) {
        case Shape::point:
            throw InvalidInput("a point has no refinement");
        case Shape::triangle:
            return red_triangle_rule();
        case Shape::tetrahedron:
            return red_tetrahedron_rule();
        case Shape::pyramid:
            return pyramid;
        case Shape::prism:
            return prism;
        case Shape::segment:
        case Shape::quadrilateral:
        case Shape::hexahedron:
            break;
    }
    return dyadic_rule(shape);
}

const Rule& prism_rule(PrismSplit split) {
    static const std::array<Rule, 3> rules{make_prism(PrismSplit::isotropic),
                                           make_prism(PrismSplit::horizontal),
                                           make_prism(PrismSplit::vertical)};
    return rules.at(static_cast<std::size_t>(split));
}

}  // namespace nestgrid
