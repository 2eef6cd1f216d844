// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Domains of lenses: 0 inside, positive outside, with the Lipschitz constant 1.
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/domains.hpp>

#include "closedness.hpp"
#include "lipschitz.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace domains_test {

TEST(Domains, OfSimpleShapesAreLipschitz) {
    expect_lipschitz(Ball{{0.1, 0.2, -0.1}, 0.7}, [](const Point& x) {
        return norm(x - Point{0.1, 0.2, -0.1}) <= 0.7;
    });
    expect_lipschitz(Box{{-0.5, -1, 0}, {0.5, 0.3, 0.4}}, [](const Point& x) {
        return std::abs(x[0]) <= 0.5 && x[1] >= -1 && x[1] <= 0.3 && x[2] >= 0 && x[2] <= 0.4;
    });
    expect_lipschitz(HalfSpace({0, 0, 0.5}, {3, 0, 4}),
                     [](const Point& x) { return 3 * x[0] + 4 * x[2] <= 2; });
    expect_lipschitz(Cone({0.5, 0, 0}, {-2, 0, 0}, 0.6), [](const Point& x) {
        return x[0] <= 0.5 && std::hypot(x[1], x[2]) <= std::tan(0.6) * (0.5 - x[0]);
    });
    expect_lipschitz(
        ConvexPolyhedron({HalfSpace({0.5, 0, 0}, {1, 0, 0}), HalfSpace({0, 0.5, 0}, {-1, 1, 0}),
                          HalfSpace({0, 0, 0}, {0, -1, -2})}),
        [](const Point& x) { return x[0] <= 0.5 && x[1] - x[0] <= 0.5 && x[1] + 2 * x[2] >= 0; });
}

TEST(Domains, OfBallsBoxesAndConesAreDistances) {
    EXPECT_DOUBLE_EQ((Ball{{1, 0, 0}, 0.5}({3, 0, 0})), 1.5);
    EXPECT_DOUBLE_EQ((Box{{0, 0, 0}, {1, 1, 1}}({4, 5, 0.5})), 5);
    const Cone cone({0, 0, 0}, {0, 0, 1}, std::numbers::pi / 4);
    EXPECT_NEAR(cone({2, 0, 0}), std::sqrt(2), 1e-15);
    EXPECT_NEAR(cone({0, 0, -3}), 3, 1e-15);
}

/// A horseshoe.
const std::vector<ImagePoint> horseshoe{{-0.8, -0.7}, {0.8, -0.7},  {0.7, 0.6},  {0.3, 0.6},
                                        {0.2, -0.2},  {-0.3, -0.2}, {-0.2, 0.6}, {-0.8, 0.6}};

bool in_horseshoe(double u, double v) {
    const auto left = [&](std::size_t i, std::size_t k) {
        const ImagePoint& a = horseshoe[i];
        const ImagePoint& b = horseshoe[k];
        return (b[0] - a[0]) * (v - a[1]) - (b[1] - a[1]) * (u - a[0]) >= 0;
    };
    const bool hull = left(0, 1) && left(1, 2) && left(7, 0) && v <= 0.6;
    const bool gap = left(4, 3) && !left(5, 6) && v > -0.2;
    return hull && !gap;
}

TEST(Domains, OfPolygonsAreLipschitz) {
    const Polygon polygon(horseshoe);
    expect_lipschitz(polygon, [](const Point& x) { return in_horseshoe(x[0], x[1]); });
    EXPECT_DOUBLE_EQ(polygon({0, -2.7, 5}), 2);
    std::vector<ImagePoint> turned(horseshoe.rbegin(), horseshoe.rend());
    expect_lipschitz(Polygon(turned), [](const Point& x) { return in_horseshoe(x[0], x[1]); });
}

TEST(Domains, OfParallelViewsAreLipschitz) {
    const AffineCamera camera{{0.8, 0.9, -0.3}, {0.3, -0.2, 2}, {0.1, -0.2}};
    const auto image = [&](const Point& x) {
        return ImagePoint{dot(camera.across, x) + 0.1, dot(camera.up, x) - 0.2};
    };
    expect_lipschitz(seen_in(camera, Polygon(horseshoe)),
                     [&](const Point& x) { return in_horseshoe(image(x)[0], image(x)[1]); });
    expect_lipschitz(seen_in(camera, Ball{{0.2, 0.1, 0}, 0.5}), [&](const Point& x) {
        return std::hypot(image(x)[0] - 0.2, image(x)[1] - 0.1) <= 0.5;
    });
    // The greatest stretch is reached: along `up` of an orthogonal camera.
    const Distance d = seen_in(AffineCamera{{1, 0, 0}, {0, 3, 0}, {}}, Ball{{0, 0, 0}, 3});
    EXPECT_DOUBLE_EQ(d({0, 4, 7}), 3);
}

