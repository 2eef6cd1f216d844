// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data of higher degree: surfaces are closed across degrees, sizes and jumps, and the printed bound
// holds and keeps the tolerance.

#include <gtest/gtest.h>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/check_grid.hpp>

#include "closedness.hpp"
#include "degree_world.hpp"
#include "high_order_judge.hpp"
#include "long_run.hpp"
#include "same_surface.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;
using namespace nestgrid;

namespace {

template <int dim>
using Drawn = DrawnWorld<DegreeWorld<dim>, DegreeField<dim>>;

int count_of_worlds() { return cases(300, 10000); }

/// A world of every kind: p = 1 to 8, equal and at random, conforming and hanging to three levels,
/// with and without jumps.
WorldOptions random_world(std::mt19937& random, unsigned seed) {
    WorldOptions options;
    options.cells = 1 + random() % 2;
    options.levels = static_cast<int>(random() % 4);
    options.refined = 0.2 + 0.1 * static_cast<double>(random() % 3);
    options.least_degree = 1 + static_cast<int>(random() % 5);
    options.greatest_degree = options.least_degree + static_cast<int>(random() % 4);
    if (options.greatest_degree == 1) options.greatest_degree = 2;
    if (random() % 3 == 0) options.noise = 0.2;
    options.seed = seed;
    return options;
}

TEST(HighOrder, SurfacesAreClosedAndWithinTheirBounds) {
    std::size_t triangles = 0;
    for (int i = 1; i <= count_of_worlds() && !HasFailure(); ++i) {
        const auto seed = static_cast<unsigned>(i);
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        const WorldOptions options = random_world(random, seed);
        const Drawn<3> drawn(options, functions[random() % functions.size()]);
        const double tolerance = std::pow(10.0, -0.3 - 0.3 * static_cast<double>(random() % 4));
        const double isovalue = random() % 2 == 0 ? 0.0 : 0.1;
        const auto result = drawn.surface(isovalue, {tolerance, 3 + static_cast<int>(random() % 2)},
                                          {.verify = true});
        expect_closed(result.surface);
        expect_bound(drawn, result, isovalue, tolerance);
        triangles += result.surface.simplices.size();
    }
    std::printf("%d surfaces with %zu triangles\n", count_of_worlds(), triangles);
}

TEST(HighOrder, LinesAreClosedAndWithinTheirBounds) {
    for (unsigned seed = 1; seed <= 200 && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        const Drawn<2> drawn(random_world(random, seed), functions[random() % functions.size()]);
        const double tolerance = std::pow(10.0, -0.5 - 0.5 * static_cast<double>(random() % 5));
        const auto result = drawn.surface(0.1, {tolerance, 6}, {.verify = true});
        expect_closed(result.surface);
        expect_bound(drawn, result, 0.1, tolerance);
    }
}

TEST(HighOrder, DepthLimitsLeaveSurfacesClosedAndAreCounted) {
    const Drawn<3> drawn(WorldOptions{.levels = 2, .least_degree = 2, .greatest_degree = 7},
                         gyroid);
    std::uint64_t before = ~std::uint64_t{0};
    for (int depth = 1; depth <= 4; ++depth) {
        const auto result = drawn.surface(0.1, {1e-2, depth}, {.verify = true});
        expect_closed(result.surface);
        EXPECT_LE(measured(drawn.world, result.surface, 0.1), result.error_bound + 1e-8);
        if (depth == 1) {
            EXPECT_GT(result.counts.limited, 0U);
        }
        before = std::min(before, result.counts.limited);
    }
}

/// Nodes that hang deep in the face of a leaf of degree 5, all on a line, between leaves of degree
/// 1: offsets see nothing, and elements stop unless the nodes know beta of what they halve.
TEST(HighOrder, NodesHangAtAnyDepth) {
    WorldOptions options{.mirrored = false};
    options.divides = [](const Point& middle, int level) { return middle[0] > 0 && level < 2; };
    options.degree = [](const Point& middle, int) { return middle[0] > 0 ? 1 : 5; };
    const Drawn<3> drawn(options, [](const Point& x) {
        const double y = x[1] >= 1 ? 1 : x[1] - std::floor(x[1]);
        return x[1] + 0.3 * x[2] + 0.2 * x[0] + 8 * y * (y - .25) * (y - .5) * (y - .75) * (y - 1);
    });
    for (const double tolerance : {0.03, 0.1, 0.33, 0.5, 0.8}) {
        for (const double isovalue : {-0.6, -0.1, 0.1, 0.4}) {
            expect_closed(drawn.surface(isovalue, {tolerance, 4}).surface);
        }
    }
}

/// The middle of a face hangs and is moved below the isovalue, and so is the whole element beside,
/// but for its middle: it must be looked at all the same.
TEST(HighOrder, SearchesCountWhatFlatnessMoves) {
    const auto inside = [](const Point& x) { return x[0] > 0 && x[1] > 0 && x[2] > 0; };
    WorldOptions options{.least_degree = 2, .greatest_degree = 2, .mirrored = false};
    options.divides = [&](const Point& middle, int level) { return inside(middle) && level < 2; };
    const Drawn<3> drawn(options, [](const Point& x) {
        const double a = x[1] - .5;
        const double b = x[2] - .5;
        return -x[0] - a * a - b * b + 0.7 * a - 6 * x[0] * a * b;
    });
    for (const double tolerance : {1.2, 1.54, 1.6, 2.0}) {
        for (double isovalue = -0.5; isovalue < 0.1; isovalue += 0.01) {
            expect_closed(drawn.surface(isovalue, {tolerance, 4}).surface);
        }
    }
}

const WorldOptions quadratics{.levels = 2, .least_degree = 2, .greatest_degree = 2};
TEST(HighOrder, QuadraticsAreCircles) { expect_round(Drawn<2>(quadratics, square<2>)); }
TEST(HighOrder, QuadraticsAreSpheres) { expect_round(Drawn<3>(quadratics, square<3>)); }

TEST(HighOrder, IslandsInOneCellAreFound) {
    std::mt19937 random(5);
    const double radius = 0.1;  // h / 20
    for (int i = 0; i < 1000 && !HasFailure(); ++i) {
        Point middle;
        for (double& x : middle) x = 1.7 * uniform(random) - 0.85;
        const Drawn<3> drawn(WorldOptions{.cells = 1}, [&](const Point& x) {
            const Point from = x - middle;
            return radius * radius - dot(from, from);
        });
        const auto result = drawn.surface(0, {radius * radius / 4, 7}, {.verify = true});
        EXPECT_EQ(surface_report(result.surface).components, 1U);
        expect_closed(result.surface, true);
    }
}

/// Four of one odd polynomial, all nodes of which are 0.
TEST(HighOrder, IslandsBetweenNodesAreFound) {
    const auto odd = [](double x) {
        const double t = (x + 1) / 2;
        return 6 * std::sqrt(3.0) * t * (1 - t) * (1 - 2 * t);
    };
    const Drawn<3> drawn(WorldOptions{.cells = 1, .least_degree = 5, .greatest_degree = 5},
                         [&](const Point& x) { return odd(x[0]) * odd(x[1]) * odd(x[2]); });
    const auto result = drawn.surface(0.5, {0.1, 6}, {.verify = true});
    EXPECT_EQ(surface_report(result.surface).components, 4U);
    expect_closed(result.surface, true);
}

TEST(HighOrder, ThreadsDrawTheSameBits) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Drawn<3> drawn(
            WorldOptions{
                .levels = 3, .least_degree = 1, .greatest_degree = 6, .noise = 0.1, .seed = seed},
            gyroid);
        const VirtualRefinement fine(drawn.data, {.tolerance = 0.2, .depth = 4});
        const auto one = isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds()));
        for (const std::size_t threads : {2, 3}) {
            const auto more = isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds()), {},
                                            {ThreadExecutor(threads)});
            expect_same(one.surface, more.surface);
            EXPECT_EQ(one.error_bound, more.error_bound);
            EXPECT_EQ(one.counts.limited, more.counts.limited);
        }
    }
}

