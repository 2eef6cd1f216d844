// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of every family of stored hierarchies: red-green, bisection, octree, prism.
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <nestgrid/check_grid.hpp>

#include "families.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

/// Neumaier's sum: the volumes of a million elements to the last digits.
struct Sum {
    double value = 0, rest = 0;
    void add(double x) {
        const double t = value + x;
        rest += std::abs(value) >= std::abs(x) ? (value - t) + x : (x - t) + value;
        value = t;
    }
    double get() const { return value + rest; }
};

template <class Grid>
double leaf_volume(const Grid& grid) {
    Sum sum;
    grid.for_each_leaf(
        [&](const Leaf& leaf) { sum.add(std::abs(measure(leaf.shape, leaf.corners))); });
    return sum.get();
}

template <class Grid>
double coarse_volume(const Grid& grid) {
    Sum sum;
    for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
        const auto c = grid.coarse(i);
        sum.add(std::abs(measure(c.shape, std::span(c.corners).first(topology(c.shape).corners))));
    }
    return sum.get();
}

double smooth(const Point& x) { return x[0] + x[1] * x[1] - 0.3 * x[2] * x[0]; }

/// Area (length) of faces of elements that belong to one element only.
class Skin {
public:
    void add(Shape shape, std::span<const Point> x, std::span<const std::uint32_t> nodes) {
        const Topology& t = topology(shape);
        for (std::size_t f = 0; f < t.faces; ++f) {
            std::set<std::uint32_t> of;
            std::array<Point, 4> y;
            for (std::size_t i = 0; i < t.face[f].corners; ++i) {
                const std::uint8_t corner = t.face[f].tensor_corner(static_cast<int>(i));
                of.insert(nodes[corner]);
                y[i] = x[corner];
            }
            auto& [count, area] = faces_[of];
            ++count;
            area = measure(t.face[f].shape, y);
        }
    }
    double area() const {
        Sum sum;
        for (const auto& [nodes, face] : faces_) {
            EXPECT_LE(face.first, 2);
            if (face.first == 1) sum.add(face.second);
        }
        return sum.get();
    }

private:
    std::map<std::set<std::uint32_t>, std::pair<int, double>> faces_;
};

/// Leaves that conform share whole faces: the others make up the boundary of the domain.
template <class Grid>
void expect_shared_faces(const Grid& grid) {
    Skin coarse;
    for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
        const auto of = grid.coarse_grid().element(i);
        const auto c = grid.coarse(i);
        coarse.add(c.shape, std::span(c.corners).first(of.size()), of);
    }
    Skin leaves;
    grid.for_each_leaf([&](const Leaf& l) { leaves.add(l.shape, l.corners, l.nodes); });
    EXPECT_NEAR(leaves.area(), coarse.area(), 1e-9);
}

/// check_grid, volume, counts, shared faces.
template <class Grid>
void expect_sound(const Grid& grid) {
    const std::vector<double> values = sample_nodes(grid, smooth);
    const NodeField field(grid, values);
    const auto violation = check_grid(grid, field);
    ASSERT_FALSE(violation) << violation->sentence;
    EXPECT_NEAR(leaf_volume(grid) / coarse_volume(grid), 1, 1e-12);
    std::size_t leaves = 0;
    std::set<std::uint32_t> nodes;
    grid.for_each_leaf([&](const Leaf& leaf) {
        ++leaves;
        nodes.insert(leaf.nodes.begin(), leaf.nodes.end());
    });
    EXPECT_EQ(leaves, grid.leaf_count());
    EXPECT_EQ(nodes.size(), grid.used_node_count());
    EXPECT_LT(*nodes.rbegin(), grid.node_count());
    if constexpr (requires { grid.conforming(); }) {
        if (grid.leaf_count() < 100000) expect_shared_faces(grid);
    }
}

template <class Family>
class Hierarchies : public testing::Test {};

TYPED_TEST_SUITE(Hierarchies, Families);

