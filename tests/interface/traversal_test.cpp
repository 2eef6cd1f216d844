// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of the traversal and the projection on every kind of grid.
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/project.hpp>
#include <nestgrid/algorithms/region.hpp>

#include "forest.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

double bumps(const Point& x) {
    return std::sin(5 * x[0]) * std::cos(4 * x[1]) + std::sin(3 * x[2] + x[0]);
}

constexpr Needs everything{.keys = true, .positions = true};

/// Every node, as seen from every element: all must see the same value and the same place.
template <class Walk, class S>
double worst_disagreement(const Walk& walk, const S& criterion) {
    std::map<NodeKey, std::pair<double, Point>> seen;
    double worst = 0;
    project(walk, criterion, [&](const auto& s) {
        std::array<NodeKey, max_corners> keys;
        std::array<Point, max_corners> x;
        walk.keys(s, keys);
        walk.positions(s, x);
        for (std::size_t k = 0; k < static_cast<std::size_t>(s.corner_count()); ++k) {
            const auto [at, is_new] = seen.insert({keys[k], {s.value[k], x[k]}});
            worst = std::max(worst, std::abs(at->second.first - s.value[k]));
            EXPECT_EQ(at->second.second, x[k]);
        }
    });
    return worst;
}

/// At a node that hangs in an adaptive grid, the coarse element's interpolant is the node's value.
template <int dim>
double worst_jump(const Forest<dim>& forest, const ForestField<dim>& field,
                  const HangingNodes* hanging) {
    const Traversal<Forest<dim>, ForestField<dim>, everything> walk(forest, field, hanging);
    std::map<NodeKey, double> value;
    project(walk, Exact{}, [&](const auto& s) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(s.corner_count()); ++k) {
            value[s.key[k]] = s.value[k];
        }
    });
    double worst = 0;
    project(walk, Exact{}, [&](const auto& s) {
        const Topology& t = topology(s.shape);
        for (std::size_t e = 0; e < t.edges; ++e) {
            const std::size_t a = t.edge[e][0];
            const std::size_t b = t.edge[e][1];
            const auto at = value.find(mean_key(s.key[a] + s.key[b], 2));
            if (at != value.end()) {
                worst = std::max(worst, std::abs(at->second - midpoint(s.value[a], s.value[b])));
            }
        }
        for (std::size_t f = 0; f < t.faces; ++f) {
            if (t.face[f].corners != 4) continue;
            NodeKey sum = 0;
            double mean = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                sum += s.key[t.face[f].corner[i]];
                mean += s.value[t.face[f].corner[i]] / 4;
            }
            const auto at = value.find(mean_key(sum, 4));
            if (at != value.end()) worst = std::max(worst, std::abs(at->second - mean));
        }
    });
    return worst;
}

TEST(Projection, IsContinuousOnUnbalancedOctreesOnlyWithTheConstrainedNodes) {
    double without = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        Forest<3> forest = boxes<3>(random, 2);
        refine_randomly(forest, random, 150);
        const ForestField<3> field(forest, bumps);
        const HangingNodes hanging = derive_hanging_nodes(forest);
        EXPECT_GT(hanging.size(), 0U);
        EXPECT_LT(worst_jump(forest, field, &hanging), 1e-15);
        without = std::max(without, worst_jump(forest, field, nullptr));
    }
    EXPECT_GT(without, 0.05) << "the test cannot fail";
}

template <int dim>
void expect_single_valued(const Forest<dim>& forest) {
    const ForestField<dim> field(forest, bumps);
    const HierarchicalIndicator indicator(forest, field);
    const Traversal<Forest<dim>, ForestField<dim>, everything> walk(forest, field,
                                                                    indicator.hanging());
    std::size_t before = 0;
    for (const double epsilon : {1e9, 0.5, 0.1, 0.01, 0.0}) {
        const Threshold<HierarchicalIndicator> criterion{&indicator, epsilon};
        EXPECT_EQ(worst_disagreement(walk, criterion), 0);
        // Without a test of interest, more epsilon never visits more.
        std::size_t elements = 0;
        project(walk, criterion, [&](const auto&) { ++elements; });
        EXPECT_GE(elements, before);
        before = elements;
    }
    // Saturation: S true at any corner implies S true at all new nodes. One look tells of them all.
    for (int level = 0; level < count_levels(walk); ++level) {
        for_each_on_level(walk, level, [&](const auto& s, const Split& split) {
            for (const NodeKey node : split.keys) {
                EXPECT_GE(indicator.largest_stop(*split.rule, split.keys), indicator.stop(node));
                EXPECT_GE(indicator.bound(*split.rule, split.keys), indicator.bound(node));
                for (std::size_t k = 0; k < static_cast<std::size_t>(s.corner_count()); ++k) {
                    EXPECT_GE(indicator.stop(s.key[k]), indicator.stop(node));
                    EXPECT_GE(indicator.bound(s.key[k]), indicator.bound(node));
                }
            }
        });
    }
}

