// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rules found from where children lie are the rules by which they were made.
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/check_grid.hpp>
#include <nestgrid/detail/shape_functions.hpp>
#include <nestgrid/rule_table.hpp>
#include <nestgrid/standard_rules.hpp>

#include "forest.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace {

std::vector<const Rule*> standard_rules() {
    std::vector<const Rule*> rules{&red_triangle_rule()};
    for (int tag = 1; tag <= 2; ++tag) rules.push_back(&bisection_rule(Shape::triangle, tag));
    for (int tag = 1; tag <= 3; ++tag) rules.push_back(&bisection_rule(Shape::tetrahedron, tag));
    for (int d = 0; d < 3; ++d) rules.push_back(&red_tetrahedron_rule(d));
    for (const Shape s : {Shape::segment, Shape::quadrilateral, Shape::hexahedron}) {
        rules.push_back(&dyadic_rule(s));
    }
    rules.push_back(&red_rule(Shape::pyramid));  // that of prisms has the children of another one
    for (const PrismSplit s :
         {PrismSplit::isotropic, PrismSplit::horizontal, PrismSplit::vertical}) {
        rules.push_back(&prism_rule(s));
    }
    return rules;
}

std::vector<PlacedChild> placed(const Rule& rule) {
    const std::vector<Point> x = reference_nodes(rule);
    std::vector<PlacedChild> children;
    for (const Child& child : rule.children) {
        PlacedChild& to = children.emplace_back();
        to.shape = child.shape;
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            to.corners[i] = x[child.corner[i]];
        }
    }
    return children;
}

TEST(RuleTable, FindsTheStandardRules) {
    RuleTable table;
    for (const Rule* rule : standard_rules()) {
        const std::vector<PlacedChild> children = placed(*rule);
        EXPECT_EQ(table.find(rule->parent, children), nullptr);
        const std::size_t before = table.size();
        const Rule& found = table.add(rule->parent, children);
        EXPECT_EQ(table.size(), before + 1);
        EXPECT_EQ(&table.add(rule->parent, children), &found);
        EXPECT_EQ(table.find(rule->parent, children), &found);
        ASSERT_EQ(found.new_node_count(), rule->new_node_count()) << rule->name;
        EXPECT_EQ(found.name, std::string(topology(rule->parent).name) + " into " +
                                  std::to_string(children.size()));
        const std::vector<Point> x = reference_nodes(*rule);
        const std::vector<Point> y = reference_nodes(found);
        for (std::size_t c = 0; c < rule->children.size(); ++c) {
            const Child& a = rule->children[c];
            const Child& b = found.children[c];
            EXPECT_EQ(a.orientation, b.orientation) << rule->name;
            for (std::size_t i = 0; i < topology(a.shape).corners; ++i) {
                EXPECT_EQ(norm(x[a.corner[i]] - y[b.corner[i]]), 0) << rule->name;
            }
        }
    }
}

TEST(RuleTable, RefusesChildrenThatLeaveAGap) {
    RuleTable table;
    std::vector<PlacedChild> children = placed(red_triangle_rule());
    children.pop_back();
    EXPECT_THROW(table.add(Shape::triangle, children), InvalidInput);
    EXPECT_EQ(table.find(Shape::triangle, children), nullptr);
}

/// Where a point of the reference element of a child lies in that of its father.
Point in_father(const PlacedChild& child, const Point& x) {
    const auto weight = shape_functions(child.shape, x);
    Point result{0, 0, 0};
    for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
        result = result + weight[i] * child.corners[i];
    }
    return result;
}

/// The children of a father that is divided once along some axes, and along them at once: each
/// segment in two, each triangle in four.
std::vector<PlacedChild> divided(Shape shape, Axes axes) {
    if (shape == Shape::prism) {
        return placed(prism_rule(axes == all_axes ? PrismSplit::isotropic
                                 : axes == axis_z ? PrismSplit::vertical
                                                  : PrismSplit::horizontal));
    }
    const Topology& t = topology(shape);
    std::vector<PlacedChild> children;
    for (std::size_t c = 0; c < t.corners; ++c) {
        PlacedChild child{shape, {}};
        bool is_first = true;  // of the children that lie at equal places along the axes
        for (std::size_t d = 0; d < 3; ++d) {
            const bool halved = (axes >> d & 1U) != 0;
            is_first = is_first && (halved || t.reference[c][d] == 0);
            for (std::size_t i = 0; i < t.corners; ++i) {
                child.corners[i][d] =
                    halved ? (t.reference[c][d] + t.reference[i][d]) / 2 : t.reference[i][d];
            }
        }
        if (is_first) children.push_back(child);
    }
    return children;
}

