// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Measured errors lie below the bounds that were promised, are symmetric, and agree with brute
// force.
#include <gtest/gtest.h>

#include <random>

#include <distances/closest_points.hpp>
#include <distances/surface_points.hpp>
#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/measured_error.hpp>

#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace measured_error_test {

constexpr double rounding = 1e-9;
constexpr std::size_t sample_points = 500;  // on each surface, and those at its triangles
constexpr double cut_distance = 0x1p-19;    // of vertices from nodes, in parts of an edge

engine::Triangle corners_of(const Surface<3>& s, std::size_t triangle) {
    const auto& [a, b, c] = s.simplices[triangle];
    return {s.vertices[a], s.vertices[b], s.vertices[c]};
}

/// The least distance of a point from many points of a triangle: too great, but by little.
double sampled_distance(const Point& x, const engine::Triangle& t, int steps) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; i + j <= steps; ++j) {
            const double a = static_cast<double>(i) / steps;
            const double b = static_cast<double>(j) / steps;
            least = std::min(least, norm(x - (a * t[0] + b * t[1] + (1 - a - b) * t[2])));
        }
    }
    return least;
}

void expect_equal(const Measured& a, const Measured& b) {
    EXPECT_EQ(a.greatest, b.greatest);
    EXPECT_EQ(a.mean, b.mean);
    EXPECT_EQ(a.rms, b.rms);
}

template <class Family>
class MeasuredErrors : public testing::Test {};
TYPED_TEST_SUITE(MeasuredErrors, Families);

TYPED_TEST(MeasuredErrors, LieBelowBoundsAndAreSymmetric) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(2, 3, [](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h, NodeError::deviation);
            const auto whole = isosurface<3>(h, 0.0).surface;
            const MeasuredError none = measure_error(h, whole, whole, 0.0, sample_points);
            EXPECT_LE(std::max(none.distance.greatest, none.back.greatest), rounding);
            const double range = indicator.greatest() - indicator.least();
            for (const double part : {0.0, 0.1, 0.3}) {
                const auto drawn = isosurface<3>(h, 0.0, under(indicator, part * range));
                const MeasuredError error =
                    measure_error(h, drawn.surface, whole, 0.0, sample_points);
                EXPECT_LE(error.value.greatest,
                          drawn.error_bound * (1 + rounding) + cut_distance * range);
                for (const Measured& m : {error.value, error.distance, error.back}) {
                    EXPECT_LE(m.mean, m.rms * (1 + rounding));
                    EXPECT_LE(m.rms, m.greatest * (1 + rounding));
                }
                const MeasuredError turned =
                    measure_error(h, whole, drawn.surface, 0.0, sample_points);
                expect_equal(error.distance, turned.back);
                expect_equal(error.back, turned.distance);
                for (const int threads : {2, 3}) {
                    const MeasuredError same = measure_error(
                        h, drawn.surface, whole, 0.0, sample_points, {ThreadExecutor(threads)});
                    expect_equal(error.value, same.value);
                    expect_equal(error.distance, same.distance);
                    expect_equal(error.back, same.back);
                    EXPECT_EQ(error.points, same.points);
                }
            }
        });
    }
}

TEST(ClosestPoints, AreThoseOfBruteForce) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto point = [&] { return Point{number(random), number(random), number(random)}; };
    Surface<3> surface;
    for (std::uint32_t t = 0; t < 300; ++t) {
        const Point a = point();
        const double size = t % 10 == 0 ? 0 : 0.2;  // some have no area
        surface.vertices.insert(surface.vertices.end(),
                                {a, a + size * point(), t % 7 == 0 ? a : a + size * point()});
        surface.simplices.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const engine::ClosestPoints closest(surface);
    for (int i = 0; i < 200; ++i) {
        const Point x = 1.5 * point();
        double least = std::numeric_limits<double>::infinity();
        double sampled = least;
        for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
            least = std::min(least, engine::square_distance(x, corners_of(surface, t)));
            sampled = std::min(sampled, sampled_distance(x, corners_of(surface, t), 30));
        }
        EXPECT_EQ(closest.distance(x), std::sqrt(least));
        EXPECT_EQ(closest.distance(x, std::sqrt(least)), std::sqrt(least));
        EXPECT_LE(std::sqrt(least), sampled + rounding);
        EXPECT_GE(std::sqrt(least), sampled - 0.4 / 30);
    }
}

TEST(SurfacePoints, HaveTheAreaAndReachEverything) {
    Surface<3> surface;
    surface.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 1, 1}};
    surface.simplices = {{0, 1, 2}};
    for (const double length : {10.0, 1.0, 0.3}) {
        const engine::SurfacePoints points = engine::points_of(surface, 0, 1, length);
        double area = 0;
        for (const double part : points.area) area += part;
        EXPECT_NEAR(area, 1.5 * std::sqrt(2.0), rounding);
        const engine::Triangle triangle = corners_of(surface, 0);
        for (const Point& x : points.x) {
            EXPECT_LE(engine::square_distance(x, triangle), rounding);
        }
        for (int i = 0; i <= 20; ++i) {
            for (int j = 0; i + j <= 20; ++j) {
                const Point x = (i / 20.0) * triangle[1] + (j / 20.0) * triangle[2];
                double least = std::numeric_limits<double>::infinity();
                for (const Point& p : points.x) least = std::min(least, norm(x - p));
                EXPECT_LE(least, points.reach);
            }
        }
    }
}

TEST(MeasuredErrors, OfNothingAreInfinite) {
    const LatticeBisection<3> grid({.samples = {5, 5, 5}});
    const std::vector<float> values(grid.node_count(), 1);
    const LatticeField field(grid, std::span<const float>(values));
    Surface<3> triangle;
    triangle.vertices = {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}};
    triangle.simplices = {{0, 1, 2}};
    const MeasuredError error = measure_error({grid, field}, Surface<3>{}, triangle, 0.5);
    EXPECT_EQ(error.distance.greatest, 0);
    EXPECT_EQ(error.back.greatest, std::numeric_limits<double>::infinity());
    const MeasuredError turned = measure_error({grid, field}, triangle, Surface<3>{}, 0.5);
    EXPECT_EQ(turned.value.greatest, 0.5);
    EXPECT_EQ(turned.value.mean, 0.5);
    EXPECT_EQ(turned.distance.mean, std::numeric_limits<double>::infinity());
    expect_refused([&] { measure_error({grid, field}, triangle, triangle, 0.5, 0); }, "no point");
    expect_refused(
        [&] {
            measure_error({grid, field}, triangle, triangle, std::nan(""));
        },
        "finite");
}

}  // namespace measured_error_test
