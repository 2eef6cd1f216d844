// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nets of polynomials on all shapes against brute force: values, parts, ranges and bounds.
#include <map>

#include <gtest/gtest.h>

#include <high_order/shape_parts.hpp>

#include "closedness.hpp"

using namespace nestgrid;
using namespace nestgrid_test;
using namespace nestgrid::engine;

namespace {

constexpr std::array shapes{Shape::segment,     Shape::triangle, Shape::quadrilateral,
                            Shape::tetrahedron, Shape::prism,    Shape::hexahedron};

/// A polynomial by random values at the points of a field, and its net.
struct RandomNet {
    Shape shape;
    int degree;
    Factors factors = factors_of(shape);
    std::size_t corners = topology(shape).corners;
    std::vector<double> values{};
    std::vector<double> net{};

    RandomNet(int p, Shape s, std::mt19937& random) : shape{s}, degree{p} {
        for (std::size_t i = 0; i < net_size(p, factors); ++i) {
            values.push_back(uniform(random) - 0.5);
        }
        net = values;
        to_coefficients(net.data(), p, factors);
    }
    double operator()(const Point& x) const { return net_value(net.data(), degree, factors, x); }
    double at_corner(std::size_t k) const { return net[net_corner(degree, factors, k)]; }
    /// Rounding of values of a polynomial that may be this large.
    double rounding() const {
        double greatest = 0;
        for (const double c : net) greatest = std::max(greatest, std::abs(c));
        return 1e-13 * greatest;
    }
};

/// Calls function(net, random) for nets of all degrees and shapes.
template <class Function>
void for_each_net(const Function& function) {
    std::mt19937 random(1);
    for (const Shape shape : shapes) {
        for (int p = 1; p <= max_degree; ++p) {
            SCOPED_TRACE(std::string(topology(shape).name) + " of degree " + std::to_string(p));
            function(RandomNet(p, shape, random), random);
        }
    }
}

/// A random point of the reference element.
Point random_point(Shape shape, std::mt19937& random) {
    while (true) {
        Point x{0, 0, 0};
        for (std::size_t d = 0; d < topology(shape).dimension; ++d) x[d] = uniform(random);
        const bool triangle = shape == Shape::triangle || shape == Shape::prism;
        const double sum = x[0] + x[1] + (shape == Shape::tetrahedron ? x[2] : 0);
        if ((triangle || shape == Shape::tetrahedron) && sum > 1) continue;
        return x;
    }
}

/// Weights of the corners at a point: those of degree 1.
std::vector<double> corner_weights(Shape shape, const Point& x) {
    std::vector<double> weights;
    for (std::size_t k = 0; k < topology(shape).corners; ++k) {
        std::vector<double> one(topology(shape).corners, 0.0);
        one[net_corner(1, factors_of(shape), k)] = 1;
        weights.push_back(net_value(one.data(), 1, factors_of(shape), x));
    }
    return weights;
}

/// The interpolant between the corners.
double interpolant(const RandomNet& u, const Point& x) {
    const std::vector<double> weights = corner_weights(u.shape, x);
    double sum = 0;
    for (std::size_t k = 0; k < u.corners; ++k) sum += weights[k] * u.at_corner(k);
    return sum;
}

/// The corners of the children of the red rule, in units of 1 / 2.
std::vector<std::vector<Place>> halves_of(Shape shape) {
    const Rule& rule = red_rule(shape);
    const std::vector<Point> nodes = reference_nodes(rule);
    std::vector<std::vector<Place>> halves;
    for (const Child& child : rule.children) {
        auto& half = halves.emplace_back();
        for (std::size_t k = 0; k < topology(child.shape).corners; ++k) {
            const Point& x = nodes[child.corner[k]];
            half.push_back(
                {std::llround(2 * x[0]), std::llround(2 * x[1]), std::llround(2 * x[2])});
        }
    }
    return halves;
}

/// The point of a part with these corners that has these weights.
Point point_between(std::span<const Place> corners, int level, std::span<const double> weights) {
    Point x{0, 0, 0};
    for (std::size_t k = 0; k < corners.size(); ++k) {
        for (std::size_t d = 0; d < 3; ++d) {
            x[d] += weights[k] * std::ldexp(static_cast<double>(corners[k][d]), -level);
        }
    }
    return x;
}

TEST(Nets, HaveTheValuesTheyWereMadeOf) {
    for_each_net([](const RandomNet& u, std::mt19937&) {
        const std::vector<Point> points = net_points(u.degree, u.factors);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(u(points[i]), u.values[i], u.rounding());
        }
        for (std::size_t k = 0; k < u.corners; ++k) {
            const std::size_t at = net_corner(u.degree, u.factors, k);
            EXPECT_EQ(points[at], topology(u.shape).reference[k]);
            EXPECT_EQ(u.net[at], u.values[at]);
        }
    });
}

