// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces drawn one after the other are those drawn alone, and cost no allocation.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>

#include "counting_allocator.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace isosurface_series_test {

template <class Grid>
class SeriesOn : public testing::Test {};
using Grids =
    testing::Types<LatticeBisection<2>, LatticeBisection<3>, LatticeOctree<2>, LatticeOctree<3>>;
TYPED_TEST_SUITE(SeriesOn, Grids);

template <class Grid>
struct Case {
    static constexpr int dim = Grid::dimension;
    SampledField data = sampled_fields({21, 17, 17})[1];  // a gyroid
    Grid grid = make_grid();
    std::vector<float> samples{
        data.values.begin(),
        data.values.begin() + static_cast<std::ptrdiff_t>(grid.sample_count())};
    LatticeField<Grid, float> field{grid, std::span<const float>(samples)};

    /// With padding in two dimensions, without in three.
    static Grid make_grid() {
        if constexpr (dim == 2) {
            return Grid({.samples = {21, 17}});
        } else {
            return Grid({.samples = {21, 17, 17}, .block_levels = 2});
        }
    }
};

/// A stream of triangles needs heap for tables that all surfaces share, and a little of its own.
TYPED_TEST(SeriesOn, StreamsTrianglesWithoutHeap) {
    constexpr std::size_t shared = 256 * 1024;
    constexpr std::size_t own = 64 * 1024;
    const Case<TypeParam> c;
    const HierarchicalIndicator indicator(c.grid, c.field);
    for (const double threshold : {0.0, 0.05 * c.data.range}) {
        for (const std::size_t limit : {shared + own, own}) {
            const std::size_t before = allocated_bytes();
            std::size_t most = before;
            std::size_t simplices = 0;
            constexpr int dim = TypeParam::dimension;
            const auto see = [&](const typename SimplexStream<dim>::Simplex&) {
                ++simplices;
                most = std::max(most, allocated_bytes());
            };
            const double isovalue = c.data.isovalue;
            const Threshold criterion{&indicator, threshold};
            extract_isosurfaces(c.grid, c.field, std::span<const double>(&isovalue, 1),
                                std::vector{SimplexStream<dim>(see)}, under(criterion, indicator));
            EXPECT_GT(simplices, 10U);
            EXPECT_LT(most - before, limit) << "threshold " << threshold;
        }
    }
}

TYPED_TEST(SeriesOn, DrawsWhatIsDrawnAlone) {
    const Case<TypeParam> c;
    IsosurfaceSeries series(c.grid, c.field);
    const Prerolls prerolls(c.grid, c.field);
    std::vector<IsosurfaceOptions> frames(6);
    std::vector<Projection> projections(6);
    projections[1].threshold = 0.05 * c.data.range;
    frames[2].cap = true;
    frames[2].normals = true;
    projections[3].max_triangles = 3000;
    frames[4].reference = true;
    frames[4].elements = false;
    frames[5].progress = [](const TraversalCounts&) { return true; };
    for (int round = 0; round < 2; ++round) {
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const IsosurfaceOptions& options = frames[i];
            for (const double offset : {0.0, 0.02, -0.05}) {
                const double isovalue = c.data.isovalue + offset * c.data.range;
                const auto alone =
                    isosurface<TypeParam::dimension>(prerolls, isovalue, projections[i], options);
                expect_same(series.draw(isovalue, projections[i], options), alone);
            }
        }
    }
}

TYPED_TEST(SeriesOn, AllocatesNothingTheSecondTime) {
    const Case<TypeParam> c;
    const auto& [data, grid, samples, field] = c;
    const std::vector<double> isovalues{data.isovalue, 0.9 * data.isovalue, 1.1 * data.isovalue};
    IsosurfaceSeries first_time(grid, field);
    for (const double isovalue : isovalues) first_time.draw(isovalue);
    const auto draw_all = [&isovalues](auto& series) {
        std::size_t simplices = 0;
        // [series]
        for (const double isovalue : isovalues) {
            const auto& result = series.draw(isovalue, {.threshold = 0});
            simplices += result.surface.simplices.size();
        }
        // [series]
        return simplices;
    };
    const std::size_t before = allocation_count();
    const std::size_t simplices = draw_all(first_time);
    EXPECT_EQ(allocation_count(), before);
    EXPECT_GT(simplices, 100U);
}

TEST(Series, RefusesWhatIsosurfaceRefuses) {
    const Case<LatticeBisection<3>> c;
    IsosurfaceSeries series(c.grid, c.field);
    expect_refused([&] { series.draw(std::nan("")); }, "isovalue");
    expect_refused([&] { series.draw(0, {.threshold = -1}); }, "threshold");
    EXPECT_GT(series.draw(c.data.isovalue).surface.simplices.size(), 0U);
}

}  // namespace isosurface_series_test