TYPED_TEST(Hierarchies, CoarseAndUniform) {
    for (auto grid : TypeParam::grids()) {
        expect_sound(grid);
        std::size_t leaves = grid.leaf_count();
        for (int level = 0; level < 2 * TypeParam::steps; ++level) {
            grid.refine_uniformly();
            EXPECT_GE(grid.leaf_count(), 2 * leaves);
            leaves = grid.leaf_count();
            expect_sound(grid);
        }
    }
}

TYPED_TEST(Hierarchies, AdaptiveAroundASphere) {
    auto grid = TypeParam::grids().front();
    refine_at_sphere(grid, (grid.dimension == 2 ? 8 : 6) * TypeParam::steps);
    EXPECT_GT(grid.leaf_count(), 500U);
    expect_sound(grid);
}

/// Marks drawn from a hash of the leaf: the same leaf gets the same mark in the same step.
template <class Grid>
auto random_marks(std::mt19937& random, int refine_percent, int coarsen_percent, int levels) {
    return [&random, refine_percent, coarsen_percent, levels](const Leaf& leaf) {
        const auto draw = static_cast<int>(random() % 100);
        if (draw < refine_percent && leaf.level < levels) return Mark::refine;
        return draw >= 100 - coarsen_percent ? Mark::coarsen : Mark::keep;
    };
}

TYPED_TEST(Hierarchies, RandomSequencesKeepEveryInvariant) {
    std::mt19937 random(12);
    for (auto grid : TypeParam::grids()) {
        for (int step = 0; step < 700; ++step) {
            const bool shrink = grid.leaf_count() > 600 || random() % 4 == 0;
            // Whole regions coarsen, or else families would hardly ever agree.
            const double where = double(random() % 1000) / 1000;
            const auto drawn = random_marks<decltype(grid)>(random, 4, 0, 6 * TypeParam::steps);
            grid.adapt([&](const Leaf& leaf) {
                if (!shrink) return drawn(leaf);
                return std::abs(leaf.centre()[0] - where) < 0.4 || random() % 10 > 0 ? Mark::coarsen
                                                                                     : Mark::keep;
            });
            ASSERT_NEAR(leaf_volume(grid) / coarse_volume(grid), 1, 1e-12) << "step " << step;
            if (step % 20 == 0) {
                expect_sound(grid);
                if (this->HasFatalFailure()) return;
            }
        }
    }
}

TYPED_TEST(Hierarchies, EverythingCanBeCoarsenedAgain) {
    for (auto grid : TypeParam::grids()) {
        const std::size_t coarse = grid.leaf_count();
        refine_at_sphere(grid, 3 * TypeParam::steps);
        EXPECT_GT(grid.leaf_count(), coarse);
        for (int i = 0; i < 60 && grid.leaf_count() > coarse; ++i) {
            grid.adapt([](const Leaf&) { return Mark::coarsen; });
        }
        EXPECT_EQ(grid.leaf_count(), coarse);
        EXPECT_EQ(grid.used_node_count(), grid.coarse_grid().nodes.size());
        expect_sound(grid);
    }
}

/// The store depends on the grid, not on how it came about.
TYPED_TEST(Hierarchies, BytesDoNotDependOnHistory) {
    auto grid = TypeParam::grids().front();
    refine_at_sphere(grid, 3 * TypeParam::steps);
    const std::size_t bytes = grid.memory_bytes();
    const std::size_t leaves = grid.leaf_count();
    const std::size_t nodes = grid.used_node_count();
    for (int round = 0; round < 5; ++round) {
        for (int i = 0; i < 40; ++i) grid.adapt([](const Leaf&) { return Mark::coarsen; });
        refine_at_sphere(grid, 3 * TypeParam::steps);
    }
    EXPECT_EQ(grid.leaf_count(), leaves);
    EXPECT_EQ(grid.used_node_count(), nodes);
    EXPECT_EQ(grid.node_count(), nodes);
    EXPECT_EQ(grid.memory_bytes(), bytes);
}