/// On every line the difference of order p + 1 vanishes, and no lesser one does.
TEST(Nets, ArePolynomialsOfTheirDegree) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        const Point a = random_point(u.shape, random);
        for (std::size_t axis = 0; axis < topology(u.shape).dimension; ++axis) {
            std::vector<double> line;
            for (int i = 0; i < u.degree + 2; ++i) {
                Point x = a;
                x[axis] *= i / (u.degree + 1.0);
                line.push_back(u(x));
            }
            double lesser = 0;
            while (line.size() > 1) {
                if (line.size() == 2) lesser = line[0];
                for (std::size_t i = 0; i + 1 < line.size(); ++i) line[i] = line[i + 1] - line[i];
                line.pop_back();
            }
            EXPECT_LE(std::abs(line[0]), u.rounding() * std::ldexp(1.0, u.degree + 1));
            EXPECT_GT(std::abs(lesser), std::abs(line[0]));
        }
    });
}

TEST(Nets, LobattoPointsAreThoseOfTheBooks) {
    const Factors line = factors_of(Shape::segment);
    EXPECT_NEAR(net_points(3, line)[1][0], (1 - std::sqrt(1.0 / 5)) / 2, 1e-15);
    EXPECT_NEAR(net_points(4, line)[1][0], (1 - std::sqrt(3.0 / 7)) / 2, 1e-15);
    EXPECT_EQ(net_points(4, line)[2][0], 0.5);
}

TEST(Nets, PartsAreThePolynomialThere) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        if (u.shape == Shape::segment) return;
        for (const auto& half : halves_of(u.shape)) {
            for (const ShapePart& part : parts_of(u.shape).parts) {
                std::vector<Place> corners;
                for (std::size_t i = 0; i < part.count; ++i) {
                    corners.push_back(half[part.corner[i]]);
                }
                const NetPart there = part_at(u.factors, corners, 1);
                NetRoom net;
                restrict_net(u.net.data(), u.degree, u.factors, there, net.data());
                const Shape shape = part.count == 2   ? Shape::segment
                                    : part.count == 3 ? Shape::triangle
                                                      : Shape::quadrilateral;
                const Point at = random_point(shape, random);
                const std::vector<double> weights = corner_weights(shape, at);
                std::vector<double> by_point;
                for (std::size_t i = 0; i < part.count; ++i) {
                    by_point.push_back(weights[there.number[i]]);
                }
                EXPECT_NEAR(net_value(net.data(), u.degree, there.factors, at),
                            u(point_between(corners, 1, by_point)), u.rounding());
            }
        }
    });
}

/// In a leaf, two parts of it see the same bits on a side that they share.
TEST(Nets, PartsShareTheBitsBetweenThem) {
    for_each_net([](const RandomNet& u, std::mt19937&) {
        if (u.shape == Shape::segment) return;
        const ShapeParts& shape = parts_of(u.shape);
        std::map<std::vector<Place>, std::vector<double>> seen;
        std::size_t shared = 0;
        for (const auto& half : halves_of(u.shape)) {
            const NetPart whole = part_at(u.factors, half, 1);
            NetRoom own;
            restrict_net(u.net.data(), u.degree, u.factors, whole, own.data());
            for (const ShapePart& part : shape.parts) {
                std::vector<std::pair<std::uint8_t, Place>> sorted;
                for (std::size_t i = 0; i < part.count; ++i) {
                    sorted.emplace_back(whole.number[part.corner[i]], half[part.corner[i]]);
                }
                std::sort(sorted.begin(), sorted.end());
                std::vector<Place> frame;
                std::vector<Place> corners;
                for (const auto& [number, at] : sorted) {
                    const Place& twice = shape.node[number];
                    frame.push_back({twice[0] / 2, twice[1] / 2, twice[2] / 2});
                    corners.push_back(at);
                }
                std::vector<double> net(net_size(u.degree, part.factors));
                take_part(own.data(), u.degree, u.factors,
                          std::span(frame).first(part.count == 2 ? 2 : 3), part.factors,
                          net.data());
                const auto [at, is_new] = seen.emplace(corners, net);
                shared += is_new ? 0 : 1;
                EXPECT_EQ(at->second, net);
            }
        }
        EXPECT_GT(shared, 0U);
    });
}

TEST(Nets, HalvesOfBoxesShareTheirBits) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        if (!u.factors.all_segments()) return;
        const std::size_t dimension = u.factors.count;
        const std::size_t size = u.net.size();
        std::vector<double> halves(size << dimension);
        halve_all(u.net.data(), u.degree, dimension, halves.data());
        for (std::size_t k = 0; k < u.corners; ++k) {
            const double* const half = halves.data() + k * size;
            const Point x = random_point(u.shape, random);
            Point whole = x;
            for (std::size_t d = 0; d < dimension; ++d) {
                whole[d] = (x[d] + static_cast<double>(k >> d & 1U)) / 2;
            }
            EXPECT_NEAR(net_value(half, u.degree, u.factors, x), u(whole), u.rounding());
            // The middle of the box is one number in all halves.
            const std::size_t last = u.corners - 1;
            EXPECT_EQ(half[net_corner(u.degree, u.factors, last - k)],
                      halves[net_corner(u.degree, u.factors, last)]);
        }
    });
}

