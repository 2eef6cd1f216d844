// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodal values from data of cells: exact for linear functions, flat for constants, within the range
// of the cells, and the same for every numbering.
#include <map>

#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <walk/for_each_element.hpp>

#include "ball_at_wall.hpp"
#include "element_in.hpp"
#include "families.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace cell_data_test {

using CellFunction = std::function<double(const Point& centre)>;

constexpr Point slope{0.3, 0.7, -0.4};

constexpr std::array rules{CellRule::smooth, CellRule::sharp_centres, CellRule::sharp_means};

double linear(const Point& x) { return dot(slope, x) + 2; }

/// What looks like noise, and has one value for all numberings of the corners of a cell.
double noise(const Point& centre) {
    double sum = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        sum += std::sin(12.9898 * static_cast<double>(d + 1) * std::round(8192 * centre[d]));
    }
    return sum;
}

/// The centres of all leaves, by the key of what they are: their corners.
template <class Grid>
class Cells {
public:
    explicit Cells(const Grid& grid) {
        grid.for_each_leaf([&](const Leaf& leaf) {
            Point centre = leaf.centre();
            if (leaf.shape == Shape::pyramid) {
                Point base{0, 0, 0};
                for (std::size_t i = 0; i < 4; ++i) base = base + 0.25 * leaf.corners[i];
                centre = 0.75 * base + 0.25 * leaf.corners[4];
            }
            centre_[key(leaf.nodes)] = centre;
        });
    }

    auto data(CellFunction f) const {
        return [this, f = std::move(f)](const typename Grid::Element& e) { return f(centre(e)); };
    }
    Point centre(const typename Grid::Element& e) const {
        std::vector<std::uint32_t> nodes(e.corner.begin(), e.corner.end());
        for (;; nodes.pop_back()) {
            if (const auto at = centre_.find(key(nodes)); at != centre_.end()) return at->second;
        }
    }

private:
    static std::vector<std::uint32_t> key(std::span<const std::uint32_t> nodes) {
        return {nodes.begin(), nodes.end()};
    }
    std::map<std::vector<std::uint32_t>, Point> centre_;
};

/// Calls a function for each corner of each leaf, with the value there.
template <class Grid, class Field, class Function>
void for_each_corner(const Grid& grid, const Field& field, Function&& function) {
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.positions = true});
    std::array<Point, max_corners> x;
    engine::for_each_element(
        walk, false, [&](const engine::ElementView<double>& view, const engine::Split& split) {
            if (split.rule != nullptr) return;
            walk.corners(view, nullptr, x.data());
            for (std::size_t k = 0; k < view.corner_count(); ++k) {
                function(x[k], view.value[k], element_in(grid, view));
            }
        });
}

/// Refined at random, neighbours differing by any number of levels where the family lets them.
template <class Grid>
void refine_at_random(Grid& grid, int steps, unsigned seed) {
    std::mt19937 random(seed);
    for (int i = 0; i < steps; ++i) {
        grid.adapt([&](const Leaf&) { return random() % 3 == 0 ? Mark::refine : Mark::keep; });
    }
}

/// Whether a grid is flat, so that a linear function in space is one on the grid.
template <class Grid>
bool is_flat(const Grid& grid) {
    const std::vector<Point> x = grid.node_positions();
    return Grid::dimension == 3 ||
           std::all_of(x.begin(), x.end(), [](const Point& p) { return p[2] == 0; });
}

template <class Family>
class CellData : public testing::Test {};
TYPED_TEST_SUITE(CellData, Families);

/// Where there are two cells in every direction: also at walls, and where any number of levels
/// meet.
TYPED_TEST(CellData, OfLinearFunctionsGiveThemAtAllNodes) {
    for (unsigned seed = 1; seed < 4; ++seed) {
        for (auto& grid : TypeParam::grids()) {
            if (!is_flat(grid)) continue;
            grid.adapt([](const Leaf&) { return Mark::refine; });
            refine_at_random(grid, 2 * TypeParam::steps, seed);
            const Cells cells(grid);
            for (const CellRule rule : rules) {
                const CellAverages field(grid, cells.data(linear), rule);
                double off = 0;
                for_each_corner(grid, field, [&](const Point& x, double value, const auto&) {
                    off = std::max(off, std::abs(value - linear(x)));
                });
                EXPECT_LE(off, 1e-12);
            }
        }
    }
}