TEST(HighOrder, EveryAlgorithmDraws) {
    const Drawn<3> drawn(WorldOptions{.levels = 2, .least_degree = 2, .greatest_degree = 5}, waves);
    const VirtualRefinement fine(drawn.data, {.tolerance = 0.05, .depth = 5});
    for (const Plane& plane : {Plane({0, 0, 0}, {0, 0, 1}), Plane({0, 0, 0.3}, {0, 0, 1}),
                               Plane({0, 0, 0}, {1, 1, 0}), Plane({0.1, 0, 0}, {1, 2, 3})}) {
        const auto drawn_slice = slice(fine, plane, under(fine.criterion(), fine.bounds()));
        expect_closed(drawn_slice.surface);
        EXPECT_GT(drawn_slice.surface.simplices.size(), 100U);
        EXPECT_LE(drawn_slice.error_bound, 0.05 + drawn.data.jump() * (1 + 1e-6));
    }
    const auto boundary = boundary_surface(fine, under(fine.criterion(), fine.bounds()));
    expect_closed(boundary.surface, true);
    const auto capped = drawn.surface(0.2, {0.05, 5}, {.cap = true});
    expect_closed(capped.surface, true);
    const auto with_normals = drawn.surface(0.2, {0.05, 5}, {.normals = true});
    EXPECT_EQ(with_normals.surface.normals.size(), with_normals.surface.vertices.size());

    const Drawn<2> flat(WorldOptions{.levels = 3, .least_degree = 2, .greatest_degree = 5}, gyroid);
    const VirtualRefinement lines(flat.data, {.tolerance = 0.01, .depth = 6});
    const std::array<double, 3> values{-0.2, 0.1, 0.5};
    const auto isolines = nestgrid::isolines(lines, std::span<const double>(values),
                                             under(lines.criterion(), lines.bounds()));
    EXPECT_GT(isolines.lines.vertices.size(), 100U);
    const auto field = height_field(lines, 1.0, under(lines.criterion(), lines.bounds()));
    const SurfaceReport report = surface_report(field.surface);
    EXPECT_EQ(report.open_edges, 0U);
    EXPECT_LE(field.error_bound, (0.01 + flat.data.jump()) * (1 + 1e-6));
}

