// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The error bounds of all results, judged by brute force: the data on what is drawn are within
// error_bound, which is never more than the range of the data allows.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "families.hpp"
#include "projection_judge.hpp"
#include "surface_judge.hpp"

using namespace nestgrid_test;

namespace error_bound_test {

constexpr double rounding = 1e-12;
constexpr double cut_distance = 1e-5;  // cuts stay away from nodes

/// From none to more than the range of any field.
constexpr std::array<double, 8> all_thresholds{0, 0.01, 0.05, 0.2, 0.5, 1, 3, 1e9};

/// The least and the greatest value at nodes of the finest grid.
std::pair<double, double> range_of(const Hierarchy<double>& h) {
    const ProjectedNodes data(h, Exact(), 0.0);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::pair<double, double> range{infinity, -infinity};
    for (const auto& [key, value] : data.values()) {
        range = {std::min(range.first, value), std::max(range.second, value)};
    }
    return range;
}

/// The greatest difference of the data to `isovalue` at the corners and in the middle of simplices.
template <int dimension>
double greatest_difference(const Hierarchy<double>& h, const Surface<dimension>& s,
                           double isovalue) {
    std::vector<Point> points = s.vertices;
    for (const auto& simplex : s.simplices) {
        Point sum{0, 0, 0};
        for (const std::uint32_t v : simplex) sum = sum + s.vertices[v];
        points.push_back((1.0 / dimension) * sum);
    }
    return nestgrid_test::greatest_difference(h, points, isovalue);
}

void expect_bounded(const ErrorBounds& result, double greatest, double range_bound) {
    EXPECT_NEAR(result.range_bound, range_bound, rounding);
    EXPECT_LE(result.error_bound, result.range_bound);
    EXPECT_LE(greatest, result.error_bound + cut_distance * (1 + range_bound));
    EXPECT_EQ(result.bound_says_nothing(),
              result.error_bound > 0 && result.error_bound == result.range_bound);
}

template <class Family>
class ErrorBound : public testing::Test {};
TYPED_TEST_SUITE(ErrorBound, Families);

TYPED_TEST(ErrorBound, OfSurfacesHoldsAndIsWithinTheRange) {
    constexpr int dimension = TypeParam::Grid::dimension;
    bool says_nothing = false;
    for_each_field_at_sphere<TypeParam>(3, 4, [&](const auto& grid, const NodalSamples& samples) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const auto h = erase(grid, field);
        const HierarchicalIndicator offsets(h);
        const auto [least, greatest] = range_of(h);
        const double most = std::max(greatest, -least);
        for (const double threshold : all_thresholds) {
            SCOPED_TRACE(threshold);
            const auto result = isosurface<dimension>(h, 0.0, under(offsets, threshold));
            expect_bounded(result, greatest_difference(h, result.surface, 0), most);
            says_nothing = says_nothing || result.bound_says_nothing();
        }
        if (samples.name != "sphere") return;
        const auto exact = isosurface<dimension>(h, 0.0, under(offsets, 0));
        EXPECT_FALSE(exact.bound_says_nothing()) << exact.error_bound << " of " << most;
    });
    EXPECT_TRUE(says_nothing) << "no bound is as large as the range";
}

TYPED_TEST(ErrorBound, OfSlicesHoldsAndIsWithinTheRange) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const Plane plane({0.5, 0.45, 0.52}, {1, 2, -1});
        for_each_field_at_sphere<TypeParam>(3, 5, [&](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator offsets(h);
            const auto [least, greatest] = range_of(h);
            for (const double threshold : all_thresholds) {
                SCOPED_TRACE(threshold);
                const Threshold s(&offsets, threshold);
                const Slice drawn = slice(h, plane, under(s, offsets));
                const ProbeResult found = probe(h, drawn.surface.vertices);
                double worst = 0;
                for (std::size_t v = 0; v < drawn.surface.vertices.size(); ++v) {
                    if (!found.found(v)) continue;
                    worst =
                        std::max(worst, std::abs(found.values[v] - drawn.surface.attributes[v]));
                }
                expect_bounded(drawn, worst, greatest - least);
            }
        });
    }
}

TYPED_TEST(ErrorBound, OfHeightsAndLinesHoldsAndIsWithinTheRange) {
    if constexpr (TypeParam::Grid::dimension == 2) {
        for_each_field_at_sphere<TypeParam>(3, 6, [&](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator offsets(h);
            const auto [least, greatest] = range_of(h);
            for (const double threshold : all_thresholds) {
                SCOPED_TRACE(threshold);
                const Shading drawn = shading(h, under(offsets, threshold));
                const ProbeResult found = probe(h, drawn.surface.vertices);
                double worst = 0;
                for (std::size_t v = 0; v < drawn.surface.vertices.size(); ++v) {
                    if (!found.found(v)) continue;
                    worst =
                        std::max(worst, std::abs(found.values[v] - drawn.surface.attributes[v]));
                }
                expect_bounded(drawn, worst, greatest - least);
                const double values[] = {0.0, 0.3 * greatest + 0.7 * least};
                const Isolines lines = isolines(h, values, under(offsets, threshold));
                expect_bounded(lines, 0, std::max({greatest, -least, 0.7 * (greatest - least)}));
            }
        });
    }
}

TYPED_TEST(ErrorBound, OfACriterionThatInsistsIsTheRange) {
    constexpr int dimension = TypeParam::Grid::dimension;
    for_each_field_at_sphere<TypeParam>(2, 7, [&](const auto& grid, const NodalSamples& samples) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const auto h = erase(grid, field);
        const HierarchicalIndicator offsets(h);
        const auto [least, greatest] = range_of(h);
        const Unsaturated s(Threshold(&offsets, 0.1));
        const auto result = isosurface<dimension>(h, 0.0, under(s, offsets));
        EXPECT_NEAR(result.error_bound, std::max(greatest, -least), rounding);
        EXPECT_TRUE(result.bound_says_nothing());
        expect_bounded(result, greatest_difference(h, result.surface, 0), result.range_bound);
    });
}

}  // namespace error_bound_test