TEST(Projection, IsSingleValuedAndSaturatedOnEveryForest) {
    for (unsigned seed = 0; seed < 8; ++seed) {
        std::mt19937 random(seed);
        for (auto& forest : {kuhn<3>(0), kuhn<3>(3), boxes<3>(random, 2)}) {
            Forest<3> copy = forest;
            refine_randomly(copy, random, 200);
            expect_single_valued(copy);
        }
        for (auto& forest : {kuhn<2>(2), boxes<2>(random, 2)}) {
            Forest<2> copy = forest;
            refine_randomly(copy, random, 100);
            expect_single_valued(copy);
        }
    }
}

TEST(Projection, ReproducesLinearFunctionsAtAnyThreshold) {
    Forest<3> forest = kuhn<3>(3);
    std::mt19937 random(1);
    refine_randomly(forest, random, 300);
    const auto linear = [](const Point& x) { return 0.25 + x[0] - 0.5 * x[1] + 2 * x[2]; };
    const ForestField<3> field(forest, linear);
    const HierarchicalIndicator indicator(forest, field);
    const Traversal<Forest<3>, ForestField<3>, everything> walk(forest, field);
    std::size_t elements = 0;
    project(walk, Threshold<HierarchicalIndicator>{&indicator, 0}, [&](const auto& s) {
        ++elements;
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(s.value[k], linear(s.position[k]));
    });
    EXPECT_EQ(elements, 6U);  // dyadic coordinates are exact: no offset at all, only coarse ones
}

/// Copies below copies: rules without new nodes, which are never shown to a visitor.
TEST(Copies, AreLookedThrough) {
    static const Rule copy =
        make_rule("copy", Shape::triangle, {}, {{Shape::triangle, {1, 2, 0}, 1, {}}});
    Forest<2> plain = kuhn<2>(0);
    Forest<2> copied = kuhn<2>(0);
    static const Rule red =
        make_rule("red", Shape::triangle, {mean_of({0, 1}), mean_of({1, 2}), mean_of({2, 0})},
                  {{Shape::triangle, {0, 3, 5}, 1, {}},
                   {Shape::triangle, {3, 1, 4}, 1, {}},
                   {Shape::triangle, {5, 4, 2}, 1, {}},
                   {Shape::triangle, {3, 4, 5}, 1, {}}});
    for (std::uint32_t e = 0; e < 2; ++e) plain.refine(e, red);
    for (std::uint32_t e = 0; e < 2; ++e) copied.refine(e, copy);
    for (std::uint32_t e = 2; e < 4; ++e) copied.refine(e, copy);
    for (std::uint32_t e = 4; e < 6; ++e) copied.refine(e, red);
    const auto count = [](const Forest<2>& forest, double epsilon) {
        const ForestField<2> field(forest, bumps);
        const HierarchicalIndicator indicator(forest, field);
        const Traversal<Forest<2>, ForestField<2>, everything> walk(forest, field);
        std::size_t elements = 0;
        project(walk, Threshold<HierarchicalIndicator>{&indicator, epsilon},
                [&](const auto&) { ++elements; });
        return std::pair(elements, indicator.node_count());
    };
    for (const double epsilon : {0.0, 0.1, 1e9})
        EXPECT_EQ(count(plain, epsilon), count(copied, epsilon));
    EXPECT_EQ(count(copied, 0).first, 8U);
    EXPECT_EQ(count(copied, 1e9).first, 2U);
}