/// The colours of a slice are the data, as far as the bound says.
TEST(HighOrder, ColoursOfSlicesAreWithinTheirBound) {
    const Drawn<3> drawn(WorldOptions{.levels = 1, .least_degree = 3, .greatest_degree = 3}, ties);
    const VirtualRefinement fine(drawn.data, {.tolerance = 0.02, .depth = 6});
    const auto result =
        slice(fine, Plane({0.05, 0, 0}, {1, 2, 3}), under(fine.criterion(), fine.bounds()));
    double greatest = 0;
    for (const auto& t : result.surface.simplices) {
        Point x{0, 0, 0};
        double colour = 0;
        for (const auto v : t) {
            x = x + (1.0 / 3) * result.surface.vertices[v];
            colour += result.surface.attributes[v] / 3;
        }
        greatest = std::max(greatest, std::abs(colour - drawn.world(x)));
    }
    EXPECT_GT(greatest, 0);
    EXPECT_LE(greatest, result.error_bound + 1e-8);
}

/// Linear data are drawn as without this header, to the last bit.
TEST(HighOrder, DegreeOneIsTheHierarchyItself) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const Drawn<3> drawn(
            WorldOptions{.cells = 3, .least_degree = 1, .greatest_degree = 1, .seed = seed},
            gyroid);
        const VirtualRefinement fine(drawn.data, {.tolerance = 1e-6});
        const auto plain = isosurface(drawn.world, drawn.field, 0.1);
        const auto decorated = isosurface<3>(fine, 0.1, under(Exact(), fine.bounds()));
        EXPECT_GT(plain.surface.simplices.size(), 10U);
        expect_same_simplices(plain.surface, decorated.surface);
        EXPECT_EQ(plain.error_bound, decorated.error_bound);
    }
}

TEST(HighOrder, WorldsAreSound) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const Drawn<3> drawn(
            WorldOptions{.levels = 2, .least_degree = 1, .greatest_degree = 8, .seed = seed},
            square<3>);
        const auto violation = check_grid(drawn.world, drawn.field);
        EXPECT_FALSE(violation.has_value()) << (violation ? violation->sentence : "");
    }
}

}  // namespace