/// The children of the children.
std::vector<PlacedChild> divided_again(const std::vector<PlacedChild>& children, Axes axes) {
    std::vector<PlacedChild> result;
    for (const PlacedChild& child : children) {
        for (PlacedChild grandchild : divided(child.shape, axes)) {
            for (std::size_t i = 0; i < topology(grandchild.shape).corners; ++i) {
                grandchild.corners[i] = in_father(child, grandchild.corners[i]);
            }
            result.push_back(grandchild);
        }
    }
    return result;
}

struct Division {
    Shape shape;
    std::vector<Axes> steps;
};

/// Every way to divide once along each of two or three axes in several steps.
std::vector<Division> divisions() {
    const Shape hexahedron = Shape::hexahedron;
    std::vector<Division> all{{Shape::prism, {axis_x | axis_y, axis_z}},
                              {Shape::prism, {axis_z, axis_x | axis_y}},
                              {Shape::quadrilateral, {axis_x, axis_y}},
                              {Shape::quadrilateral, {axis_y, axis_x}}};
    for (const Axes a : {axis_x, axis_y, axis_z}) {
        all.push_back({hexahedron, {a, static_cast<Axes>(all_axes ^ a)}});
        all.push_back({hexahedron, {static_cast<Axes>(all_axes ^ a), a}});
        for (const Axes b : {axis_x, axis_y, axis_z}) {
            if (a == b) continue;
            all.push_back({hexahedron, {a, b}});
            all.push_back({hexahedron, {a, b, static_cast<Axes>(all_axes ^ a ^ b)}});
        }
    }
    return all;
}

ParentAxes in_these_steps(const Division& division) {
    const std::vector<Axes>& s = division.steps;
    return s.size() == 2 ? in_steps(division.shape, {s[0], s[1]})
                         : in_steps(division.shape, {s[0], s[1], s[2]});
}

template <int dim>
std::uint32_t add_reference(Forest<dim>& forest, Shape shape) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < topology(shape).corners; ++i) {
        corners.push_back(forest.add_node(topology(shape).reference[i]));
    }
    return forest.add_coarse(shape, corners, 1);
}

/// The keys at the corners of the leaves below an element, in order.
template <int dim>
void append_leaf_keys(const Forest<dim>& forest, std::uint32_t e, std::vector<NodeKey>& keys) {
    const auto& cell = forest.cells[e];
    if (cell.rule == nullptr) {
        for (const std::uint32_t n : cell.nodes) keys.push_back(forest.keys[n]);
        return;
    }
    for (std::size_t c = 0; c < cell.rule->children.size(); ++c) {
        append_leaf_keys(forest, cell.first_child + static_cast<std::uint32_t>(c), keys);
    }
}

/// The keys below the reference element, refined by rules one after the other.
template <int dim>
std::vector<NodeKey> leaf_keys(Shape shape, const std::vector<const Rule*>& rules) {
    Forest<dim> forest;
    add_reference(forest, shape);
    for (const Rule* rule : rules) {
        const std::size_t count = forest.cells.size();
        for (std::uint32_t e = 0; e < count; ++e) {
            if (forest.cells[e].rule == nullptr) forest.refine(e, *rule);
        }
    }
    std::vector<NodeKey> keys;
    append_leaf_keys(forest, 0, keys);
    return keys;
}

/// One rule in steps makes the nodes that its steps make one by one, with the same keys; by default
/// it does not.
TEST(RuleTable, MakesRulesInStepsThatMakeTheNodesOfTheirSteps) {
    for (const Division& division : divisions()) {
        RuleTable table;
        std::vector<const Rule*> one_by_one;
        std::vector<PlacedChild> children;
        for (const Axes step : division.steps) {
            children =
                children.empty() ? divided(division.shape, step) : divided_again(children, step);
            one_by_one.push_back(&table.add(division.shape, divided(division.shape, step)));
        }
        const ParentAxes axes = in_these_steps(division);
        const Rule& rule = table.add(division.shape, children, axes);
        EXPECT_EQ(table.find(division.shape, children, axes), &rule);
        EXPECT_EQ(table.find(division.shape, children), nullptr);
        const Rule& by_corners = table.add(division.shape, children);
        const auto keys = [&](const std::vector<const Rule*>& rules) {
            return topology(division.shape).dimension == 3 ? leaf_keys<3>(division.shape, rules)
                                                           : leaf_keys<2>(division.shape, rules);
        };
        EXPECT_EQ(keys({&rule}), keys(one_by_one));
        EXPECT_NE(keys({&by_corners}), keys(one_by_one));
    }
}