/// What sorts all sequences of zeros and ones sorts all others.
TEST(Means, AreSummedInOrder) {
    for (unsigned bits = 0; bits < 256; ++bits) {
        std::array<double, 8> x;
        for (std::size_t i = 0; i < 8; ++i) x[i] = bits >> i & 1U;
        sort_eight(x);
        EXPECT_TRUE(std::ranges::is_sorted(x)) << bits;
    }
}

TEST(Weights, OfAThirdAreClampedAndKeyedApart) {
    static const Rule thirds = make_rule("thirds", Shape::segment,
                                         {weighted_mean_of({{0, 2.0 / 3}, {1, 1.0 / 3}}),
                                          weighted_mean_of({{0, 1.0 / 3}, {1, 2.0 / 3}})},
                                         {{Shape::segment, {0, 2}, 1, {}},
                                          {Shape::segment, {2, 3}, 1, {}},
                                          {Shape::segment, {3, 1}, 1, {}}});
    const std::array<NodeKey, 4> keys{11, 12};
    EXPECT_NE(derived_key(thirds.new_nodes[0], keys.data()),
              derived_key(thirds.new_nodes[1], keys.data()));
    const std::array<NodeKey, 4> turned{12, 11};
    EXPECT_EQ(derived_key(thirds.new_nodes[0], keys.data()),
              derived_key(thirds.new_nodes[1], turned.data()));
    const std::array<double, 4> equal{0.1, 0.1};
    EXPECT_EQ(detail::interpolate(thirds.new_nodes[0], equal.data(), 1), 0.1);
}

/// The star sweep of the lattice and the level sweep of the same elements find the same numbers.
template <class Grid, class Real>
void expect_stars_like_levels() {
    constexpr auto dim = static_cast<std::size_t>(Grid::dimension);
    struct Plain : Grid {
        using Grid::Grid;
        void for_each_star_row() const = delete;
    };
    for (const std::array<int, 3>& n : {std::array{9, 9, 9}, std::array{17, 17, 17},
                                        std::array{11, 6, 20}, std::array{30, 17, 3}}) {
        std::array<int, dim> samples;
        std::copy_n(n.begin(), dim, samples.begin());
        std::mt19937 random(7);
        std::vector<Real> values(static_cast<std::size_t>(n[0] * n[1] * (dim == 2 ? 1 : n[2])));
        for (Real& v : values) v = static_cast<Real>(random() % 1000) / 7;
        const Grid grid({.samples = samples, .block_levels = 3});
        const Plain plain({.samples = samples, .block_levels = 3});
        const LatticeField field(grid, std::span<const Real>(values));
        const HierarchicalIndicator stars(grid, field);
        const HierarchicalIndicator levels(plain, field);
        EXPECT_EQ(stars.node_count(), levels.node_count());
        EXPECT_EQ(stars.finest_level(), levels.finest_level());
        EXPECT_EQ(stars.stops_conform(), levels.stops_conform());
        EXPECT_EQ(stars.greatest(), levels.greatest());
        const auto inside = [&](const Point& x) { return x[0] < 3 && x[1] > 4; };
        const Region star_region(grid, inside);
        const Region level_region(plain, inside);
        std::size_t compared = 0;
        const Traversal<Grid, decltype(field), Needs{.keys = true}> walk(grid, field);
        for_each_element(walk, [&](const auto&, const Split& split) {
            for (std::size_t i = 0; i < split.keys.size(); ++i) {
                const NodeKey node = split.keys[i];
                ASSERT_EQ(stars.stop(node), levels.stop(node)) << node;
                ASSERT_EQ(stars.bound(node), levels.bound(node)) << node;
                // No element stops at the others anyway.
                if ((split.outside >> i & 1U) != 0) continue;
                ASSERT_EQ(star_region.contains(node), level_region.contains(node)) << node;
                ++compared;
            }
        });
        EXPECT_GT(compared, dim == 2 ? 50U : 1000U);
    }
}
TEST(Indicator, OfStarsIsThatOfLevels) {
    expect_stars_like_levels<LatticeBisection<2>, float>();
    expect_stars_like_levels<LatticeBisection<3>, float>();
    expect_stars_like_levels<LatticeBisection<3>, double>();
    expect_stars_like_levels<LatticeOctree<2>, float>();
    expect_stars_like_levels<LatticeOctree<3>, float>();
    expect_stars_like_levels<LatticeOctree<3>, double>();
}

}  // namespace
