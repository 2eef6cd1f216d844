// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data of higher degree on triangles, tetrahedra and prisms, and where shapes meet.

#include <gtest/gtest.h>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/check_grid.hpp>

#include "high_order_judge.hpp"
#include "long_run.hpp"
#include "same_surface.hpp"
#include "shape_world.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;
using namespace nestgrid;

namespace {

template <int dim>
using OnShapes = DrawnWorld<ShapeWorld<dim>, ShapeField<dim>>;

std::size_t count_of_shape_worlds() { return is_long_run() ? 3000 : 40; }

/// p = 1 to 8, equal and at random, conforming and hanging to two levels, with and without jumps.
WorldOptions random_shape_world(std::mt19937& random, unsigned seed) {
    WorldOptions options;
    options.cells = 1 + random() % 2;
    options.levels = static_cast<int>(random() % 3);
    options.refined = 0.2 + 0.1 * static_cast<double>(random() % 3);
    options.least_degree = 1 + static_cast<int>(random() % 7);
    const int spread = static_cast<int>(random() % 3);
    options.greatest_degree = std::min(8, options.least_degree + spread);
    if (random() % 3 == 0) options.noise = 0.2;
    options.seed = seed;
    return options;
}

template <int dim>
void expect_closed_worlds(Cells cells, std::size_t count) {
    std::size_t simplices = 0;
    for (unsigned seed = 1; seed <= count && !testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        const WorldOptions options = random_shape_world(random, seed);
        const OnShapes<dim> drawn(cells, options, functions[random() % functions.size()]);
        const double tolerance = std::pow(10.0, -0.3 - 0.3 * static_cast<double>(random() % 3));
        const double isovalue = random() % 2 == 0 ? 0.0 : 0.1;
        const int depth = 3 + static_cast<int>(random() % 2);
        const auto result = drawn.surface(isovalue, {tolerance, depth}, {.verify = true});
        expect_closed(result.surface);
        expect_bound(drawn, result, isovalue, tolerance);
        simplices += result.surface.simplices.size();
    }
    std::printf("%zu surfaces with %zu simplices\n", count, simplices);
    EXPECT_GT(simplices, 100U);
}

TEST(HighOrderShapes, TetrahedraAreClosedAndWithinTheirBounds) {
    expect_closed_worlds<3>(Cells::simplices, count_of_shape_worlds());
}
TEST(HighOrderShapes, PrismsAreClosedAndWithinTheirBounds) {
    expect_closed_worlds<3>(Cells::prisms, count_of_shape_worlds() / 2);
}
TEST(HighOrderShapes, PrismsBesideHexahedraAreClosedAndWithinTheirBounds) {
    expect_closed_worlds<3>(Cells::columns, count_of_shape_worlds() / 2);
}
TEST(HighOrderShapes, AllShapesTogetherAreClosedAndWithinTheirBounds) {
    expect_closed_worlds<3>(Cells::all, count_of_shape_worlds() / 2);
}
TEST(HighOrderShapes, PyramidsAreClosedAndWithinTheirBounds) {
    expect_closed_worlds<3>(Cells::pyramids, count_of_shape_worlds() / 4);
}
TEST(HighOrderShapes, TrianglesAreClosedAndWithinTheirBounds) {
    expect_closed_worlds<2>(Cells::simplices, count_of_shape_worlds());
}
TEST(HighOrderShapes, TrianglesBesideQuadrilateralsAreClosedAndWithinTheirBounds) {
    expect_closed_worlds<2>(Cells::columns, count_of_shape_worlds());
}

const WorldOptions quadratics_on_simplices{.levels = 2, .least_degree = 2, .greatest_degree = 2};
TEST(HighOrderShapes, QuadraticsOnTrianglesAreCircles) {
    expect_round(OnShapes<2>(Cells::simplices, quadratics_on_simplices, square<2>));
}
TEST(HighOrderShapes, QuadraticsOnTetrahedraAreSpheres) {
    expect_round(OnShapes<3>(Cells::simplices, quadratics_on_simplices, square<3>));
}

/// A sphere of a twentieth of the edges, anywhere in one tetrahedron of degree 4.
TEST(HighOrderShapes, IslandsInOneTetrahedronAreFound) {
    std::mt19937 random(5);
    const double radius = 0.1;
    for (int i = 0; i < 1000 && !HasFailure();) {
        Point middle;
        for (double& x : middle) x = 2 * uniform(random) - 1;
        const double beyond = (-1 - middle[0] - middle[1] - middle[2]) / std::sqrt(3.0);
        if (std::min({middle[0], middle[1], middle[2]}) < radius - 0.99 || beyond < radius) {
            continue;
        }
        ++i;
        const OnShapes<3> drawn(Cells::one_simplex,
                                WorldOptions{.cells = 1, .seed = static_cast<unsigned>(i)},
                                [&](const Point& x) {
                                    const Point from = x - middle;
                                    return radius * radius - dot(from, from);
                                });
        const auto result = drawn.surface(0, {radius * radius / 2, 7}, {.verify = true});
        EXPECT_EQ(surface_report(result.surface).components, 1U);
        expect_closed(result.surface, true);
    }
}

TEST(HighOrderShapes, ThreadsDrawTheSameBits) {
    for (unsigned seed = 1; seed <= 2; ++seed) {
        const WorldOptions options{
            .levels = 2, .least_degree = 1, .greatest_degree = 5, .noise = 0.1, .seed = seed};
        const OnShapes<3> drawn(Cells::all, options, gyroid);
        const VirtualRefinement fine(drawn.data, {.tolerance = 0.2, .depth = 4});
        const auto one = isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds()));
        EXPECT_GT(one.surface.simplices.size(), 1000U);
        for (const std::size_t threads : {2, 3}) {
            const auto more = isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds()), {},
                                            {ThreadExecutor(threads)});
            expect_same(one.surface, more.surface);
            EXPECT_EQ(one.error_bound, more.error_bound);
        }
    }
}