TYPED_TEST(CellData, ThatAreConstantStayFlat) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_random(grid, 2 * TypeParam::steps, 5);
        for (const CellRule rule : rules) {
            const CellAverages field(
                grid, [](const auto&) { return 0.1; }, rule);
            for_each_corner(grid, field,
                            [](const Point&, double value, const auto&) { ASSERT_EQ(value, 0.1); });
        }
    }
}

/// At walls they leave it by no more than its length.
TYPED_TEST(CellData, StayNearTheRangeOfCells) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_random(grid, 2 * TypeParam::steps, 6);
        const Cells cells(grid);
        for (const CellRule rule : rules) {
            const CellAverages field(
                grid, cells.data([](const Point& x) { return x[0] < 0.4 ? 0 : 1; }), rule);
            for_each_corner(grid, field, [](const Point&, double value, const auto&) {
                ASSERT_GE(value, -1);
                ASSERT_LE(value, 2);
            });
        }
    }
}

using Octrees =
    testing::Types<BalancedQuadtree, UnbalancedQuadtree, BalancedOctree, UnbalancedOctree>;
template <class Family>
class CellDataInOctrees : public testing::Test {
public:
    static constexpr int dim = Family::Grid::dimension;
    static CoarseGrid cube(int n) {
        if constexpr (dim == 2)
            return quadrilaterals(n);
        else
            return hexahedra(n);
    }
    static typename Family::Grid make(const CoarseGrid& coarse) {
        return typename Family::Grid(coarse, Family::grids().front().family());
    }
};
TYPED_TEST_SUITE(CellDataInOctrees, Octrees);

/// So they are within the range of the cells.
TYPED_TEST(CellDataInOctrees, AreMeansByOneOverSizeInside) {
    auto grid = this->make(this->cube(2));
    refine_at_random(grid, 4, 1);
    const Cells cells(grid);
    const CellAverages field(grid, cells.data(noise));
    std::map<Point, std::array<double, 2>> sums;
    for_each_corner(grid, field, [&](const Point& x, double, const auto& e) {
        const Point centre = cells.centre(e);
        const double weight = 1 / norm(centre - x);
        auto& [sum, total] = sums[x];
        sum += weight * noise(centre);
        total += weight;
    });
    std::map<Point, std::uint32_t> number;
    const std::vector<Point> positions = grid.node_positions();
    for (std::uint32_t n = 0; n < positions.size(); ++n) number[positions[n]] = n;
    std::size_t inside = 0;
    for_each_corner(grid, field, [&](const Point& x, double value, const auto&) {
        for (std::size_t d = 0; d < this->dim; ++d) {
            if (x[d] == 0 || x[d] == 1) return;
        }
        if (grid.hangs(number.at(x))) return;
        ++inside;
        ASSERT_NEAR(value, sums.at(x)[0] / sums.at(x)[1], 1e-14);
    });
    EXPECT_GT(inside, 50U);
}

TYPED_TEST(CellDataInOctrees, DoNotDependOnNumbers) {
    std::map<Point, double> values;
    const CellRule rule = CellRule::sharp_means;  // which contains the smooth one
    for (const bool other : {false, true}) {
        const CoarseGrid coarse = this->cube(2);
        auto grid = this->make(other ? shaken(coarse, 3, 0) : coarse);
        for (int i = 0; i < 4; ++i) {
            grid.adapt([&](const Leaf& leaf) {
                return norm(leaf.centre() - Point{0.3, 0.4, 0}) < 0.6 / (1 << i) ? Mark::refine
                                                                                 : Mark::keep;
            });
        }
        const Cells cells(grid);
        const CellAverages field(grid, cells.data(noise), rule);
        for_each_corner(grid, field, [&](const Point& x, double value, const auto&) {
            if (!other) values[x] = value;
            ASSERT_EQ(values.at(x), value);
        });
    }
    EXPECT_GT(values.size(), 50U);
}

/// An octree over the unit cube, finer by some levels where x < 0.5.
OctreeGrid<3> half_refined(int n, int levels) {
    OctreeGrid<3> grid(hexahedra(n), {.balanced = false});
    for (int i = 0; i < levels; ++i) {
        grid.adapt(
            [](const Leaf& leaf) { return leaf.centre()[0] < 0.5 ? Mark::refine : Mark::keep; });
    }
    return grid;
}

