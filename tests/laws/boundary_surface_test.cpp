// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The boundary of the domain: closed, of the cube's area and volume, coloured by the data; and with
// a slice, the cube cut open.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/boundary_surface.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace boundary_surface_test {

template <class Family>
class BoundarySurfaces : public testing::Test {};
TYPED_TEST_SUITE(BoundarySurfaces, Families);

TYPED_TEST(BoundarySurfaces, EncloseTheCube) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(2, 7, [](const auto& grid, const auto& samples) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : six_thresholds) {
                const Threshold criterion(&indicator, threshold);
                const Slice s = boundary_surface(grid, field, under(criterion, indicator));
                expect_closed(s.surface, true);
                const SurfaceReport report = surface_report(s.surface);
                EXPECT_NEAR(report.area, 6, 1e-12);
                EXPECT_NEAR(report.volume, 1, 1e-12);
            }
        });
    }
}

TYPED_TEST(BoundarySurfaces, CarryALinearFunctionExactly) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const auto f = [](const Point& x) { return x[0] - 2 * x[1] + 3 * x[2]; };
        for (auto& grid : TypeParam::grids()) {
            refine_at_sphere(grid, 2 * TypeParam::steps);
            const std::vector<double> values = sample_nodes(grid, f);
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
            for (const double threshold : {0.0, 1e-9}) {
                const Slice s = boundary_surface(grid, field, {.threshold = threshold});
                expect_colours(s.surface, f);
            }
        }
    }
}

/// Planes in general position and through nodes, edges and faces: the half of the cube on the
/// positive side.
TYPED_TEST(BoundarySurfaces, CloseTheCubeCutOpen) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const std::vector<std::pair<Plane, double>> halves{
            {Plane({0, 0, 0.37}, {0, 0, 1}), 0.63},
            {Plane({0.5, 0, 0}, {1, 0, 0}), 0.5},
            {Plane({0.5, 0.5, 0}, {-1, -1, 0}), 0.5},
            {Plane({0, 0.25, 0}, {0, 1, -1}), 0.75 * 0.75 / 2}};
        for_each_field_at_sphere<TypeParam>(2, 7, [&](const auto& grid, const auto& samples) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : {0.0, 0.1, 1.0}) {
                const Threshold criterion(&indicator, threshold);
                for (const auto& [plane, volume] : halves) {
                    const Slice s =
                        slice(grid, field, plane, under(criterion, indicator), {.cap = true});
                    expect_closed(s.surface, true);
                    EXPECT_NEAR(surface_report(s.surface).volume, volume, 1e-9);
                }
            }
        });
    }
}

}  // namespace boundary_surface_test
