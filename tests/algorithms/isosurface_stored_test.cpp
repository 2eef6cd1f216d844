// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces on stored hierarchies: closed on bisection grids at every threshold, on red-green ones
// at threshold 0; through AnyGrid the same.
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/any_grid.hpp>

#include "sample_grids.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

std::vector<std::pair<const char*, std::function<double(const Point&)>>> functions() {
    return {{"sphere", [](const Point& x) { return to_sphere(x, 3); }},
            {"gyroid",
             [](const Point& x) {
                 const auto [a, b, c] = 9.0 * x;
                 return std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) +
                        std::sin(c) * std::cos(a);
             }},
            {"integers",  // with plateaus at the isovalue
             [](const Point& x) {
                 return std::round(3 * std::sin(7 * x[0] + x[1]) + 2 * std::cos(5 * x[2]));
             }},
            {"noise", [](const Point& x) {
                 const double s = 1e4 * std::sin(91 * x[0] + 57 * x[1] + 83 * x[2]);
                 return s - std::floor(s) - 0.5;
             }}};
}

void expect_closed(const SurfaceReport& report) {
    EXPECT_EQ(report.open_edges, 0U);
    EXPECT_EQ(report.nonmanifold_edges, 0U);
    EXPECT_EQ(report.nonmanifold_vertices, 0U);
    EXPECT_EQ(report.misoriented_edges, 0U);
}

template <class Grid>
void expect_closed(const Grid& grid, const std::vector<double>& thresholds) {
    for (const auto& [name, f] : functions()) {
        const std::vector<double> values = sample_nodes(grid, f);
        const NodeField<Grid, double> field(grid, values);
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : thresholds) {
            const auto result =
                isosurface(grid, field, 0.0, indicator, {.threshold = threshold, .verify = true});
            const SurfaceReport report = surface_report(result.surface);
            SCOPED_TRACE(std::string(name) + ", threshold " + std::to_string(threshold));
            expect_closed(report);
            if (threshold == 0) {
                EXPECT_GT(report.triangles, 50U);
            }
        }
    }
}

const std::vector<double> all_thresholds{0, 0.01, 0.1, 0.3, 1, 10};

TEST(StoredSurfaces, AreClosedOnBisectionGridsOfAnyCoarseGrid) {
    for (const CoarseGrid& coarse :
         {tetrahedra(1), shaken(tetrahedra(2), 3, 0.1), shaken(tetrahedra(3), 4, 0.05)}) {
        BisectionGrid<3> grid(coarse);
        refine_at_sphere(grid, 9);
        expect_closed(grid, all_thresholds);
    }
}

TEST(StoredSurfaces, AreClosedOnRandomBisectionGrids) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        std::mt19937 random(seed);
        BisectionGrid<3> grid(shaken(tetrahedra(1 + static_cast<int>(seed % 2)), seed, 0.05));
        for (int step = 0; step < 8; ++step) {
            grid.adapt([&](const Leaf&) {
                return random() % 3 == 0   ? Mark::refine
                       : random() % 3 == 0 ? Mark::coarsen
                                           : Mark::keep;
            });
        }
        expect_closed(grid, all_thresholds);
    }
}

/// Red refinement stops with T-junctions; where nothing stops before the leaves, there are none.
TEST(StoredSurfaces, AreClosedOnTheLeavesOfRedGreenGrids) {
    RedGreenSimplices<3> grid(shaken(tetrahedra(2), 5, 0.1));
    refine_at_sphere(grid, 4);
    for (const auto& [name, f] : functions()) {
        SCOPED_TRACE(name);
        const std::vector<double> values = sample_nodes(grid, f);
        const NodeField<RedGreenSimplices<3>, double> field(grid, values);
        const HierarchicalIndicator indicator(grid, field);
        const auto result = isosurface(grid, field, 0.0, Exact{}, indicator);
        const SurfaceReport report = surface_report(result.surface);
        expect_closed(report);
        EXPECT_GT(report.triangles, 50U);
    }
}

/// The same sphere on both families, within the square of the mesh size.
TEST(StoredSurfaces, AgreeBetweenFamilies) {
    const auto area = [](auto grid, int levels) {
        refine_at_sphere(grid, levels);
        const auto values = sample_nodes(grid, [](const Point& x) { return to_sphere(x, 3); });
        const NodeField field(grid, values);
        return surface_report(isosurface(grid, field, 0.0, IsosurfaceOptions{}).surface).area;
    };
    const double exact = 4 * 3.14159265358979 * 0.35 * 0.35;
    double last = 0;
    for (const int levels : {3, 4, 5}) {
        const double red_green = area(RedGreenSimplices<3>(tetrahedra(1)), levels);
        const double bisection = area(BisectionGrid<3>(tetrahedra(1)), 3 * levels);
        const double error = std::max(std::abs(red_green - exact), std::abs(bisection - exact));
        EXPECT_LT(error, 0.6 * std::pow(0.25, levels) * 40 * exact);
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 1.7);  // order 2
        }
        last = error;
    }
}

template <class Grid>
void expect_same_through_any(const Grid& grid) {
    const auto values = sample_nodes(grid, [](const Point& x) { return to_sphere(x, 3); });
    const NodeField<Grid, double> field(grid, values);
    const AnyGrid<Grid::dimension> any(grid);
    const AnyField<double> any_field(grid, field);
    CountLeaves count;
    const Traversal<AnyGrid<Grid::dimension>, AnyField<double>> walk(any, any_field);
    walk.run(count);
    EXPECT_EQ(count.leaves, grid.leaf_count());
}

TEST(StoredSurfaces, WalkTheSameThroughAnyGrid) {
    BisectionGrid<3> bisection(tetrahedra(1));
    OctreeGrid<3> octree(hexahedra(2), {.balanced = false});
    PrismGrid prism(extrude(triangles(2), std::vector<double>{1.0}));
    RedGreenGrid<3> red_green(hexahedra(2));
    refine_at_sphere(bisection, 6);
    refine_at_sphere(octree, 3);
    refine_at_sphere(prism, 3);
    refine_at_sphere(red_green, 3);
    expect_same_through_any(bisection);
    expect_same_through_any(octree);
    expect_same_through_any(prism);
    expect_same_through_any(red_green);
}

}  // namespace