TEST(Nets, BoundsHoldAndFallByFour) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        const NetFacts facts = net_facts(u.net.data(), u.degree, u.factors);
        for (int i = 0; i < 200; ++i) {
            const Point x = random_point(u.shape, random);
            EXPECT_GE(u(x), facts.least - 1e-12);
            EXPECT_LE(u(x), facts.greatest + 1e-12);
            EXPECT_LE(std::abs(u(x) - interpolant(u, x)), facts.beta + u.rounding());
        }
        // In space the inner tetrahedra have an edge along the diagonal: no part of the whole.
        if (u.shape == Shape::tetrahedron) return;
        for (const auto& half : halves_of(u.shape)) {
            NetRoom net;
            const NetPart part = part_at(u.factors, half, 1);
            restrict_net(u.net.data(), u.degree, u.factors, part, net.data());
            const double beta = net_facts(net.data(), u.degree, u.factors).beta;
            const double share = u.factors.all_segments() ? 0.25 : 1;
            EXPECT_LE(beta, share * facts.beta * (1 + 1e-9) + u.rounding());
        }
    });
}

/// What closed surfaces need: an edge of a flat face is flat, in a quarter of it, too.
TEST(Nets, EdgesOfTrianglesAreAsFlatAsThese) {
    for_each_net([](const RandomNet& u, std::mt19937&) {
        if (u.shape != Shape::triangle) return;
        const double beta = net_facts(u.net.data(), u.degree, u.factors).beta;
        for (const auto& half : halves_of(u.shape)) {
            for (const ShapePart& part : parts_of(u.shape).parts) {
                const std::array corners{half[part.corner[0]], half[part.corner[1]]};
                const NetPart there = part_at(u.factors, corners, 1);
                NetRoom net;
                restrict_net(u.net.data(), u.degree, u.factors, there, net.data());
                EXPECT_LE(net_facts(net.data(), u.degree, there.factors).beta,
                          beta / 4 * (1 + 1e-9) + u.rounding());
            }
        }
    });
}

/// Quadratics of one variable leave their chord by as much as beta says.
TEST(Nets, BetaIsSharpForQuadratics) {
    std::vector<double> net{0, 1, 0};  // u = 2 t (1 - t)
    EXPECT_EQ(net_facts(net.data(), 2, factors_of(Shape::segment)).beta, 0.5);
    EXPECT_EQ(net_value(net.data(), 2, factors_of(Shape::segment), {0.5, 0, 0}), 0.5);
}

TEST(Nets, AffineFitsBoundThePolynomial) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        std::vector<double> corners;
        for (std::size_t k = 0; k < u.corners; ++k) corners.push_back(u.at_corner(k));
        const AffineFit fit = fit_affine(corners, u.factors);
        const double r = distance_from_affine(u.net.data(), u.degree, u.factors, fit);
        const auto affine = [&](const Point& x) {
            double sum = 0;
            std::size_t axis = 0;
            for (std::size_t f = 0; f < u.factors.count; ++f) {
                double left = 1;
                for (std::size_t d = 1; d <= u.factors.dimension[f]; ++d, ++axis) {
                    sum += fit.part[f][d] * x[axis];
                    left -= x[axis];
                }
                sum += fit.part[f][0] * left;
            }
            return sum;
        };
        for (int i = 0; i < 200; ++i) {
            const Point x = random_point(u.shape, random);
            EXPECT_LE(std::abs(u(x) - affine(x)), r + u.rounding());
        }
        double residual = 0;
        for (std::size_t k = 0; k < u.corners; ++k) {
            residual =
                std::max(residual, std::abs(corners[k] - affine(topology(u.shape).reference[k])));
        }
        EXPECT_NEAR(fit.residual, residual, 1e-12);
    });
}

TEST(Nets, ElevationIsThePolynomial) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        const std::vector<double> more = elevated(u.net.data(), u.degree, u.factors, max_degree);
        const Point x = random_point(u.shape, random);
        EXPECT_NEAR(net_value(more.data(), max_degree, u.factors, x), u(x), u.rounding());
    });
}

TEST(Nets, GradientsAreLimitsOfDifferences) {
    for_each_net([](const RandomNet& u, std::mt19937& random) {
        const Point x = random_point(u.shape, random);
        const Point gradient = net_gradient(u.net.data(), u.degree, u.factors, x);
        for (std::size_t d = 0; d < topology(u.shape).dimension; ++d) {
            Point low = x;
            Point high = x;
            low[d] -= 1e-5;
            high[d] += 1e-5;
            EXPECT_NEAR((u(high) - u(low)) / 2e-5, gradient[d], 1e9 * u.rounding());
        }
    });
}

}  // namespace
