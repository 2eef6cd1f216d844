// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nets of polynomials on boxes against brute force: values, halves, ranges and bounds.
#include <gtest/gtest.h>

#include <high_order/box_net.hpp>

#include "closedness.hpp"

using namespace nestgrid_test;
using namespace nestgrid::engine;

namespace {

/// A polynomial by random values at its Lobatto points, and its net.
struct RandomNet {
    int degree;
    int dimension;
    std::vector<double> values;
    std::vector<double> net;

    RandomNet(int p, int dim, std::mt19937& random) : degree{p}, dimension{dim} {
        for (std::size_t i = 0; i < net_size(p, dim); ++i) values.push_back(uniform(random) - 0.5);
        net = values;
        to_coefficients(net.data(), p, dim);
    }
    double operator()(const Point& x) const {
        return net_value(net.data(), degree, dimension, std::span(x).first(std::size_t(dimension)));
    }
};

/// Calls function(net, random) for nets of all degrees and dimensions.
template <class Function>
void for_each_net(const Function& function) {
    std::mt19937 random(1);
    for (int dim = 1; dim <= 3; ++dim) {
        for (int p = 1; p <= max_degree; ++p) function(RandomNet(p, dim, random), random);
    }
}

Point random_point(std::mt19937& random) {
    return {uniform(random), uniform(random), uniform(random)};
}

/// The multilinear interpolant between the corners.
double interpolant(const RandomNet& u, const Point& x) {
    double sum = 0;
    for (std::size_t k = 0; k < std::size_t{1} << u.dimension; ++k) {
        double weight = u.net[net_corner(u.degree, u.dimension, k)];
        for (int d = 0; d < u.dimension; ++d) {
            const double t = x[std::size_t(d)];
            weight *= (k >> d & 1U) != 0 ? t : 1 - t;
        }
        sum += weight;
    }
    return sum;
}

TEST(BoxNets, HaveTheValuesTheyWereMadeOf) {
    for_each_net([](const RandomNet& u, std::mt19937&) {
        const std::vector<Point> points = lobatto_grid(u.degree, u.dimension);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(u(points[i]), u.values[i], 1e-11);
        }
        for (std::size_t k = 0; k < std::size_t{1} << u.dimension; ++k) {
            const std::size_t at = net_corner(u.degree, u.dimension, k);
            EXPECT_EQ(u.net[at], u.values[at]);
        }
    });
}

TEST(BoxNets, LobattoPointsAreThoseOfTheBooks) {
    EXPECT_NEAR(lobatto_points(3)[1], (1 - std::sqrt(1.0 / 5)) / 2, 1e-15);
    EXPECT_NEAR(lobatto_points(4)[1], (1 - std::sqrt(3.0 / 7)) / 2, 1e-15);
    EXPECT_EQ(lobatto_points(4)[2], 0.5);
    for (int p = 1; p <= max_degree; ++p) {
        const auto points = lobatto_points(p);
        EXPECT_EQ(points.front(), 0);
        EXPECT_EQ(points.back(), 1);
        EXPECT_TRUE(std::ranges::is_sorted(points));
    }
}

TEST(BoxNets, HalvesAreThePolynomialThereAndShareTheirBits) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        const std::size_t size = u.net.size();
        std::vector<double> halves(size << u.dimension);
        halve_all(u.net.data(), u.degree, u.dimension, halves.data());
        for (std::size_t k = 0; k < std::size_t{1} << u.dimension; ++k) {
            std::vector<double> one = u.net;
            for (int d = 0; d < u.dimension; ++d) {
                keep_half(one.data(), u.degree, u.dimension, d, k >> d & 1U);
            }
            const double* const half = halves.data() + k * size;
            EXPECT_TRUE(std::equal(one.begin(), one.end(), half));
            const Point x = random_point(random);
            Point whole = x;
            for (int d = 0; d < u.dimension; ++d) {
                whole[std::size_t(d)] = (x[std::size_t(d)] + static_cast<double>(k >> d & 1U)) / 2;
            }
            EXPECT_NEAR(net_value(half, u.degree, u.dimension, x), u(whole), 1e-11);
            // The middle of the box is one number in all halves.
            const std::size_t opposite = (std::size_t{1} << u.dimension) - 1 - k;
            EXPECT_EQ(
                half[net_corner(u.degree, u.dimension, opposite)],
                halves[net_corner(u.degree, u.dimension, (std::size_t{1} << u.dimension) - 1)]);
        }
    });
}

TEST(BoxNets, BoundsHoldAndFallByFour) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        const NetFacts facts = net_facts(u.net.data(), u.degree, u.dimension);
        for (int i = 0; i < 200; ++i) {
            const Point x = random_point(random);
            EXPECT_GE(u(x), facts.least - 1e-12);
            EXPECT_LE(u(x), facts.greatest + 1e-12);
            EXPECT_LE(std::abs(u(x) - interpolant(u, x)), facts.beta * (1 + 1e-9) + 1e-12);
        }
        std::vector<double> halves(u.net.size() << u.dimension);
        halve_all(u.net.data(), u.degree, u.dimension, halves.data());
        for (std::size_t k = 0; k < std::size_t{1} << u.dimension; ++k) {
            const NetFacts half =
                net_facts(halves.data() + k * u.net.size(), u.degree, u.dimension);
            EXPECT_LE(half.beta, facts.beta / 4 * (1 + 1e-9) + 1e-13);
        }
    });
}

/// Quadratics of one variable leave their chord by as much as beta says.
TEST(BoxNets, BetaIsSharpForQuadratics) {
    std::vector<double> net{0, 1, 0};  // u = 2 t (1 - t)
    EXPECT_EQ(net_facts(net.data(), 2, 1).beta, 0.5);
    EXPECT_EQ(net_value(net.data(), 2, 1, std::array{0.5}), 0.5);
}

TEST(BoxNets, AffineFitsBoundThePolynomial) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        std::vector<double> corners;
        for (std::size_t k = 0; k < std::size_t{1} << u.dimension; ++k) {
            corners.push_back(u.net[net_corner(u.degree, u.dimension, k)]);
        }
        const AffineFit fit = fit_affine(corners, u.dimension);
        const double r = distance_from_affine(u.net.data(), u.degree, u.dimension, fit.affine);
        const auto affine = [&](const Point& x) {
            double sum = fit.affine[0];
            for (std::size_t d = 0; d < std::size_t(u.dimension); ++d) {
                sum += fit.affine[d + 1] * (x[d] - 0.5);
            }
            return sum;
        };
        for (int i = 0; i < 200; ++i) {
            const Point x = random_point(random);
            EXPECT_LE(std::abs(u(x) - affine(x)), r + 1e-12);
        }
        double residual = 0;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Point corner{double(k & 1U), double(k >> 1U & 1U), double(k >> 2U)};
            residual = std::max(residual, std::abs(corners[k] - affine(corner)));
        }
        EXPECT_NEAR(fit.residual, residual, 1e-12);
    });
}

TEST(BoxNets, ElevationIsThePolynomial) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        const std::vector<double> more = elevated(u.net.data(), u.degree, u.dimension, max_degree);
        const Point x = random_point(random);
        EXPECT_NEAR(net_value(more.data(), max_degree, u.dimension, x), u(x), 1e-11);
    });
}

}  // namespace
