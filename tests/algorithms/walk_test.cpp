// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of the walk and the projection on every kind of grid.
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <walk/for_each_element.hpp>
#include <walk/frontier.hpp>
#include <walk/project.hpp>

#include "forest.hpp"
#include "thread_executor.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace walk_test {

using View = engine::ElementView<double>;
using Walk = engine::Walk<double>;
using engine::Split;
using engine::Visit;

double bumps(const Point& x) {
    return std::sin(5 * x[0]) * std::cos(4 * x[1]) + std::sin(3 * x[2] + x[0]);
}

constexpr engine::Needs everything{.values = true, .keys = true, .positions = true};

/// The corners of an element.
struct Corners {
    std::size_t count;
    std::array<NodeKey, max_corners> key;
    std::array<Point, max_corners> x;

    Corners(const Walk& walk, const View& view) : count{view.corner_count()} {
        walk.corners(view, key.data(), x.data());
    }
};

/// Every node, as seen from every element: all must see the same value and the same place.
double worst_disagreement(const Walk& walk, const Criterion& criterion) {
    std::map<NodeKey, std::pair<double, Point>> seen;
    double worst = 0;
    project(walk, criterion, [&](const View& view) {
        const Corners of(walk, view);
        for (std::size_t k = 0; k < of.count; ++k) {
            const auto [at, is_new] = seen.insert({of.key[k], {view.value[k], of.x[k]}});
            worst = std::max(worst, std::abs(at->second.first - view.value[k]));
            EXPECT_EQ(at->second.second, of.x[k]);
        }
    });
    return worst;
}

/// The largest difference at a node in the middle of an edge or face of the element.
double worst_jump(const View& view, const Corners& of, const std::map<NodeKey, double>& value) {
    const Topology& t = view.topology();
    double worst = 0;
    const auto compare = [&](NodeKey middle, double mean) {
        const auto at = value.find(middle);
        if (at != value.end()) worst = std::max(worst, std::abs(at->second - mean));
    };
    for (std::size_t e = 0; e < t.edges; ++e) {
        const std::size_t a = t.edge[e][0];
        const std::size_t b = t.edge[e][1];
        compare(mean_key(of.key[a] + of.key[b], 2), midpoint(view.value[a], view.value[b]));
    }
    for (std::size_t f = 0; f < t.faces; ++f) {
        if (t.face[f].corners != 4) continue;
        NodeKey sum = 0;
        double mean = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            sum += of.key[t.face[f].corner[i]];
            mean += view.value[t.face[f].corner[i]] / 4;
        }
        compare(mean_key(sum, 4), mean);
    }
    return worst;
}