/// Nodes keep their numbers, and interpolation reproduces a linear function.
TYPED_TEST(Hierarchies, ValuesFollowTheGrid) {
    const auto linear = [](const Point& x) { return 1 + 2 * x[0] - x[1] + 0.5 * x[2]; };
    std::mt19937 random(5);
    auto grid = TypeParam::grids().front();
    std::vector<double> values = sample_nodes(grid, linear);
    for (int step = 0; step < 40; ++step) {
        const auto drawn = random_marks<decltype(grid)>(random, 20, 0, 4 * TypeParam::steps);
        const Adaptation done = grid.adapt(
            [&](const Leaf& leaf) { return step % 3 == 2 ? Mark::coarsen : drawn(leaf); });
        done.interpolate(values, grid.node_count());
        grid.for_each_leaf([&](const Leaf& leaf) {
            for (std::size_t i = 0; i < leaf.nodes.size(); ++i) {
                ASSERT_NEAR(values[leaf.nodes[i]], linear(leaf.corners[i]), 1e-12);
            }
        });
    }
}

/// Renumbering leaves no gaps, moves every node to where the map says, and changes nothing else.
TYPED_TEST(Hierarchies, RenumberingKeepsTheGrid) {
    for (auto grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        std::mt19937 random(6);
        grid.adapt([&](const Leaf& leaf) {
            return leaf.centre()[0] < 0.5 ? Mark::coarsen
                   : random() % 5 == 0    ? Mark::refine
                                          : Mark::keep;
        });
        const std::vector<Point> before = grid.node_positions();
        const std::size_t leaves = grid.leaf_count();
        const std::size_t used = grid.used_node_count();
        const std::vector<std::uint32_t> to = grid.renumber();
        EXPECT_EQ(grid.node_count(), used);
        EXPECT_EQ(grid.leaf_count(), leaves);
        const std::vector<Point> after = grid.node_positions();
        std::size_t moved = 0;
        for (std::size_t node = 0; node < to.size(); ++node) {
            if (to[node] == no_node) continue;
            EXPECT_EQ(after.at(to[node]), before[node]);
            ++moved;
        }
        EXPECT_EQ(moved, used);
        expect_sound(grid);
    }
}

template <class Grid>
std::map<Shape, std::size_t> shapes(const Grid& grid) {
    std::map<Shape, std::size_t> count;
    grid.for_each_leaf([&](const Leaf& leaf) { ++count[leaf.shape]; });
    return count;
}

TEST(RedGreen, ClosureOfHexahedraMixesAllShapes) {
    RedGreenGrid<3> grid(hexahedra(3));
    std::mt19937 random(1);
    for (int step = 0; step < 3; ++step) {
        grid.adapt([&](const Leaf&) { return random() % 8 == 0 ? Mark::refine : Mark::keep; });
        expect_sound(grid);
    }
    const auto count = shapes(grid);
    for (const Shape s : {Shape::tetrahedron, Shape::pyramid, Shape::prism, Shape::hexahedron}) {
        EXPECT_GT(count.at(s), 0U) << topology(s).name;
    }
}

TEST(RedGreen, RulesGoWithTheLastElementThatHasThem) {
    RedGreenGrid<3> grid(hexahedra(2));
    std::mt19937 random(1);
    for (int step = 0; step < 3; ++step) {
        grid.adapt([&](const Leaf&) { return random() % 5 == 0 ? Mark::refine : Mark::keep; });
    }
    EXPECT_GT(grid.rule_count(), 20U);
    for (int step = 0; step < 10; ++step) grid.adapt([](const Leaf&) { return Mark::coarsen; });
    EXPECT_EQ(grid.leaf_count(), 8U);
    EXPECT_EQ(grid.rule_count(), 0U);
}

TEST(RedGreen, GreenIsReplacedWhenRefined) {
    RedGreenSimplices<2> grid(triangles(1));
    grid.adapt([](const Leaf& leaf) { return leaf.coarse == 0 ? Mark::refine : Mark::keep; });
    EXPECT_EQ(grid.leaf_count(), 6U);  // four red, two green
    grid.adapt([](const Leaf& leaf) { return leaf.coarse == 1 ? Mark::refine : Mark::keep; });
    EXPECT_EQ(grid.leaf_count(), 8U);  // the second one is red now
}

