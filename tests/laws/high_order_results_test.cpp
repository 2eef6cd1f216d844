// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data of higher degree under projections of all kinds, collapsed, coloured, and measured.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/measured_error.hpp>

#include "curved_world.hpp"
#include "high_order_judge.hpp"
#include "high_order_worlds.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"

using namespace nestgrid_test;
using namespace nestgrid;

namespace {

/// The values of a field at nodes, without its degrees.
struct NodalField {
    using value_type = double;
    using Element = DegreeWorld<3>::Element;

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return field->coarse_values(i, out);
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<double> out) const {
        return field->new_values(e, which, out);
    }
    const DegreeField<3>* field;
};

/// A projection asks for an error, which is kept, or is refused; or it draws at the corners of
/// leaves what it draws of a field without degrees.
TEST(HighOrderProjections, KeepAnErrorOrAreRefusedOrDrawAtCorners) {
    const OnBoxes<3> drawn(hanging_world(1), gyroid);
    const Prerolls prerolls(drawn.world, drawn.field);
    const auto draw = [&](const Projection& how) { return isosurface<3>(prerolls, 0.1, how); };
    for (const char* name : {"error", "deviation", "cut"}) {
        const auto result = draw({.threshold = 0.2, .indicator = name});
        expect_closed(result.surface);
        expect_bound(drawn, result, 0.1, 0.2);
    }
    const auto refused = [&](const Projection& how, const std::string& part) {
        expect_refused([&] { (void)draw(how); }, part);
        expect_refused([&] { (void)with_error(prerolls, how); }, part);
    };
    refused({.threshold = 0.2, .indicator = "error", .keeps_distance = true}, "by no distance");
    refused({.threshold = 0.2, .indicator = "error", .blend = 2}, "by no blend");
    for (const Projection& none :
         {Projection{.threshold = 0, .indicator = "error"}, Projection{.indicator = "deviation"}}) {
        expect_refused([&] { (void)draw(none); }, "within an error, which is above 0");
    }
    for (const Projection& how :
         {Projection{.threshold = 0.2}, Projection{.threshold = 0.2, .indicator = "visual"}}) {
        expect_refused([&] { (void)with_error(prerolls, how); }, "by no threshold of nodes");
    }
    const NodalField nodal{&drawn.field};
    const Prerolls of_nodes(drawn.world, nodal);
    for (const Projection& how :
         {Projection{}, Projection{.threshold = 0.2}, Projection{.max_triangles = 200},
          Projection{.threshold = 0.2, .indicator = "visual"},
          Projection{.threshold = 0.2, .collapse = true}}) {
        const auto at_corners = draw(how);
        const auto expected = isosurface<3>(of_nodes, 0.1, how);
        EXPECT_GT(expected.surface.simplices.size(), 10U);
        expect_same_simplices(at_corners.surface, expected.surface);
    }
}

TEST(HighOrderCollapses, KeepTheErrorAndStayClosed) {
    std::size_t drawn_triangles = 0;
    std::size_t left = 0;
    for_each_world(2, [&](const auto& drawn, unsigned) {
        const Prerolls prerolls(drawn.world, drawn.field);
        const double error = 0.2;
        const Projection within{.threshold = error, .indicator = "error"};
        Projection collapsing = within;
        collapsing.collapse = true;
        const auto result = isosurface<3>(prerolls, 0.1, collapsing);
        ASSERT_TRUE(result.collapsed.has_value());
        expect_closed(result.surface);
        EXPECT_LE(measured(drawn.world, result.surface, 0.1),
                  result.error_bound + std::ldexp(4.0, -20));
        if (result.collapsed->exceeding == 0) {
            EXPECT_LE(result.error_bound, (error + drawn.data.jump()) * (1 + 1e-6));
        }
        left += result.surface.simplices.size();
        drawn_triangles += isosurface<3>(prerolls, 0.1, within).surface.simplices.size();
    });
    EXPECT_LT(left, drawn_triangles / 2);
}

/// Heights and colours of every point of the collapsed graph are within the bound.
TEST(HighOrderCollapses, KeepTheErrorOfHeights) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const OnShapes<2> drawn(Cells::columns, hanging_world(seed), gyroid);
        const Prerolls prerolls(drawn.world, drawn.field);
        const double scale = 3;
        Projection how{.threshold = 0.1, .indicator = "error"};
        const auto whole = height_field(prerolls, scale, how);
        how.collapse = true;
        const auto fewer = height_field(prerolls, scale, how);
        EXPECT_LT(fewer.surface.simplices.size(), whole.surface.simplices.size() / 2);
        EXPECT_LE(fewer.error_bound, (0.1 + drawn.data.jump()) * (1 + 1e-6));
        double heights_off = 0;
        double colours_off = 0;
        for (const auto& t : fewer.surface.simplices) {
            for (const Point& weight : {Point{1, 1, 1}, Point{2, 1, 0}, Point{0, 2, 1},
                                        Point{1, 0, 2}, Point{2.8, 0.1, 0.1}}) {
                Point x{0, 0, 0};
                double colour = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    x = x + weight[k] / 3 * fewer.surface.vertices[t[k]];
                    colour += weight[k] / 3 * fewer.surface.attributes[t[k]];
                }
                const double u = drawn.world({x[0], x[1], 0});
                heights_off = std::max(heights_off, std::abs(x[2] / scale - u));
                colours_off = std::max(colours_off, std::abs(colour - u));
            }
        }
        EXPECT_LE(heights_off, fewer.error_bound * (1 + 1e-6));
        EXPECT_LE(colours_off, fewer.error_bound * (1 + 1e-6));
        EXPECT_GT(heights_off, 0.01);
    }
}

