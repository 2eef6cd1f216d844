// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A level set of a function of position, coarsened where the data allow it: closed, planar, and
// coloured by the data, on every family.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/surface_measures.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "plane_level.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace {

struct Plane {
    Point normal;
    double offset;
    double tolerance;
};

/// In general position, and through nodes, edges and whole faces: cuts keep away from nodes by
/// 2^-20 of an edge.
constexpr double rounding = 1e-13;
constexpr double from_nodes = 2 * 0x1p-20;
const std::vector<Plane> planes{{{0.3, 0.5, 0.81}, 0.7713, rounding},
                                {{0, 0, 1}, 0.37, rounding},
                                {{1, 0, 0}, 0.5, from_nodes},
                                {{1, 1, 0}, 1, from_nodes},
                                {{0, 1, -1}, 0.25, from_nodes}};

template <class Family>
class Slices : public testing::Test {};
TYPED_TEST_SUITE(Slices, Families);

template <class Grid>
void expect_slices(const Grid& grid, const NodalSamples& samples, double threshold) {
    const NodeField<Grid, double> field(grid, samples.values);
    const HierarchicalIndicator indicator(grid, field);
    for (const auto& [normal, offset, tolerance] : planes) {
        SCOPED_TRACE(samples.name + " at threshold " + std::to_string(threshold));
        const Surface<3> surface =
            slice(grid, field, normal, offset, Threshold(&indicator, threshold), indicator);
        expect_closed(surface);
        EXPECT_GT(surface.simplices.size(), 0U);
        for (const Point& x : surface.vertices) EXPECT_NEAR(dot(normal, x), offset, tolerance);
    }
}

TYPED_TEST(Slices, AreClosedAndPlanarAtEveryThreshold) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(2, 7, [](const auto& grid, const auto& samples) {
            for (const double threshold : {0.0, 0.1, 1.0}) expect_slices(grid, samples, threshold);
        });
    }
}

/// A linear function has no offsets but rounding: a slice is that of the coarse grid at any
/// threshold above it, and of the leaves at one below 0. Both have the colours of the function.
TYPED_TEST(Slices, CarryALinearFunctionExactly) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for (auto& grid : TypeParam::grids()) {
            refine_at_sphere(grid, 2 * TypeParam::steps);
            const auto f = [](const Point& x) { return 2 * x[0] - 3 * x[1] + x[2] + 0.125; };
            std::vector<double> values;
            for (const Point& x : grid.node_positions()) values.push_back(f(x));
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : {-1.0, 1e-9}) {
                const Threshold criterion(&indicator, threshold);
                const auto& [normal, offset, tolerance] = planes[0];
                const auto s = slice(grid, field, normal, offset, criterion, indicator);
                ASSERT_EQ(s.attributes.size(), s.vertices.size());
                for (std::size_t v = 0; v < s.vertices.size(); ++v) {
                    EXPECT_NEAR(s.attributes[v], f(s.vertices[v]), 1e-12);
                }
            }
        }
    }
}

}  // namespace
