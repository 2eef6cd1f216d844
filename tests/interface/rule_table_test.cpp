// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rules found from where children lie are the rules by which they were made.
#include <gtest/gtest.h>

#include <nestgrid/rule_table.hpp>
#include <nestgrid/standard_rules.hpp>

using namespace nestgrid;

namespace {

std::vector<const Rule*> standard_rules() {
    std::vector<const Rule*> rules{&red_triangle_rule()};
    for (int tag = 1; tag <= 2; ++tag) rules.push_back(&bisection_rule(Shape::triangle, tag));
    for (int tag = 1; tag <= 3; ++tag) rules.push_back(&bisection_rule(Shape::tetrahedron, tag));
    for (int d = 0; d < 3; ++d) rules.push_back(&red_tetrahedron_rule(d));
    for (const Shape s : {Shape::segment, Shape::quadrilateral, Shape::hexahedron}) {
        rules.push_back(&dyadic_rule(s));
    }
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

}  // namespace