/// The greatest difference of the colours of a surface from the data, at 15 points of triangles.
template <class World>
double colours_off(const World& world, const Surface<3>& surface) {
    double greatest = 0;
    for (const auto& t : surface.simplices) {
        for (int a = 0; a <= 4; ++a) {
            for (int b = 0; a + b <= 4; ++b) {
                const std::array<double, 3> weight{a / 4.0, b / 4.0, 1 - (a + b) / 4.0};
                Point x{0, 0, 0};
                double colour = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    x = x + weight[k] * surface.vertices[t[k]];
                    colour += weight[k] * surface.attributes[t[k]];
                }
                greatest = std::max(greatest, std::abs(world(x) - colour));
            }
        }
    }
    return greatest;
}

TEST(HighOrderColours, FollowThePolynomials) {
    const OnBoxes<3> boxes(WorldOptions{.least_degree = 3, .greatest_degree = 3}, gyroid);
    const Prerolls prerolls(boxes.world, boxes.field);
    const Plane plane({0.1, 0.02, 0.3}, {1, 2, 3});
    Projection within{.threshold = 1, .indicator = "error"};
    const auto coarse = slice(prerolls, plane, within);
    EXPECT_GT(colours_off(boxes.world, coarse.surface), 0.05);
    within.colour_tolerance = 0.05;
    const auto fine = slice(prerolls, plane, within);
    expect_closed(fine.surface);
    EXPECT_LE(colours_off(boxes.world, fine.surface), 0.05);
    // Edges are collapsed while colours keep the error.
    const auto fewer =
        slice(prerolls, plane, {.threshold = 0.2, .indicator = "error", .collapse = true});
    expect_closed(fewer.surface);
    EXPECT_LE(colours_off(boxes.world, fewer.surface), fewer.error_bound);
    EXPECT_LE(fewer.error_bound, (0.2 + boxes.data.jump()) * (1 + 1e-6));
    const auto whole = slice(prerolls, plane, {.threshold = 0.2, .indicator = "error"});
    EXPECT_LT(fewer.surface.simplices.size(), whole.surface.simplices.size());
}

TEST(HighOrderMeasures, AreOfThePolynomials) {
    const OnBoxes<3> boxes(WorldOptions{.levels = 1, .least_degree = 2, .greatest_degree = 4},
                           gyroid);
    const Prerolls prerolls(boxes.world, boxes.field);
    const auto drawn = isosurface<3>(prerolls, 0.1, {.threshold = 0.3, .indicator = "error"});
    const MeasuredError error = measure_error(prerolls, drawn.surface, 0.1, 20000);
    const double seen = measured(boxes.world, drawn.surface, 0.1);
    EXPECT_LE(error.value.greatest, drawn.error_bound + std::ldexp(4.0, -20));
    EXPECT_GT(error.value.greatest, 0.5 * seen);
    EXPECT_GT(error.value.mean, 0);
    EXPECT_LT(error.distance.greatest, 0.2);
    EXPECT_LT(error.back.greatest, 0.2);
}

/// Distances from a sphere, there and back, are known: a surface of coarse triangles is compared
/// with one that is finer by the factor that the tenth of the error is.
TEST(HighOrderMeasures, DistancesAreThoseOfASphere) {
    const OnBoxes<3> boxes(WorldOptions{.least_degree = 2, .greatest_degree = 2}, square<3>);
    const Prerolls prerolls(boxes.world, boxes.field);
    const double radius = 0.8;
    const auto drawn =
        isosurface<3>(prerolls, radius * radius, {.threshold = 0.2, .indicator = "error"});
    double off = 0;
    for (const auto& t : drawn.surface.simplices) {
        for (const Point& weight : {Point{1, 1, 1}, Point{1.5, 1.5, 0}, Point{0, 1.5, 1.5},
                                    Point{1.5, 0, 1.5}, Point{3, 0, 0}}) {
            Point x{0, 0, 0};
            for (std::size_t k = 0; k < 3; ++k) {
                x = x + weight[k] / 3 * drawn.surface.vertices[t[k]];
            }
            off = std::max(off, std::abs(norm(x) - radius));
        }
    }
    const MeasuredError error = measure_error(prerolls, drawn.surface, radius * radius, 20000);
    EXPECT_GT(off, 0.02);
    EXPECT_NEAR(error.distance.greatest, off, 0.15 * off);
    EXPECT_NEAR(error.back.greatest, off, 0.3 * off);
}

TEST(HighOrderCollapses, RefuseWhatTheyDoNot) {
    const OnBoxes<3> boxes(hanging_world(1), waves);
    const Prerolls prerolls(boxes.world, boxes.field);
    const auto draw = [&](Projection how) {
        how.indicator = "error";
        how.collapse = true;
        (void)isosurface<3>(prerolls, 0.1, how);
    };
    expect_refused([&] { draw({.max_triangles = 1000}); }, "by no number of triangles");
    expect_refused([&] { draw({.threshold = 1e-12}); }, "within an error of at least");
    const DrawnWorld<CurvedWorld<DegreeWorld<3>>, DegreeField<3>> bent(
        polynomial_bend(2, 0.1, 3), WorldOptions{.least_degree = 2}, square<3>);
    const Prerolls curved(bent.world, bent.field);
    expect_refused(
        [&] {
            (void)isosurface<3>(curved, 0.5,
                                {.threshold = 0.1, .indicator = "error", .collapse = true});
        },
        "of curved cells are not collapsed");
}

}  // namespace
