// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces on stored hierarchies: the same on all families, and behind tables.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "count_leaves.hpp"
#include "sample_grids.hpp"
#include "table_in_c.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace isosurface_stored_test {

/// The same sphere on all families, within the square of the mesh size.
TEST(StoredSurfaces, AgreeBetweenFamilies) {
    const auto area = [](auto grid, int levels) {
        refine_at_sphere(grid, levels);
        const auto values = sample_nodes(grid, [](const Point& x) { return to_sphere(x, 3); });
        const NodeField field(grid, values);
        return surface_report(isosurface(grid, field, 0.0).surface).area;
    };
    const double exact = 4 * 3.14159265358979 * 0.35 * 0.35;
    double last = 0;
    for (const int levels : {3, 4, 5}) {
        const double red_green = area(RedGreenSimplices<3>(tetrahedra(1)), levels);
        const double bisection = area(BisectionGrid<3>(tetrahedra(1)), 3 * levels);
        const double octree = area(OctreeGrid<3>(hexahedra(1), {.balanced = false}), levels);
        const double mixed = area(RedGreenGrid<3>(hexahedra(1)), levels);
        const double prism = area(PrismGrid(extrude(triangles(1), std::vector{1.0})), levels);
        double error = 0;
        for (const double found : {red_green, bisection, octree, mixed, prism}) {
            EXPECT_LT(std::abs(found - exact), 24 * std::pow(0.25, levels) * exact);
            error += std::abs(found - exact);
        }
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 1.7);  // order 2
        }
        last = error;
    }
}

template <class Grid>
void expect_same_behind_tables(const Grid& grid) {
    const auto values = sample_nodes(grid, [](const Point& x) { return to_sphere(x, 3); });
    const NodeField<Grid, double> field(grid, values);
    const BehindTables tables(grid, field);
    EXPECT_EQ(count_leaves(engine::Walk<double>(*tables.hierarchy, {})), grid.leaf_count());
}

TEST(StoredSurfaces, WalkTheSameBehindTables) {
    BisectionGrid<3> bisection(tetrahedra(1));
    OctreeGrid<3> octree(hexahedra(2), {.balanced = false});
    PrismGrid prism(extrude(triangles(2), std::vector<double>{1.0}));
    RedGreenGrid<3> red_green(hexahedra(2));
    refine_at_sphere(bisection, 6);
    refine_at_sphere(octree, 3);
    refine_at_sphere(prism, 3);
    refine_at_sphere(red_green, 3);
    expect_same_behind_tables(bisection);
    expect_same_behind_tables(octree);
    expect_same_behind_tables(prism);
    expect_same_behind_tables(red_green);
}

}  // namespace isosurface_stored_test