TEST(HighOrderShapes, EveryAlgorithmDraws) {
    const OnShapes<3> drawn(
        Cells::all, WorldOptions{.levels = 2, .least_degree = 2, .greatest_degree = 5}, waves);
    const VirtualRefinement fine(drawn.data, {.tolerance = 0.05, .depth = 5});
    for (const Plane& plane : {Plane({0, 0, 0}, {0, 0, 1}), Plane({0, 0, -0.3}, {0, 0, 1}),
                               Plane({0, 0, 0}, {1, 1, 0}), Plane({0.1, 0, 0}, {1, 2, 3})}) {
        const auto drawn_slice = slice(fine, plane, under(fine.criterion(), fine.bounds()));
        expect_closed(drawn_slice.surface);
        EXPECT_GT(drawn_slice.surface.simplices.size(), 100U);
        EXPECT_LE(drawn_slice.error_bound, (0.05 + drawn.data.jump()) * (1 + 1e-6));
    }
    expect_closed(boundary_surface(fine, under(fine.criterion(), fine.bounds())).surface, true);
    expect_closed(drawn.surface(0.2, {0.05, 5}, {.cap = true}).surface, true);
    const OnShapes<2> flat(
        Cells::columns, WorldOptions{.levels = 3, .least_degree = 2, .greatest_degree = 5}, gyroid);
    const VirtualRefinement lines(flat.data, {.tolerance = 0.01, .depth = 6});
    const std::array<double, 3> values{-0.2, 0.1, 0.5};
    EXPECT_GT(nestgrid::isolines(lines, std::span<const double>(values),
                                 under(lines.criterion(), lines.bounds()))
                  .lines.vertices.size(),
              100U);
}

TEST(HighOrderShapes, NormalsOfASphereAreExact) {
    for (const Cells cells : {Cells::simplices, Cells::prisms, Cells::all, Cells::pyramids}) {
        const OnShapes<3> drawn(
            cells, WorldOptions{.levels = 1, .least_degree = 2, .greatest_degree = 3}, square<3>);
        Surface<3> surface = drawn.surface(0.5, {0.1, 5}, {.normals = true}).surface;
        ASSERT_GT(surface.vertices.size(), 100U);
        const auto worst = [&] {
            double cosine = 1;
            for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
                const Point& x = surface.vertices[v];
                cosine = std::min(cosine, -dot(surface.normals[v], (1 / norm(x)) * x));
            }
            return cosine;
        };
        EXPECT_LT(worst(), 0.99) << "those of what is drawn are others";
        set_polynomial_normals(surface, drawn.data);
        EXPECT_GT(worst(), 1 - 1e-12);
    }
}