TEST(RuleTable, TakesAnAxisForEachFace) {
    RuleTable table;  // tells them apart
    const Topology& t = topology(Shape::hexahedron);
    const std::vector<PlacedChild> children = divided(Shape::hexahedron, all_axes);
    for (std::size_t f = 0; f < t.faces; ++f) {
        for (std::size_t d = 0; d < 3; ++d) {
            Point centre{0, 0, 0};
            for (std::size_t i = 0; i < 4; ++i) {
                centre = centre + 0.25 * t.reference[t.face[f].corner[i]];
            }
            ParentAxes axes;
            axes.face[f] = static_cast<Axes>(1U << d);
            if (centre[d] != 0.5) {  // no axis of the face
                EXPECT_THROW(table.add(Shape::hexahedron, children, axes), InvalidInput);
                continue;
            }
            const Rule& rule = table.add(Shape::hexahedron, children, axes);
            const std::vector<Point> x = reference_nodes(rule);
            for (std::size_t n = 8; n < x.size(); ++n) {
                const Stencil& stencil = rule.new_nodes[n - 8];
                const auto halves = std::count(x[n].begin(), x[n].end(), 0.5);
                if (x[n] != centre) {
                    EXPECT_EQ(stencil.count, 1U << halves);
                    continue;
                }
                ASSERT_EQ(stencil.count, 2);
                const Point along = x[stencil.parent[1]] - x[stencil.parent[0]];
                EXPECT_EQ(std::abs(along[d]), 1);
                EXPECT_EQ(norm(along), 1);
                EXPECT_EQ(stencil.weight[0], 0.5);
            }
        }
    }
}

/// Six pyramids around the centre of a hexahedron: no face has a node in its middle.
std::vector<PlacedChild> around_the_centre() {
    const Topology& t = topology(Shape::hexahedron);
    std::vector<PlacedChild> pyramids;
    for (std::size_t f = 0; f < t.faces; ++f) {
        PlacedChild& pyramid = pyramids.emplace_back(PlacedChild{Shape::pyramid, {}});
        for (std::size_t i = 0; i < 4; ++i) {
            pyramid.corners[i] = t.reference[t.face[f].tensor_corner(static_cast<int>(i))];
        }
        pyramid.corners[4] = {0.5, 0.5, 0.5};
    }
    return pyramids;
}

TEST(RuleTable, RefusesAxesWithoutParents) {
    RuleTable table;
    table.add(Shape::hexahedron, around_the_centre());
    ParentAxes axes;
    axes.inside = axis_x;
    std::string sentence;
    try {
        table.add(Shape::hexahedron, around_the_centre(), axes);
    } catch (const InvalidInput& refusal) {
        sentence = refusal.what();
    }
    EXPECT_EQ(sentence,
              "rule 'hexahedron into 6': the new node at (0.5, 0.5, 0.5) has no parent at "
              "(0, 0.5, 0.5) along its axes");
    EXPECT_THROW(table.add(Shape::tetrahedron, placed(red_tetrahedron_rule()), axes), InvalidInput);
}

/// A second step along an axis makes nodes between new nodes, which axes do not tell from nodes
/// between corners.
TEST(RuleTable, RefusesTwoStepsAlongOneAxis) {
    EXPECT_THROW(in_steps(Shape::quadrilateral, {axis_x, axis_x}), InvalidInput);
    EXPECT_THROW(in_steps(Shape::hexahedron, {axis_x | axis_y, axis_z, axis_y}), InvalidInput);
    EXPECT_THROW(in_steps(Shape::prism, {axis_x, axis_y}), InvalidInput);
    EXPECT_NO_THROW(in_steps(Shape::prism, {axis_x, axis_z}));
}

/// Two elements with a common face, the one beyond the other along x (hexahedra) or across the face
/// along y (prisms); one is divided in steps by one rule, the other by another.
Forest<3> neighbours(Shape shape, const Rule& one, const Rule& other) {
    Forest<3> forest;
    std::map<Point, std::uint32_t> known;
    for (const double side : {0.0, 1.0}) {
        std::vector<std::uint32_t> corners;
        for (std::size_t i = 0; i < topology(shape).corners; ++i) {
            Point x = topology(shape).reference[i];
            if (shape == Shape::hexahedron) x[0] += side;
            if (shape == Shape::prism && side == 1) x[1] = -x[1];
            const auto [at, is_new] = known.emplace(x, 0);
            if (is_new) at->second = forest.add_node(x);
            corners.push_back(at->second);
        }
        forest.add_coarse(shape, corners, shape == Shape::prism && side == 1 ? -1 : 1);
    }
    forest.refine(0, one);
    forest.refine(1, other);
    return forest;
}

