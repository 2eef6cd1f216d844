// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces with vertices at nodes: closed manifolds like others, with fewer and no smaller
// triangles, at most a hair away.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/error.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace at_nodes_test {

template <class Family>
class AtNodes : public testing::Test {};
TYPED_TEST_SUITE(AtNodes, Families);

/// Values of whole numbers, many of them the isovalue 0, as scans of 8 bits have.
NodalSamples plateaus(const std::vector<Point>& nodes) {
    NodalSamples samples{"whole numbers", {}, false};
    for (const Point& x : nodes) {
        samples.values.push_back(
            std::round(3 * std::sin(9 * x[0]) * std::cos(7 * x[1]) + 2 * std::sin(8 * x[2])));
    }
    return samples;
}

std::size_t slivers(const Surface<3>& surface) {
    std::size_t count = 0;
    for (const auto& [a, b, c] : surface.simplices) {
        const Point& x = surface.vertices[a];
        const Point p = surface.vertices[b] - x;
        const Point q = surface.vertices[c] - x;
        const double longest = std::max({norm(p), norm(q), norm(q - p)});
        count += norm(cross(p, q)) < 1e-4 * longest * longest ? 1 : 0;
    }
    return count;
}

/// Two triangles with the same vertices enclose nothing.
std::size_t pillows(const Surface<3>& surface) {
    auto all = surface.simplices;
    for (auto& triangle : all) std::ranges::sort(triangle);
    std::ranges::sort(all);
    std::size_t count = 0;
    for (std::size_t i = 1; i < all.size(); ++i) count += all[i] == all[i - 1] ? 1 : 0;
    return count;
}

template <class Grid>
void expect_clean(const Grid& grid, const NodalSamples& samples, std::size_t& before,
                  std::size_t& after) {
    SCOPED_TRACE(samples.name);
    const NodeField<Grid, double> field(grid, samples.values);
    const HierarchicalIndicator indicator(grid, field);
    for (const double threshold : six_thresholds) {
        const Threshold criterion(&indicator, threshold);
        for (const bool cap : {false, true}) {
            IsosurfaceOptions options{.cap = cap};
            const auto plain = isosurface(grid, field, 0.0, under(criterion, indicator), options);
            options.at_nodes = true;
            const auto clean = isosurface(grid, field, 0.0, under(criterion, indicator), options);
            expect_closed(clean.surface, cap);
            EXPECT_LE(clean.surface.simplices.size(), plain.surface.simplices.size());
            if (cap) {
                EXPECT_NEAR(surface_report(clean.surface).volume,
                            surface_report(plain.surface).volume, 1e-5);
            }
            EXPECT_EQ(pillows(clean.surface), 0U);
            before += slivers(plain.surface);
            after += slivers(clean.surface);
            expect_same(clean, isosurface(grid, field, 0.0, under(criterion, indicator), options,
                                          {ThreadExecutor(2)}));
        }
    }
}

TYPED_TEST(AtNodes, SurfacesStayManifoldAndLoseSlivers) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        std::size_t before = 0;
        std::size_t after = 0;
        for (auto& grid : TypeParam::grids()) {
            refine_at_sphere(grid, 2 * TypeParam::steps);
            expect_clean(grid, plateaus(grid.node_positions()), before, after);
            for (const NodalSamples& samples : catching_fields(grid.node_positions(), 5)) {
                expect_clean(grid, samples, before, after);
            }
        }
        EXPECT_LT(4 * after, 3 * before);
    }
}

TEST(AtNodesOptions, RefuseReferenceCoordinates) {
    for (auto& grid : BalancedOctree::grids()) {
        const NodalSamples samples = plateaus(grid.node_positions());
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
        expect_refused(
            [&] { isosurface(grid, field, 0.0, {}, {.reference = true, .at_nodes = true}); },
            "a surface with vertices at nodes has no reference coordinates");
    }
}

}  // namespace at_nodes_test