/// The image of a point, with its distance from the eye along the view.
Point seen(const PerspectiveCamera& camera, const Point& x) {
    const Point towards = 1 / norm(camera.towards) * camera.towards;
    Point right = cross(towards, camera.up);
    right = 1 / norm(right) * right;
    const Point up = cross(right, towards);
    const double depth = dot(towards, x - camera.eye);
    const double half = std::tan(camera.angle / 2) * depth;
    return {dot(right, x - camera.eye) / (half * camera.aspect), dot(up, x - camera.eye) / half,
            depth};
}

TEST(Domains, OfPerspectiveViewsAreLipschitz) {
    const PerspectiveCamera camera{{0.2, 1.2, 0.3}, {-0.2, -2, 0.1}, {0, 0.3, 1}, 0.9, 1.5};
    expect_lipschitz(view_frustum(camera, 0.3, 1.4), [&](const Point& x) {
        const Point at = seen(camera, x);
        return at[2] >= 0.3 && at[2] <= 1.4 && std::abs(at[0]) <= 1 && std::abs(at[1]) <= 1;
    });
    for (const bool turned : {false, true}) {
        std::vector<ImagePoint> triangle{{-0.9, -0.8}, {0.7, -0.3}, {0.1, 0.9}};
        if (turned) std::swap(triangle[0], triangle[1]);
        expect_lipschitz(seen_in(camera, Polygon(triangle)), [&](const Point& x) {
            const Point at = seen(camera, x);
            const auto left = [&](const ImagePoint& a, const ImagePoint& b) {
                return (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]) >= 0;
            };
            return at[2] >= 0 && left({-0.9, -0.8}, {0.7, -0.3}) && left({0.7, -0.3}, {0.1, 0.9}) &&
                   left({0.1, 0.9}, {-0.9, -0.8});
        });
    }
}

TEST(Domains, UniteAndIntersect) {
    const Ball ball{{-0.3, 0, 0}, 0.8};
    const HalfSpace below({0, 0, 0}, {0, 1, 1});
    const auto in_ball = [](const Point& x) { return norm(x + Point{0.3, 0, 0}) <= 0.8; };
    const auto is_below = [](const Point& x) { return x[1] + x[2] <= 0; };
    expect_lipschitz(union_of(ball, below),
                     [&](const Point& x) { return in_ball(x) || is_below(x); });
    expect_lipschitz(intersection(ball, below),
                     [&](const Point& x) { return in_ball(x) && is_below(x); });
}

TEST(Domains, AreRefusedWhereTheyMakeNoSense) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_refused([] { HalfSpace({0, 0, 0}, {0, 0, 0}); }, "no direction");
    expect_refused([&] { HalfSpace({nan, 0, 0}, {0, 0, 1}); }, "no point");
    expect_refused([] { ConvexPolyhedron({}); }, "no side");
    expect_refused([] { Cone({0, 0, 0}, {0, 0, 1}, 2); }, "angle");
    expect_refused([&] { Cone({0, 0, 0}, {nan, 0, 1}, 1); }, "no direction");
    expect_refused([] { Polygon({{0, 0}, {1, 1}}); }, "fewer than three");
    expect_refused([&] { Polygon({{0, 0}, {1, 1}, {nan, 0}}); }, "corner of a polygon");
    expect_refused(
        [] {
            seen_in(AffineCamera{{0, 0, 0}, {0, 0, 0}, {}}, Ball{});
        },
        "all points to one");
    const PerspectiveCamera camera;
    expect_refused([&] { view_frustum(camera, 2, 1); }, "nearest < farthest");
    expect_refused([] { view_frustum({.up = {0, 0, 1}}, 0, 1); }, "right side");
    expect_refused([] { view_frustum({.angle = 4}, 0, 1); }, "angle");
    expect_refused([] { view_frustum({.aspect = 0}, 0, 1); }, "aspect");
    expect_refused([&] { seen_in(camera, Polygon(horseshoe)); }, "not convex");
    std::vector<ImagePoint> star;
    for (int i = 0; i < 5; ++i) star.push_back({std::cos(i * 2.513274), std::sin(i * 2.513274)});
    expect_refused([&] { seen_in(camera, Polygon(star)); }, "crosses itself");
}

}  // namespace domains_test