/// Refined around a corner again and again, elements do not degenerate.
template <class Grid>
double worst_quality(const Grid& grid) {
    double worst = 1;
    grid.for_each_leaf([&](const Leaf& leaf) {
        double longest = 0;
        for (const Point& a : leaf.corners) {
            for (const Point& b : leaf.corners) longest = std::max(longest, norm(a - b));
        }
        worst = std::min(worst, std::abs(measure(leaf.shape, leaf.corners)) /
                                    std::pow(longest, Grid::dimension));
    });
    return worst;
}

template <class Grid>
void expect_stable_shapes(Grid grid, int steps) {
    std::vector<double> quality;
    for (int step = 0; step < steps; ++step) {
        grid.adapt([&](const Leaf& leaf) {
            const double d = norm(leaf.centre() - Point{0.3, 0.4, Grid::dimension == 3 ? 0.2 : 0});
            return d < std::pow(0.5, step / (steps / 12.0)) ? Mark::refine : Mark::keep;
        });
        quality.push_back(worst_quality(grid));
    }
    EXPECT_GE(quality.back(), 0.999 * quality[quality.size() / 2]);
}

TEST(Hierarchy, ShapesStayStable) {
    expect_stable_shapes(BisectionGrid<2>(shaken(triangles(2), 1, 0.1)), 24);
    expect_stable_shapes(BisectionGrid<3>(shaken(tetrahedra(1), 1, 0)), 36);
    expect_stable_shapes(RedGreenSimplices<2>(shaken(triangles(2), 1, 0.1)), 12);
    expect_stable_shapes(RedGreenSimplices<3>(shaken(tetrahedra(1), 1, 0)), 12);
}

TEST(Octree, BalanceLimitsLevelsAcrossEdges) {
    for (const bool balanced : {true, false}) {
        OctreeGrid<3> grid(hexahedra(2), {.balanced = balanced});
        for (int step = 0; step < 5; ++step) {
            grid.adapt([](const Leaf& leaf) {
                return norm(leaf.corners[7] - Point{0.5, 0.5, 0.5}) < 1e-9 ? Mark::refine
                                                                           : Mark::keep;
            });
        }
        std::map<std::uint32_t, std::pair<int, int>> levels;  // at nodes
        grid.for_each_leaf([&](const Leaf& leaf) {
            for (const std::uint32_t n : leaf.nodes) {
                auto& [least, most] = levels.try_emplace(n, leaf.level, leaf.level).first->second;
                least = std::min(least, leaf.level);
                most = std::max(most, leaf.level);
            }
        });
        int jump = 0;
        for (const auto& [node, range] : levels) jump = std::max(jump, range.second - range.first);
        if (balanced) {
            EXPECT_LE(jump, 2);  // two across a corner
            EXPECT_GT(grid.leaf_count(), 100U);
        } else {
            EXPECT_EQ(jump, 5);
            EXPECT_EQ(grid.leaf_count(), 8 + 5 * 7U);
        }
        expect_sound(grid);
    }
}

Mark horizontal(const Leaf&) { return Mark::refine_horizontally; }
Mark vertical(const Leaf&) { return Mark::refine_vertically; }

TEST(Prism, MixesRulesWhereNodesKeepOneStencil) {
    PrismGrid grid(extrude(triangles(2), std::vector<double>{0.5, 0.5}));
    // Horizontal and isotropic side by side, then vertical on the former.
    grid.adapt([](const Leaf& leaf) {
        return leaf.centre()[0] < 0.5 ? Mark::refine : Mark::refine_horizontally;
    });
    expect_sound(grid);
    grid.adapt([](const Leaf& leaf) {
        return leaf.centre()[0] > 0.5 ? Mark::refine_vertically : Mark::keep;
    });
    expect_sound(grid);
    EXPECT_EQ(grid.leaf_count(), 16U * 8);
    std::mt19937 random(3);
    for (int step = 0; step < 4; ++step) {
        grid.adapt(
            [&](const Leaf&) { return random() % 3 == 0 ? Mark::refine_vertically : Mark::keep; });
        expect_sound(grid);
    }
}