/// At a node that hangs in an adaptive grid, the coarse element's interpolant is the node's value.
template <int dim>
double worst_jump(const Forest<dim>& forest, const ForestField<dim>& field,
                  const HangingNodes* hanging) {
    const auto hierarchy = erase(forest, field);
    const Walk walk(hierarchy, everything, hanging);
    std::map<NodeKey, double> value;
    project(walk, Exact{}, [&](const View& view) {
        const Corners of(walk, view);
        for (std::size_t k = 0; k < of.count; ++k) value[of.key[k]] = view.value[k];
    });
    double worst = 0;
    project(walk, Exact{}, [&](const View& view) {
        worst = std::max(worst, worst_jump(view, Corners(walk, view), value));
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

/// Saturation: S true at any corner implies S true at all new nodes. One look tells of them all.
void expect_saturated(const Walk& walk, const HierarchicalIndicator& indicator) {
    for (int level = 0; level < count_levels(walk); ++level) {
        for_each_on_level(walk, level, [&](const View& view, const Split& split) {
            const Corners of(walk, view);
            for (const NodeKey node : split.keys) {
                EXPECT_GE(indicator.bound(*split.rule, split.keys), indicator.bound(node));
                for (std::size_t k = 0; k < of.count; ++k) {
                    EXPECT_GE(indicator.stop(of.key[k]), indicator.stop(node));
                    EXPECT_GE(indicator.bound(of.key[k]), indicator.bound(node));
                }
                const NodeMask stops =
                    indicator.stops_at_most(*split.rule, split.keys, indicator.stop(node));
                for (std::size_t n = 0; n < split.keys.size(); ++n) {
                    EXPECT_EQ((stops >> n & 1U) != 0,
                              indicator.stop(split.keys[n]) <= indicator.stop(node));
                }
            }
        });
    }
}

template <int dim>
void expect_single_valued(const Forest<dim>& forest) {
    const ForestField<dim> field(forest, bumps);
    const HierarchicalIndicator indicator(forest, field);
    const auto hierarchy = erase(forest, field);
    const Walk walk(hierarchy, everything, indicator.hanging());
    std::size_t before = 0;
    for (const double epsilon : {1e9, 0.5, 0.1, 0.01, 0.0}) {
        const Threshold criterion(&indicator, epsilon);
        EXPECT_EQ(worst_disagreement(walk, criterion), 0);
        // Without a test of interest, more epsilon never visits more.
        std::size_t elements = 0;
        project(walk, criterion, [&](const View&) { ++elements; });
        EXPECT_GE(elements, before);
        before = elements;
    }
    expect_saturated(walk, indicator);
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
    const auto hierarchy = erase(forest, field);
    const Walk walk(hierarchy, everything);
    std::size_t elements = 0;
    project(walk, Threshold(&indicator, 0), [&](const View& view) {
        ++elements;
        const Corners of(walk, view);
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(view.value[k], linear(of.x[k]));
    });
    EXPECT_EQ(elements, 6U);  // dyadic coordinates are exact: no offset at all, only coarse ones
}

const Rule& red_triangle() {
    static const Rule red =
        make_rule("red", Shape::triangle, {mean_of({0, 1}), mean_of({1, 2}), mean_of({2, 0})},
                  {{Shape::triangle, {0, 3, 5}, 1, {}},
                   {Shape::triangle, {3, 1, 4}, 1, {}},
                   {Shape::triangle, {5, 4, 2}, 1, {}},
                   {Shape::triangle, {3, 4, 5}, 1, {}}});
    return red;
}

/// Copies below copies: rules without new nodes, which are never shown to a visitor.
Forest<2> copies_below_copies() {
    static const Rule copy =
        make_rule("copy", Shape::triangle, {}, {{Shape::triangle, {1, 2, 0}, 1, {}}});
    Forest<2> forest = kuhn<2>(0);
    for (std::uint32_t e = 0; e < 2; ++e) forest.refine(e, copy);
    for (std::uint32_t e = 2; e < 4; ++e) forest.refine(e, copy);
    for (std::uint32_t e = 4; e < 6; ++e) forest.refine(e, red_triangle());
    return forest;
}

TEST(Copies, AreLookedThrough) {
    Forest<2> plain = kuhn<2>(0);
    for (std::uint32_t e = 0; e < 2; ++e) plain.refine(e, red_triangle());
    const Forest<2> copied = copies_below_copies();
    const auto count = [](const Forest<2>& forest, double epsilon) {
        const ForestField<2> field(forest, bumps);
        const HierarchicalIndicator indicator(forest, field);
        const auto hierarchy = erase(forest, field);
        std::size_t elements = 0;
        project(Walk(hierarchy, everything), Threshold(&indicator, epsilon),
                [&](const View&) { ++elements; });
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

/// Compares two indicators of one hierarchy, bit by bit.
template <class Grid, class Field>
void expect_same_indicators(const Grid& grid, const Field& field, const HierarchicalIndicator& one,
                            const HierarchicalIndicator& other) {
    using Real = typename Field::value_type;
    EXPECT_EQ(one.node_count(), other.node_count());
    EXPECT_EQ(one.finest_level(), other.finest_level());
    EXPECT_EQ(one.stops_conform(), other.stops_conform());
    EXPECT_EQ(one.greatest(), other.greatest());
    const auto hierarchy = erase(grid, field);
    std::size_t compared = 0;
    for_each_element(engine::Walk<Real>(hierarchy, {}), true,
                     [&](const engine::ElementView<Real>&, const Split& split) {
                         for (const NodeKey node : split.keys) {
                             ASSERT_EQ(one.stop(node), other.stop(node));
                             ASSERT_EQ(one.bound(node), other.bound(node));
                             ++compared;
                         }
                     });
    EXPECT_GT(compared, 50U);
}

template <class Grid>
void expect_same_regions(const Grid& grid, const Region& one, const Region& other) {
    const ZeroField<Grid> zero;
    const auto hierarchy = erase(grid, zero);
    std::size_t compared = 0;
    for_each_element(engine::Walk<float>(hierarchy, {.values = false}), true,
                     [&](const engine::ElementView<float>&, const Split& split) {
                         for (std::size_t i = 0; i < split.keys.size(); ++i) {
                             // No element stops at these anyway.
                             if ((split.outside >> i & 1U) != 0) continue;
                             ASSERT_EQ(one.contains(split.keys[i]), other.contains(split.keys[i]));
                             ++compared;
                         }
                     });
    EXPECT_GT(compared, Grid::dimension == 2 ? 50U : 1000U);
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
        ASSERT_TRUE(erase(grid, field).facts().knows_stars);
        ASSERT_FALSE(erase(plain, field).facts().knows_stars);
        const HierarchicalIndicator stars(grid, field);
        expect_same_indicators(grid, field, stars, HierarchicalIndicator(plain, field));
        expect_same_indicators(grid, field, stars,
                               HierarchicalIndicator(plain, field, ThreadExecutor(2)));
        const auto inside = [](const Point& x) { return x[0] < 3 && x[1] > 4; };
        expect_same_regions(grid, Region(grid, inside), Region(plain, inside));
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

/// Stops at a level and lists everything it is told.
class Listing final : public engine::TaskVisitor<double> {
public:
    explicit Listing(int finest) : finest_{finest} {}

    const std::vector<NodeKey>& extracted() const { return extracted_; }
    std::size_t calls() const { return calls_; }
    void start_from(const Listing& other) { calls_ = other.calls_; }

    engine::Decision look(const View& view, const Split&) override {
        return {view.level >= finest_ ? Visit::stop : Visit::descend, 0};
    }
    engine::Decision inspect(const View& view, const Split& split) override {
        ++calls_;
        return look(view, split);
    }
    void extract(const View& view) override { extracted_.push_back(view.path); }
    void undo() override { --calls_; }
    void restart() override { calls_ = 0; }

private:
    int finest_;
    std::size_t calls_ = 0;
    std::vector<NodeKey> extracted_;
};

/// Whatever the number of parts, they extract each element once, in the order of one walk.
void expect_whole_in_parts(const Walk& walk) {
    for (const int finest : {0, 2, 100}) {
        Listing whole(finest);
        walk.run(whole);
        for (const std::size_t wanted : {1U, 3U, 50U, 100000U}) {
            Listing above(finest);
            const engine::Frontier<double> frontier(walk, above, wanted);
            const std::size_t entries = frontier.entry_count();
            for (const std::size_t parts : std::array<std::size_t, 4>{1, 2, 7, entries}) {
                Listing in_parts(finest);
                in_parts.start_from(above);
                for (std::size_t i = 0; i < parts; ++i) {
                    frontier.run(walk, i * entries / parts, (i + 1) * entries / parts, in_parts);
                }
                EXPECT_EQ(in_parts.extracted(), whole.extracted());
                EXPECT_EQ(in_parts.calls(), whole.calls());
            }
        }
    }
}

TEST(Frontier, PartsCoverEveryElementOnceAndInOrder) {
    for (unsigned seed = 0; seed < 5; ++seed) {
        std::mt19937 random(seed);
        Forest<3> forest = boxes<3>(random, 2);
        refine_randomly(forest, random, 60);
        const ForestField<3> field(forest, bumps);
        const auto hierarchy = erase(forest, field);
        expect_whole_in_parts(Walk(hierarchy, everything));
    }
}

TEST(Frontier, LooksThroughCopies) {
    const Forest<2> forest = copies_below_copies();
    const ForestField<2> field(forest, bumps);
    const auto hierarchy = erase(forest, field);
    expect_whole_in_parts(Walk(hierarchy, everything));
}

}  // namespace walk_test
