// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Colours that follow multilinear data within a tolerance, on every family: everywhere on the
// triangles, without a crack, and without a triangle where none is needed.
#include <functional>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "five_at_nodes.hpp"
#include "is_affine.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace refine_colours_test {

template <class Family>
class RefinedColours : public testing::Test {};
TYPED_TEST_SUITE(RefinedColours, Families);

/// Simplices interpolate linearly, and nothing is to be refined in them.
template <class Grid>
bool has_simplices_only(const Grid& grid) {
    for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
        const Shape shape = grid.coarse(i).shape;
        if (shape != Shape::triangle && shape != Shape::tetrahedron) return false;
    }
    return true;
}

/// Coarse and finer elements of mixed grids may interpolate a quadrilateral face differently: P_S U
/// then jumps across it, and the data at a point of the face are those of one side.
template <class Family>
constexpr bool jumps = std::is_same_v<Family, RedGreenMixed3>;

/// The greatest difference between colours and data at points inside triangles.
/// \param probe(points) the data
template <class Probe>
double greatest_difference(const Surface<3>& surface, Probe&& probe) {
    std::mt19937 random(3);
    std::vector<Point> points;
    std::vector<double> colours;
    for (const auto& v : surface.simplices) {
        for (int i = 0; i < 20; ++i) {
            double a = uniform(random);
            double b = uniform(random);
            if (a + b > 1) {
                a = 1 - a;
                b = 1 - b;
            }
            const std::array<double, 3> weights{a, b, 1 - a - b};
            Point x{};
            double colour = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                x = x + weights[k] * surface.vertices[v[k]];
                colour += weights[k] * surface.attributes[v[k]];
            }
            points.push_back(x);
            colours.push_back(colour);
        }
    }
    const ProbeResult probed = probe(points);
    double greatest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!probed.found(i)) continue;
        greatest = std::max(greatest, std::abs(probed.values[i] - colours[i]));
    }
    return greatest;
}

/// Refines the colours of a surface, and expects what it promises.
/// \param projection that the surface was drawn with
/// \return the number of sides that were split
template <class Grid, class Field>
std::size_t expect_refined(Surface<3> surface, const Grid& grid, const Field& field,
                           const Projection& projection = {}) {
    constexpr double tolerance = 0.05;
    const Surface<3> before = surface;
    const SurfaceReport report = surface_report(before);
    const ColourRefinement refined = refine_colours(surface, {grid, field}, tolerance, projection);
    expect_closed(surface);
    EXPECT_LE(refined.miss, tolerance / 2.2);
    EXPECT_EQ(surface.vertices.size(), before.vertices.size() + refined.split);
    EXPECT_EQ(surface.element_of.size(), surface.simplices.size());
    EXPECT_NEAR(surface_report(surface).area, report.area, 1e-12 * (1 + report.area));
    if (is_affine(grid)) {
        const auto probe_all = [&](std::span<const Point> x) {
            return probe(grid, field, x, projection);
        };
        EXPECT_LE(greatest_difference(surface, probe_all), tolerance + 1e-12);
    }
    if (has_simplices_only(grid)) {
        EXPECT_EQ(refined.split, 0U);
    }
    return refined.split;
}

TYPED_TEST(RefinedColours, FollowTheDataWithinATolerance) {
    std::size_t split = 0;
    bool simplices = true;
    for_each_field_at_sphere<TypeParam>(2, 7, [&](const auto& grid, const auto& samples) {
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        simplices = simplices && has_simplices_only(grid);
        for (const double threshold : {0.0, 0.1, 1.0}) {
            if (jumps<TypeParam> && threshold > 0) continue;
            SCOPED_TRACE(threshold);
            const Projection projection = under(indicator, threshold);
            if constexpr (TypeParam::Grid::dimension == 2) {
                split += expect_refined(shading(grid, field, projection).surface, grid, field,
                                        projection);
            } else {
                const Plane oblique({0.4, 0.5, 0.49}, {0.3, 0.5, 0.81});
                split += expect_refined(slice(grid, field, oblique, projection).surface, grid,
                                        field, projection);
                split += expect_refined(boundary_surface(grid, field, projection).surface, grid,
                                        field, projection);
            }
        }
        if constexpr (TypeParam::Grid::dimension == 3) {
            const Plane through_nodes({0.5, 0, 0}, {1, 0, 0});
            split += expect_refined(slice(grid, field, through_nodes).surface, grid, field);
        }
    });
    EXPECT_EQ(split > 0, !simplices);
}

/// A linear function has exact colours.
TYPED_TEST(RefinedColours, LeaveALinearFunctionAlone) {
    const auto f = [](const Point& x) { return 2 * x[0] - 3 * x[1] + 0.125; };
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        const std::vector<double> values = sample_nodes(grid, f);
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
        Surface<3> surface;
        if constexpr (TypeParam::Grid::dimension == 2) {
            surface = shading(grid, field).surface;
        } else {
            surface = slice(grid, field, Plane({0.4, 0.5, 0.49}, {0.3, 0.5, 0.81})).surface;
        }
        EXPECT_EQ(refine_colours(surface, {grid, field}, 1e-9).split, 0U);
        expect_colours(surface, f);
    }
}

