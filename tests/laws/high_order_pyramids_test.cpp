// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Polynomials on pyramids, and what is said of their parts.
#include <gtest/gtest.h>

#include <high_order/pyramid.hpp>

#include "high_order_judge.hpp"
#include "shape_world.hpp"

using namespace nestgrid_test;
using namespace nestgrid;

namespace {

constexpr engine::Factors box{3, {1, 1, 1}};

/// A net of a pyramid with random coefficients that are equal at the apex.
std::vector<double> random_net(int degree, std::mt19937& random) {
    std::vector<double> net(engine::net_size(degree, box));
    for (double& c : net) c = 2 * uniform(random) - 1;
    const std::size_t layer = net.size() / (static_cast<std::size_t>(degree) + 1);
    std::fill(net.end() - static_cast<std::ptrdiff_t>(layer), net.end(), 0.3);
    return net;
}

double value(const std::vector<double>& net, int degree, const Point& x) {
    return engine::net_value(net.data(), degree, box, engine::collapsed(x));
}

TEST(PyramidNets, HaveTheValuesOnTriangles) {
    for (int degree = 1; degree <= max_degree; ++degree) {
        const LatticePolynomial u(Shape::pyramid, degree,
                                  [](const Point& x) { return gyroid(x) + x[0] * x[1]; });
        std::vector<double> net;
        for (const Point& x : engine::pyramid_points(degree)) net.push_back(u(x));
        engine::to_coefficients(net.data(), degree, box);
        std::vector<double> triangles(engine::triangle_nets_size(degree));
        EXPECT_LE(engine::put_triangle_nets(net.data(), degree, triangles.data()), 1e-9);
        const auto places = [](std::span<const std::uint8_t> corners) {
            std::vector<engine::Place> result;
            for (const std::uint8_t k : corners) {
                const Point& x = topology(Shape::pyramid).reference[k];
                result.push_back({std::llround(x[0]), std::llround(x[1]), std::llround(x[2])});
            }
            return result;
        };
        for (const FaceTopology& face : std::span(topology(Shape::pyramid).face).first(5)) {
            const auto corner = std::span(face.corner);
            const std::array<std::uint8_t, 3> frame{corner[0], corner[1],
                                                    corner[face.corners - 1U]};
            const engine::Factors factors = engine::factors_of(face.shape);
            std::vector<double> on_face(engine::net_size(degree, factors));
            engine::take_pyramid_part(net.data(), triangles.data(), degree, places(frame), factors,
                                      on_face.data());
            const Point s{0.3, 0.45, 0};
            const auto& at = topology(Shape::pyramid).reference;
            const Point x = at[frame[0]] + s[0] * (at[frame[1]] - at[frame[0]]) +
                            s[1] * (at[frame[2]] - at[frame[0]]);
            EXPECT_NEAR(engine::net_value(on_face.data(), degree, factors, s), u(x), 1e-9);
        }
    }
}

/// Functions that are none of degree p on a triangle are told by how far they are from one.
TEST(PyramidNets, TellWhatTrianglesAreNot) {
    std::vector<double> net(engine::net_size(2, box), 0.0);
    net[1 + 3 * (0 + 3 * 1)] = 1;  // a (1 - a) c (1 - c)
    std::vector<double> triangles(engine::triangle_nets_size(2));
    EXPECT_GT(engine::put_triangle_nets(net.data(), 2, triangles.data()), 0.1);
}

TEST(PyramidNets, BoundsHoldAndFallByFour) {
    std::mt19937 random(7);
    for (int i = 0; i < 100; ++i) {
        const int degree = 1 + static_cast<int>(random() % 5);
        const std::vector<double> net = random_net(degree, random);
        const engine::PyramidCurvature curvature(net.data(), degree);
        // A simplex of any edges at level 3 inside the pyramid; its half at level 4.
        std::array<engine::Place, 3> x;
        for (engine::Place& at : x) {
            at[2] = static_cast<std::int64_t>(random() % 7);
            for (std::size_t d = 0; d < 2; ++d) {
                at[d] = static_cast<std::int64_t>(random() % static_cast<unsigned>(9 - at[2]));
            }
        }
        for (const Shape shape : {Shape::segment, Shape::triangle}) {
            const std::size_t corners = topology(shape).corners;
            const double beta = curvature.beta(shape, std::span(x).first(corners), 3);
            std::array<Point, 3> at;
            for (std::size_t k = 0; k < 3; ++k) at[k] = engine::point_at(x[k], 3);
            for (int sample = 0; sample < 50; ++sample) {
                const double s = uniform(random);
                const double t = shape == Shape::segment ? 0 : (1 - s) * uniform(random);
                const Point there = (1 - s - t) * at[0] + s * at[1] + t * at[2];
                const double linear = (1 - s - t) * value(net, degree, at[0]) +
                                      s * value(net, degree, at[1]) + t * value(net, degree, at[2]);
                EXPECT_LE(std::abs(value(net, degree, there) - linear), beta + 1e-12);
            }
            std::array<engine::Place, 3> half = x;
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t d = 0; d < 3; ++d) half[k][d] = x[0][d] + x[k][d];
            }
            EXPECT_LE(curvature.beta(shape, std::span(half).first(corners), 4),
                      beta / 4 * (1 + 1e-12) + 1e-14);
            const double edge = curvature.beta(Shape::segment, std::span(x).first(2), 3);
            EXPECT_LE(edge, beta * (1 + 1e-12) + 1e-14);
        }
    }
}

/// Affine functions are flat: collapsed coordinates do not show.
TEST(PyramidNets, AffineFunctionsHaveNoCurvature) {
    for (const int degree : {1, 2, 5}) {
        std::vector<double> net;
        for (const Point& x : engine::pyramid_points(degree)) {
            net.push_back(1 + 2 * x[0] - 3 * x[1] + 5 * x[2]);
        }
        engine::to_coefficients(net.data(), degree, box);
        const engine::PyramidCurvature curvature(net.data(), degree);
        const std::array<engine::Place, 3> x{{{0, 0, 0}, {3, 1, 2}, {1, 2, 4}}};
        EXPECT_LE(curvature.beta(Shape::triangle, x, 3), 1e-12);
    }
}

/// Islands in one pyramid, whose functions of degree 2 hold spheres.
TEST(HighOrderPyramids, IslandsAreFound) {
    std::mt19937 random(5);
    const double radius = 0.1;
    for (int i = 0; i < 20 && !HasFailure(); ++i) {
        const Point middle{0.4 * uniform(random) - 0.2, 0.4 * uniform(random) - 0.2,
                           -0.7 + 0.2 * uniform(random)};
        const DrawnWorld<ShapeWorld<3>, ShapeField<3>> drawn(
            Cells::pyramids,
            WorldOptions{.cells = 1,
                         .least_degree = 2,
                         .greatest_degree = 2,
                         .seed = static_cast<unsigned>(i)},
            [&](const Point& x) {
                const Point from = x - middle;
                return radius * radius - dot(from, from);
            });
        const auto result = drawn.surface(0, {radius * radius / 2, 7}, {.verify = true});
        EXPECT_EQ(surface_report(result.surface).components, 1U);
        expect_closed(result.surface, true);
        expect_bound(drawn, result, 0, radius * radius / 2);
    }
}

}  // namespace