TEST(Prism, RefusesNodesWithTwoStencils) {
    PrismGrid grid(extrude(triangles(2), std::vector<double>{1}));
    const auto left = [](const Leaf& leaf) { return leaf.centre()[0] < 0.5; };
    grid.adapt([&](const Leaf& leaf) {
        return left(leaf) ? Mark::refine_vertically : Mark::refine_horizontally;
    });
    expect_sound(grid);
    const std::size_t leaves = grid.leaf_count();
    try {
        grid.adapt(
            [&](const Leaf& leaf) { return left(leaf) ? Mark::refine_horizontally : Mark::keep; });
        FAIL() << "the other order was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("two stencils"), std::string::npos);
    }
    EXPECT_EQ(grid.leaf_count(), leaves);  // as before
    expect_sound(grid);
}

/// Whatever random rules are tried: a step is refused, or the grid is sound afterwards.
TEST(Prism, AcceptsOnlySoundMixtures) {
    int accepted = 0;
    int refused = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        std::mt19937 random(seed);
        PrismGrid grid(extrude(triangles(1 + int(seed % 2)), std::vector<double>{0.4, 0.6}));
        for (int step = 0; step < 5; ++step) {
            try {
                grid.adapt([&](const Leaf&) {
                    const auto draw = random() % 10;
                    return draw == 0   ? Mark::refine
                           : draw == 1 ? Mark::refine_horizontally
                           : draw == 2 ? Mark::refine_vertically
                                       : Mark::keep;
                });
                ++accepted;
            } catch (const InvalidInput&) {
                ++refused;
            }
            expect_sound(grid);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(accepted, 30);
    EXPECT_GT(refused, 30);
}

TEST(Prism, LayersFollowTheNormals) {
    // Shells of an octahedron: every layer is convex, so volumes grow with the thickness.
    CoarseGrid surface = octahedron();
    check_and_orient(surface);
    const std::vector<double> layers{0.1, 0.4};
    PrismGrid grid(extrude(surface, layers));
    const auto octahedron_volume = [](double r) { return 4.0 / 3.0 * r * r * r; };
    EXPECT_NEAR(coarse_volume(grid), octahedron_volume(1.5) - octahedron_volume(1), 1e-12);
    grid.refine_uniformly();
    expect_sound(grid);
    EXPECT_THROW(extrude(surface, layers, Point{0, 0, 0}), InvalidInput);
    EXPECT_THROW(PrismGrid(extrude(surface, layers, Point{0, 0, 1})), InvalidInput);  // inverted
}

TEST(Hierarchy, RefusesWhatItCannotRefine) {
    EXPECT_THROW(BisectionGrid<3>{hexahedra(1)}, InvalidInput);
    EXPECT_THROW(OctreeGrid<3>{tetrahedra(1)}, InvalidInput);
    EXPECT_THROW(RedGreenSimplices<2>{quadrilaterals(1)}, InvalidInput);
    EXPECT_THROW(PrismGrid{hexahedra(1)}, InvalidInput);
    EXPECT_THROW(BisectionGrid<3>{CoarseGrid{}}, InvalidInput);
    OctreeGrid<2> grid(quadrilaterals(1));
    EXPECT_THROW(grid.adapt(vertical), InvalidInput);
    BisectionGrid<2> bisection(triangles(1));
    EXPECT_THROW(bisection.adapt(horizontal), InvalidInput);
    EXPECT_THROW(extrude(triangles(1), std::vector<double>{}), InvalidInput);
    EXPECT_THROW(extrude(triangles(1), std::vector<double>{1, -1}), InvalidInput);
    EXPECT_THROW(extrude(quadrilaterals(1), std::vector<double>{1}), InvalidInput);
    const std::vector<double> few(3);
    EXPECT_THROW(NodeField(grid, few), InvalidInput);
}

}  // namespace