/// In the middle of hexahedra, xyz is neither linear nor quadratic.
TEST(RefinedColours, TakeTheSurfaceOnceDrawn) {
    const auto grid = BalancedOctree::grids()[0];
    const std::vector<double> values =
        sample_nodes(grid, [](const Point& x) { return x[0] * x[1] * x[2]; });
    const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    const Threshold s(&indicator, 0.01);
    const Plane plane({0.4, 0.5, 0.49}, {0.3, 0.5, 0.81});
    const double tolerance = 0.001;
    // [refine_colours]
    Surface<3> surface = slice(grid, field, plane, under(s, indicator)).surface;
    const ColourRefinement refined =
        refine_colours(surface, {grid, field}, tolerance, under(s, indicator));
    // [refine_colours]
    EXPECT_GT(refined.split, 0U);
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        const Point& x = surface.vertices[v];
        EXPECT_NEAR(surface.attributes[v], x[0] * x[1] * x[2], 0.011);
    }
}

/// Also on an isosurface, which carries components 1 to 4, with normals of length 1.
TEST(RefinedColours, FollowTheDataOnIsosurfaces) {
    auto grid = UnbalancedOctree::grids()[0];
    refine_at_sphere(grid, 3);
    std::vector<std::array<double, 5>> values;
    for (const Point& p : grid.node_positions()) {
        values.push_back({0.3 - norm(p - Point{0.5, 0.5, 0.5}), p[0], p[1] * p[2], 1, p[2]});
    }
    const FiveAtNodes field(grid, std::move(values));
    const HierarchicalIndicator indicator(grid, field);
    Surface<3> surface =
        isosurface(grid, field, 0.0, under(indicator, 0), {.normals = true}).surface;
    EXPECT_GT(refine_colours(surface, {grid, field}, 1e-4).split, 0U);
    expect_closed(surface);
    ASSERT_EQ(surface.attributes.size(), 4 * surface.vertices.size());
    for (const Point& n : surface.normals) EXPECT_NEAR(norm(n), 1, 1e-12);
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        EXPECT_NEAR(surface.attributes[4 * v], surface.vertices[v][0], 1e-12);
        EXPECT_NEAR(surface.attributes[4 * v + 2], 1, 1e-12);
    }
}

/// Cubic polynomials on two triangles: one that vanishes on all sides of the first triangle, two
/// that vanish at a third of each side and at the centre, and a general one.
TEST(RefinedColours, FollowCubicPolynomials) {
    using Function = std::function<double(const Point&)>;
    const auto on_side = [](double a, double b) { return 13.5 * a * b * (a - 2 * b); };
    const std::vector<Function> functions{
        [](const Point& x) { return 27 * x[0] * x[1] * (1 - x[0] - x[1]); },
        [&](const Point& x) {
            const double z = 1 - x[0] - x[1];
            return on_side(z, x[0]) + on_side(z, x[1]) + on_side(x[0], x[1]) +
                   40.5 * x[0] * x[1] * z;
        },
        [&](const Point& x) {
            const double z = 1 - x[0] - x[1];
            return on_side(x[0], z) + on_side(x[1], z) + on_side(x[1], x[0]) +
                   40.5 * x[0] * x[1] * z;
        },
        [](const Point& x) { return std::pow(x[0] - 0.3, 3) + x[0] * x[1] - x[1]; }};
    for (const Function& f : functions) {
        Surface<3> surface;
        surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
        surface.simplices = {{0, 1, 2}, {1, 3, 2}};
        surface.element_of = {4, 2};
        surface.boundary = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};
        for (const Point& x : surface.vertices) surface.attributes.push_back(f(x));
        const auto probe_f = [&](std::span<const Point> points) {
            ProbeResult probed;
            for (const Point& x : points) probed.values.push_back(f(x));
            probed.level.assign(points.size(), 0);
            return probed;
        };
        EXPECT_GT(detail::refine_colours(surface, 0.01, probe_f).split, 5U);
        EXPECT_LE(greatest_difference(surface, probe_f), 0.01);
        expect_closed(surface);
        for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
            Point sum{};
            for (const std::uint32_t v : surface.simplices[t]) sum = sum + surface.vertices[v];
            EXPECT_EQ(surface.element_of[t], sum[0] + sum[1] < 3 ? 4U : 2U);
        }
    }
}

TEST(RefinedColours, AreRefusedWhereTheyMakeNoSense) {
    auto grid = BalancedOctree::grids()[0];
    const std::vector<double> values = sample_nodes(grid, [](const Point& x) { return x[0]; });
    const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
    Surface<3> surface = slice(grid, field, Plane({0.5, 0.5, 0.3}, {0, 0, 1})).surface;
    const auto refine = [&](double tolerance) {
        refine_colours(surface, {grid, field}, tolerance);
    };
    expect_refused([&] { refine(0); }, "tolerance of colours is not a positive number");
    expect_refused([&] { refine(std::nan("")); }, "tolerance of colours");
    surface.attributes.resize(2 * surface.vertices.size());
    expect_refused([&] { refine(1); }, "more attributes than the field has components");
    surface.attributes.clear();
    expect_refused([&] { refine(1); }, "no attributes");
    surface.attributes.resize(surface.vertices.size());
    surface.reference.resize(3 * surface.simplices.size());
    expect_refused([&] { refine(1); }, "reference coordinates");
    Surface<3> empty;
    EXPECT_EQ(refine_colours(empty, {grid, field}, 1).split, 0U);
}

}  // namespace refine_colours_test