TEST(HighOrderShapes, ProbesEqualEvaluate) {
    const OnShapes<3> drawn(
        Cells::all,
        WorldOptions{.levels = 2, .least_degree = 1, .greatest_degree = 6, .noise = 0.1}, gyroid);
    std::mt19937 random(3);
    std::vector<Point> points;
    for (int i = 0; i < 500; ++i) {
        points.push_back(
            {2.2 * uniform(random) - 1.1, 2 * uniform(random) - 1, 2 * uniform(random) - 1});
    }
    const ProbeResult probed = probe(drawn.data, points);
    std::size_t found = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::optional<double> value = drawn.world.at(points[i]);
        ASSERT_EQ(probed.found(i), value.has_value());
        if (!value) continue;
        ++found;
        EXPECT_NEAR(probed.values[i], *value, 1e-10);
    }
    EXPECT_GT(found, 200U);
    EXPECT_LT(found, 500U);
}

TEST(HighOrderShapes, ColoursOfVerticesAreThePolynomials) {
    const OnShapes<3> drawn(
        Cells::all, WorldOptions{.levels = 1, .least_degree = 3, .greatest_degree = 5}, gyroid);
    const VirtualRefinement fine(drawn.data, {.tolerance = 0.3, .depth = 5});
    auto result =
        slice(fine, Plane({0.05, 0, 0}, {1, 2, 3}), under(fine.criterion(), fine.bounds()));
    const auto greatest = [&] {
        double off = 0;
        for (std::size_t v = 0; v < result.surface.vertices.size(); ++v) {
            off = std::max(off, std::abs(result.surface.attributes[v] -
                                         drawn.world(result.surface.vertices[v])));
        }
        return off;
    };
    EXPECT_GT(greatest(), 0.01);
    set_polynomial_colours(result.surface, drawn.data);
    EXPECT_LE(greatest(), drawn.data.jump() + 1e-10);
}

/// Linear data are drawn as without virtual refinement, to the last bit.
TEST(HighOrderShapes, DegreeOneIsTheHierarchyItself) {
    for (const Cells cells : {Cells::simplices, Cells::prisms, Cells::all, Cells::pyramids}) {
        const OnShapes<3> drawn(
            cells, WorldOptions{.cells = 2, .least_degree = 1, .greatest_degree = 1}, gyroid);
        const VirtualRefinement fine(drawn.data, {.tolerance = 1e-6});
        const auto plain = isosurface(drawn.world, drawn.field, 0.1);
        const auto decorated = isosurface<3>(fine, 0.1, under(Exact(), fine.bounds()));
        EXPECT_GT(plain.surface.simplices.size(), 10U);
        expect_same_simplices(plain.surface, decorated.surface);
    }
}

TEST(HighOrderShapes, AsksTheFieldOnceForEachLeaf) {
    const OnShapes<3> drawn(
        Cells::all, WorldOptions{.levels = 2, .least_degree = 2, .greatest_degree = 4}, gyroid);
    EXPECT_EQ(drawn.field.evaluated, drawn.world.leaf_count());
    (void)drawn.surface(0.1, {0.05, 4});
    EXPECT_LE(drawn.field.evaluated, 2 * drawn.world.leaf_count());
    (void)drawn.surface(0.1, {0.1, 4});
    EXPECT_LE(drawn.field.evaluated, 2 * drawn.world.leaf_count());
}

TEST(HighOrderShapes, WorldsAreSound) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const OnShapes<3> drawn(
            Cells::all,
            WorldOptions{.levels = 2, .least_degree = 1, .greatest_degree = 8, .seed = seed},
            square<3>);
        const auto violation = check_grid(drawn.world, drawn.field);
        EXPECT_FALSE(violation.has_value()) << (violation ? violation->sentence : "");
    }
}

}  // namespace