/// Two elements that divide a face in one order agree; in two orders, check_grid prints the parents
/// and weights of the face's centre in both.
TEST(RuleTable, GivesNeighboursOneStencil) {
    for (const Shape shape : {Shape::hexahedron, Shape::prism}) {
        const Axes first = shape == Shape::prism ? axis_x | axis_y : axis_y;
        RuleTable table;
        const Rule& across = table.add(shape, divided_again(divided(shape, first), axis_z),
                                       in_steps(shape, {first, axis_z}));
        const Rule& upwards = table.add(shape, divided_again(divided(shape, axis_z), first),
                                        in_steps(shape, {axis_z, first}));
        const auto check = [&](const Rule& one, const Rule& other) {
            const Forest<3> forest = neighbours(shape, one, other);
            return check_grid(forest, ForestField<3>(forest, [](const Point& x) { return x[0]; }));
        };
        for (const Rule* rule : {&across, &upwards}) {
            const auto violation = check(*rule, *rule);
            EXPECT_FALSE(violation) << violation->sentence;
        }
        const auto violation = check(across, upwards);
        ASSERT_TRUE(violation);
        EXPECT_EQ(violation->law, Law::one_stencil);
        const std::string sentence = violation->sentence;
        EXPECT_TRUE(sentence.starts_with("one node has two stencils: 0.5 * (")) << sentence;
        const std::array<std::string, 2> ends =
            shape == Shape::prism ? std::array<std::string, 2>{"(0.5, 0, 0)", "(0.5, 0, 1)"}
                                  : std::array<std::string, 2>{"(1, 0.5, 0)", "(1, 0.5, 1)"};
        EXPECT_NE(sentence.find("0.5 * " + ends[0] + " + 0.5 * " + ends[1] + " in element 0"),
                  std::string::npos)
            << sentence;
    }
}

/// Every node is where the rule says it is a corner of a child.
TEST(Rules, NameAChildOfEveryNode) {
    for (const Rule* rule : standard_rules()) {
        const auto corners = static_cast<std::size_t>(rule->corner_count());
        std::vector<ChildCorner> all = rule->old_corner;
        ASSERT_EQ(all.size(), corners) << rule->name;
        all.insert(all.end(), rule->new_corner.begin(), rule->new_corner.end());
        ASSERT_EQ(all.size(), corners + rule->new_nodes.size()) << rule->name;
        for (std::size_t n = 0; n < all.size(); ++n) {
            EXPECT_EQ(rule->children.at(all[n].child).corner.at(all[n].corner), n) << rule->name;
        }
    }
}

/// In sorted leaves a child's first and last corners are found without a search.
TEST(Rules, PreferTheFirstCornerOfAChildThenTheLast) {
    for (const Rule* rule : standard_rules()) {
        for (std::size_t n = 0; n < rule->old_corner.size(); ++n) {
            const auto is = [&](std::size_t from_end) {
                return std::any_of(rule->children.begin(), rule->children.end(),
                                   [&](const Child& child) {
                                       const std::size_t last = topology(child.shape).corners - 1U;
                                       return child.corner[from_end == 0 ? 0 : last] == n;
                                   });
            };
            const auto [child, corner] = rule->old_corner[n];
            const std::size_t last = topology(rule->children[child].shape).corners - 1U;
            const std::size_t rank = corner == 0 ? 0 : corner == last ? 1 : 2;
            EXPECT_EQ(rank, is(0) ? 0U : is(1) ? 1U : 2U) << rule->name;
        }
    }
}

/// A rule that would be too large says the way out.
TEST(Rules, SayWhatToDoWhereTheyAreTooLarge) {
    std::vector<PlacedChild> parts;
    for (int i = 0; i < 64; ++i) {
        PlacedChild part{Shape::hexahedron, topology(Shape::hexahedron).reference};
        for (Point& x : part.corners) {
            x = {(x[0] + i % 4) / 4, (x[1] + i / 4 % 4) / 4, (x[2] + i / 16) / 4};
        }
        parts.push_back(part);
    }
    RuleTable table;
    const std::string sentence = refusal([&] { table.add(Shape::hexahedron, parts); });
    EXPECT_NE(sentence.find("117 new nodes, more than 64: refine in several steps"),
              std::string::npos)
        << sentence;
}

}  // namespace
