// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts on the finest pieces of edges: vertices lie where the data have the value of the level, the
// surface is closed, and the error bound holds.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>

#include "families.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "surface_judge.hpp"
#include "thread_executor.hpp"
#include "walked_in_patches.hpp"

using namespace nestgrid_test;

namespace finest_cuts_test {

constexpr std::array<double, 3> all_thresholds{0.02, 0.2, 0.7};
constexpr double cut_distance = 1e-5;  // cuts stay away from nodes

/// The greatest and the mean square |U - isovalue| at some points.
struct Distance {
    double greatest = 0;
    double mean_square = 0;
};

Distance distance(const Hierarchy<double>& h, std::span<const Point> points, double isovalue) {
    Distance d;
    for (const double off : differences(h, points, isovalue)) {
        d.greatest = std::max(d.greatest, off);
        d.mean_square += off * off / static_cast<double>(points.size());
    }
    return d;
}

/// Points of the triangles, or segments.
template <int dimension>
std::vector<Point> points_of(const Surface<dimension>& s) {
    std::vector<Point> points;
    for (const auto& simplex : s.simplices) {
        for (const double a : {0.1, 0.5}) {
            const Point x = a * s.vertices[simplex[0]];
            if constexpr (dimension == 2) {
                points.push_back(x + (1 - a) * s.vertices[simplex[1]]);
            } else {
                for (const double b : {0.05, 0.6}) {
                    points.push_back(x + (1 - a) * (b * s.vertices[simplex[1]] +
                                                    (1 - b) * s.vertices[simplex[2]]));
                }
            }
        }
    }
    return points;
}

/// Whether elements of a family that stop conform, at thresholds of indicators of its own.
template <class Family>
constexpr bool conforms =
    std::is_same_v<Family, BisectionTriangles> || std::is_same_v<Family, BisectionTetrahedra>;

template <class Family>
class FinestCuts : public testing::Test {};
TYPED_TEST_SUITE(FinestCuts, Families);

TYPED_TEST(FinestCuts, LieWhereTheDataAreAtTheLevel) {
    constexpr int dimension = TypeParam::Grid::dimension;
    double linear_sum = 0;
    double finest_sum = 0;
    for_each_field_at_sphere<TypeParam>(3, 4, [&](const auto& grid, const NodalSamples& samples) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const auto h = erase(grid, field);
        const HierarchicalIndicator indicator(h);
        for (const double threshold : all_thresholds) {
            SCOPED_TRACE(threshold);
            IsosurfaceOptions options{.verify = true};
            const auto linear = isosurface<dimension>(h, 0.0, under(indicator, threshold), options);
            options.cuts = Cuts::finest;
            const auto drawn = isosurface<dimension>(h, 0.0, under(indicator, threshold), options);
            expect_closed(drawn.surface);
            if (!conforms<TypeParam>) {
                expect_same(drawn, linear);
                continue;
            }
            ASSERT_EQ(drawn.surface.simplices.size(), linear.surface.simplices.size());
            EXPECT_GE(drawn.error_bound, linear.error_bound);
            const double rounding = cut_distance * (1 + drawn.range_bound);
            const Distance of = distance(h, points_of(drawn.surface), 0);
            EXPECT_LE(of.greatest, drawn.error_bound + rounding);
            EXPECT_LE(distance(h, drawn.surface.vertices, 0).greatest, rounding);
            linear_sum += distance(h, points_of(linear.surface), 0).mean_square;
            finest_sum += of.mean_square;
        }
    });
    if (conforms<TypeParam>) {
        EXPECT_LT(finest_sum, 0.8 * linear_sum);
    }
}

/// The walk in patches draws what the general walk draws, on any number of threads.
template <int dim>
void expect_same_by_all_walks(const Samples& n) {
    const LatticeGeometry<dim> geometry = [&] {
        LatticeGeometry<dim> g{.spacing = {0.5, 2, 0.3}};
        std::copy_n(n.begin(), g.samples.size(), g.samples.begin());
        return g;
    }();
    const LatticeBisection<dim> known(geometry);
    const UnknownGrid<LatticeBisection<dim>> unknown(geometry);
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const std::vector<float> values(
            data.values.begin(),
            data.values.begin() + (dim == 2 ? n[0] * n[1] : n[0] * n[1] * n[2]));
        const LatticeField field(known, std::span<const float>(values));
        const LatticeField unknown_field(unknown, std::span<const float>(values));
        const HierarchicalIndicator indicator(known, field);
        for (const double threshold : {0.0, 0.02, 0.2}) {
            SCOPED_TRACE(threshold);
            const IsosurfaceOptions options{.cuts = Cuts::finest, .verify = true};
            const auto a = isosurface(known, field, data.isovalue,
                                      under(indicator, threshold * data.range), options);
            const auto b = isosurface(unknown, unknown_field, data.isovalue,
                                      under(indicator, threshold * data.range), options);
            expect_same(a, b);
            expect_closed(a.surface);
            for (const std::size_t threads : {2U, 3U}) {
                const ThreadExecutor executor(threads);
                expect_same(
                    a, isosurface(known, field, data.isovalue,
                                  under(indicator, threshold * data.range), options, {executor}));
                expect_same(
                    a, isosurface(unknown, unknown_field, data.isovalue,
                                  under(indicator, threshold * data.range), options, {executor}));
            }
        }
    }
}

TEST(FinestCutsOfLattices, AreTheSameByAllWalks) {
    expect_same_by_all_walks<3>({17, 17, 17});
    expect_same_by_all_walks<3>({20, 9, 13});
    expect_same_by_all_walks<2>({33, 21, 2});
}

}  // namespace finest_cuts_test
