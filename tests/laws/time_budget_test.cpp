// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangle budgets between frames.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "closedness.hpp"
#include "sample_grids.hpp"

using namespace nestgrid_test;

namespace time_budget_test {

/// At the threshold of a budget the surface keeps within it, and one 1/128 below it does not.
TEST(TimeBudgets, AreKeptByAThresholdNextToTheLeast) {
    OctreeGrid<3> grid(hexahedra(2));
    refine_at_sphere(grid, 4);
    const auto fields = catching_fields(grid.node_positions(), 41);
    using Field = NodeField<OctreeGrid<3>, double>;
    const std::array<Field, 3> frames{Field(grid, fields[0].values), Field(grid, fields[1].values),
                                      Field(grid, fields[2].values)};
    const std::array<HierarchicalIndicator, 3> of_frames{HierarchicalIndicator(grid, frames[0]),
                                                         HierarchicalIndicator(grid, frames[1]),
                                                         HierarchicalIndicator(grid, frames[2])};
    const std::array<double, 3> times{0, 1, 3};
    for (const std::vector<float>& weights :
         {linear_weights(times, 0.4), catmull_rom_weights(times, 1.7)}) {
        const Between<Field> field({&frames[0], &frames[1], &frames[2]}, weights);
        const KeyFrames indicator({&of_frames[0], &of_frames[1], &of_frames[2]}, weights);
        const Plane plane({0.5, 0.5, 0.4}, {0.1, 0.2, 1});
        const auto at = [&](double threshold) { return Threshold(&indicator, threshold); };
        const auto hierarchy = erase(grid, field);
        const double middle = (indicator.least() + indicator.greatest()) / 2;
        const std::size_t finest =
            isosurface(grid, field, middle, under(at(0), indicator)).surface.simplices.size();
        ASSERT_GT(finest, 100U);
        for (const std::uint64_t budget : {finest / 5, finest / 2}) {
            const TriangleBudget best =
                isosurface<3>(hierarchy, middle, under(indicator, {.max_triangles = budget}))
                    .search;
            const auto triangles = [&](double threshold) {
                return isosurface(grid, field, middle, under(at(threshold), indicator))
                    .surface.simplices.size();
            };
            EXPECT_EQ(triangles(best.threshold), best.triangles);
            EXPECT_LE(best.triangles, budget);
            EXPECT_GT(triangles(best.threshold * (1 - 1.0 / 128)), budget);
        }
        const std::size_t finest_slice =
            slice(grid, field, plane, under(at(0), indicator)).surface.simplices.size();
        for (const std::uint64_t budget : {finest_slice / 2, 2 * finest_slice}) {
            const TriangleBudget best =
                slice(hierarchy, plane, under(at, indicator, {.max_triangles = budget})).search;
            EXPECT_LE(best.triangles, budget);
            EXPECT_LE(slice(grid, field, plane, under(at(best.threshold), indicator))
                          .surface.simplices.size(),
                      best.triangles);
        }
    }
}

}  // namespace time_budget_test