TEST(CellData, DrawPlanesWithoutACrease) {
    for (const int levels : {1, 2}) {
        const OctreeGrid<3> grid = half_refined(8, levels);
        const Cells cells(grid);
        const CellAverages field(grid, cells.data([](const Point& x) { return dot(slope, x); }));
        const auto surface = isosurface(grid, field, 0.32).surface;
        ASSERT_GT(surface.simplices.size(), 100U);
        const Point normal = (1 / norm(slope)) * slope;
        for (const auto& [a, b, c] : surface.simplices) {
            const Point& x = surface.vertices[a];
            const Point area = cross(surface.vertices[b] - x, surface.vertices[c] - x);
            ASSERT_NEAR(dot(x, slope), 0.32, 1e-14);
            if (norm(area) < 1e-8) continue;
            ASSERT_LE(norm(cross(normal, area)) / norm(area), 1e-5);
        }
    }
}

/// Relative errors of the area and of the volume of a ball that a wall cuts and a change of level
/// crosses, and the greatest distance of a vertex from the sphere.
std::array<double, 3> errors_of_ball(int n, CellRule rule = CellRule::smooth) {
    const OctreeGrid<3> grid = half_refined(n, 1);
    const Cells cells(grid);
    const BallAtWall ball;
    const CellAverages field(grid, cells.data(ball), rule);
    return ball.errors_of(isosurface(grid, field, 0).surface);
}

TEST(CellData, DrawBallsOfSecondOrderAtWallsAndChangesOfLevel) {
    const auto coarse = errors_of_ball(16);
    const auto fine = errors_of_ball(32);
    for (std::size_t i = 0; i < 3; ++i) {
        SCOPED_TRACE(coarse[i]);
        EXPECT_LE(fine[i], coarse[i] / 3.2);
        EXPECT_LE(fine[i], 0.005);
    }
}

TEST(CellData, DrawBallsBetterWhereTheyAreSharp) {
    const auto smooth = errors_of_ball(16);
    const auto sharp = errors_of_ball(16, CellRule::sharp_centres);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(sharp[i], smooth[i] / 1.3);
}

/// Of centres, and of means, which add a 24th of the second derivatives times the squared size.
TEST(CellData, ThatAreSharpGiveQuadraticFunctionsInside) {
    const double h = 1.0 / 12;
    const OctreeGrid<3> grid(hexahedra(12));
    const Cells cells(grid);
    const auto f = [](const Point& x) {
        return x[0] + (x[0] + 0.1) * (x[1] + 0.2) + 0.2 * x[2] * x[2] + 2 * x[2];
    };
    for (const CellRule rule : {CellRule::sharp_centres, CellRule::sharp_means}) {
        const double mean = rule == CellRule::sharp_means ? 0.4 * h * h / 24 : 0;
        const CellAverages field(grid, cells.data([&](const Point& x) { return f(x) + mean; }),
                                 rule);
        for_each_corner(grid, field, [&](const Point& x, double value, const auto&) {
            const auto [low, high] = std::minmax_element(x.begin(), x.end());
            if (*low < 2.5 * h || *high > 1 - 2.5 * h) return;
            ASSERT_NEAR(value, f(x), 1e-13);
        });
    }
}

/// The nodes around have no number, and no other ones.
TEST(CellData, ThatAreNoNumbersStayWhereTheyAre) {
    const OctreeGrid<3> grid(hexahedra(8));
    const Cells cells(grid);
    const Point middle{0.5, 0.5, 0.5};
    const double nowhere = std::numeric_limits<double>::quiet_NaN();
    const auto f = [&](const Point& x) { return norm(x - middle) < 0.12 ? nowhere : linear(x); };
    for (const CellRule rule : rules) {
        const CellAverages field(grid, cells.data(f), rule);
        expect_refused([&] { HierarchicalIndicator(grid, field); }, "nan");
        std::size_t missing = 0;
        for_each_corner(grid, field, [&](const Point& x, double value, const auto&) {
            if (std::isnan(value)) {
                ++missing;
                ASSERT_LT(norm(x - middle), 0.25);
            } else {
                ASSERT_NEAR(value, linear(x), 1e-12);
            }
        });
        EXPECT_GT(missing, 0U);
    }
}

/// One cell says nothing about how the data change.
TEST(CellData, OfOneCellAreConstant) {
    const OctreeGrid<3> grid(hexahedra(1));
    const CellAverages field(grid, [](const auto&) { return 3.5; });
    for_each_corner(grid, field,
                    [](const Point&, double value, const auto&) { EXPECT_EQ(value, 3.5); });
}

}  // namespace cell_data_test
