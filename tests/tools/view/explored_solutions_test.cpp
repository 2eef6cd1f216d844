// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of the interactive page of data of higher degree: within errors of values and of
// positions, closed at the boundary where that is asked for.
#include <gtest/gtest.h>

#include <explored_samples.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "curved_world.hpp"
#include "degree_world.hpp"
#include "frame_of.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;
using namespace nestgrid;
using namespace nestgrid::view;

namespace {

double wave(const Point& x) { return std::sin(3 * x[0]) + std::cos(4 * x[1]) * x[2]; }

/// A world of polynomials in the page.
template <class World>
struct InPage {
    World world;
    DegreeField<3> field{world};
    SequentialExecutor executor;
    Explorer explorer{
        still_field(std::shared_ptr<const World>(std::shared_ptr<const void>(), &world), field),
        executor};

    template <class... Arguments>
    explicit InPage(Arguments&&... arguments) : world(std::forward<Arguments>(arguments)...) {}
};

/// The triangles of an isosurface.
Surface<3> triangles_of(const Frame& frame) {
    return surface_of<3>(frame.array<float>("isosurface", "positions"),
                         frame.array<std::uint32_t>("isosurface", "indices"));
}

/// Frames of data of higher degree are surfaces of the polynomials within the error, whatever the
/// page calls it.
TEST(Polynomials, AreDrawnWithinErrorsAndNumbersOfTriangles) {
    InPage<DegreeWorld<3>> page(
        WorldOptions{.levels = 1, .least_degree = 2, .greatest_degree = 4, .seed = 5}, wave);
    Explorer& explorer = page.explorer;
    EXPECT_NE(explorer.info().find("\"degree\":4"), std::string::npos);

    const HighOrder data(page.world, page.field);
    EXPECT_NE(explorer.info().find("\"jump\":" + text_of(data.jump())), std::string::npos);
    const Plane plane({0.1, 0.2, 0.3}, {1, 0.2, 0.1});
    const std::string asked = "isovalue=0.1&plane=0.1,0.2,0.3,1,0.2,0.1";
    for (const double error : {0.3, 0.02}) {
        const VirtualRefinement fine(data, {.tolerance = error});
        const Projection within = under(fine.criterion(), fine.bounds());
        const auto surface = isosurface<3>(fine, 0.1, within);
        const auto cut = slice(fine, plane, within);
        for (const char* const held : {"error", "threshold"}) {
            const Frame frame =
                frame_of(explorer, asked + "&" + held + "=" + text_of(error) + "&outlines=on");
            expect_part(frame, "isosurface", surface.surface);
            expect_part(frame, "slice", cut.surface);
            EXPECT_LE(frame.number("error_bound"), (error + data.jump()) * (1 + 1e-6));
        }
    }
    for (const double goal : {2000.0, 20000.0}) {
        const Frame frame =
            frame_of(explorer, asked + "&triangles=" + text_of(goal) + "&normals=int8");
        EXPECT_LE(frame.number("triangles"), goal);
        EXPECT_GE(frame.number("triangles"), goal / 2);
        const double least = frame.number("threshold");
        const Frame again = frame_of(explorer, asked + "&error=" + text_of(least));
        EXPECT_EQ(again.number("triangles"), frame.number("triangles"));
    }
    const double without = frame_of(explorer, "isovalue=0.1&error=0.3").number("triangles");
    const Frame lens = frame_of(explorer, "isovalue=0.1&error=0.3&lens=0.1,0.2,0.3,0.1&slope=1");
    EXPECT_GT(lens.number("triangles"), 2 * without);
    for (const char* const none : {"distance=0.1", "error=0.1&collapse=on", "error=0.1&blend=2"}) {
        expect_refused([&] { frame_of(explorer, std::string("isovalue=0.1&") + none); },
                       "data of higher degree are drawn within an error or a number of triangles");
    }
}

/// What else a frame may be asked for is what the library draws of the polynomials.
TEST(Polynomials, AreDrawnWithWhatElseIsAskedFor) {
    InPage<DegreeWorld<3>> page(
        WorldOptions{.levels = 1, .least_degree = 2, .greatest_degree = 4, .seed = 5}, wave);
    Prerolls prerolls(FieldOnGrid(page.world, page.field));
    const Projection within{.threshold = 0.1, .indicator = "error"};
    const auto drawn = [&](const std::string& asked) {
        return frame_of(page.explorer, "error=0.1&" + asked);
    };
    expect_part(drawn("band=0.1,0.4"), "band", isoband<3>(prerolls, 0.1, 0.4, within).surface);
    Projection finer = within;
    finer.region = {Box{{0.1, 0.2, 0.3}, {0.6, 0.7, 0.8}}, 0.02};
    const auto surface = isosurface<3>(prerolls, 0.1, finer);
    const Frame boxed =
        drawn("isovalue=0.1&box=0.1,0.6,0.2,0.7,0.3,0.8&box_threshold=0.02&measure=on");
    expect_part(boxed, "isosurface", surface.surface);
    EXPECT_EQ(boxed.number("measured_error", "isosurface"),
              measure_error(prerolls, surface.surface, 0.1, 50000).value.greatest);
    Projection coloured = within;
    coloured.colour_tolerance = 0.02;
    const auto cut = slice(prerolls, Sphere({0.1, 0.2, 0.3}, 0.4), coloured);
    const Frame sphere = drawn("sphere=0.1,0.2,0.3,0.4&colour_tolerance=0.02&lines=0.5");
    expect_part(sphere, "slice", cut.surface);
    const auto plain = slice(prerolls, Sphere({0.1, 0.2, 0.3}, 0.4), within);
    EXPECT_GT(cut.surface.simplices.size(), plain.surface.simplices.size());
    EXPECT_TRUE(sphere.has("isolines"));
}

/// A frame reads the leaves that its parts meet alone, and has the parts of all leaves.
template <class Page>
void expect_parts_of_all_leaves(Page& page) {
    const HighOrder data(page.world, page.field);
    const Sphere sphere({0.1, 0.2, 0.3}, 0.4);
    const std::array isovalues{0.1, 0.4};
    for (const double error : {0.3, 0.05}) {
        const VirtualRefinement fine(data, {.tolerance = error});
        const Projection within = under(fine.criterion(), fine.bounds());
        const auto surfaces = isosurfaces<3>(fine, isovalues, within);
        const auto cut = slice(fine, sphere, within);
        const auto hull = boundary_surface(fine, within);
        EXPECT_GT(surfaces[1].surface.simplices.size(), 0U);
        const std::string finely = "&error=" + text_of(error);
        const Frame frame =
            frame_of(page.explorer, "isovalue=0.1,0.4&boundary=on&sphere=0.1,0.2,0.3,0.4" + finely);
        expect_part(frame, "slice", cut.surface);
        expect_part(frame, "boundary", hull.surface);
        expect_part(frame, "isosurface", surfaces[0].surface);
        expect_part(frame_of(page.explorer, "isovalue=0.4,0.1" + finely), "isosurface",
                    surfaces[1].surface);
        expect_part(frame_of(page.explorer, "boundary=on" + finely), "boundary", hull.surface);
        expect_part(frame_of(page.explorer, "sphere=0.1,0.2,0.3,0.4" + finely), "slice",
                    cut.surface);
    }
}

TEST(Polynomials, PartsAreThoseOfAllLeaves) {
    InPage<DegreeWorld<3>> page(
        WorldOptions{.levels = 1, .least_degree = 2, .greatest_degree = 4, .seed = 5}, wave);
    expect_parts_of_all_leaves(page);
}

TEST(CurvedLeaves, PartsAreThoseOfAllLeaves) {
    const Bend bend{[](const Point& x) {
        return Point{x[0] + 0.1 * x[1] * x[1], x[1] - 0.1 * x[0] * x[2], x[2]};
    }};
    InPage<CurvedWorld<DegreeWorld<3>>> page(
        bend, WorldOptions{.least_degree = 2, .greatest_degree = 2}, wave);
    expect_parts_of_all_leaves(page);
}

/// A frame of curved leaves is that of the library within the same error of positions.
TEST(CurvedLeaves, AreDrawnWithinErrorsOfPositions) {
    const Bend bend{[](const Point& x) {
        return Point{x[0] + 0.1 * x[1] * x[1], x[1] - 0.1 * x[0] * x[2], x[2]};
    }};
    const WorldOptions options{.least_degree = 2, .greatest_degree = 2};
    InPage<CurvedWorld<DegreeWorld<3>>> page(bend, options, wave);
    EXPECT_NE(page.explorer.info().find("\"curved\":true"), std::string::npos);
    const HighOrder data(page.world, page.field);
    std::vector<double> triangles;
    for (const double positions : {0.1, 0.01, 0.001}) {
        const VirtualRefinement fine(data, {.tolerance = 0.1, .position_tolerance = positions});
        const auto surface = isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds()));
        const Frame frame =
            frame_of(page.explorer, "isovalue=0.1&error=0.1&position_error=" + text_of(positions));
        expect_part(frame, "isosurface", surface.surface);
        EXPECT_EQ(frame.number("position_bound"), surface.position_bound);
        EXPECT_LE(frame.number("position_bound"), positions);
        triangles.push_back(frame.number("triangles"));
    }
    EXPECT_GT(triangles.back(), 2 * triangles.front());
    InPage<DegreeWorld<3>> straight(options, wave);
    expect_refused(
        [&] { frame_of(straight.explorer, "isovalue=0.1&error=0.1&position_error=0.1"); },
        "the elements are straight");
}

/// A capped isosurface is closed, whatever detail is held at, and has the triangles asked for.
TEST(Caps, CloseIsosurfaces) {
    InPage<DegreeWorld<3>> page(
        WorldOptions{.levels = 1, .least_degree = 1, .greatest_degree = 3, .seed = 7}, wave);
    Explorer& explorer = page.explorer;
    const auto edges_at_boundary = [&](const std::string& what) {
        const SurfaceReport report =
            surface_report(triangles_of(frame_of(explorer, "isovalue=0.1&" + what)));
        return report.open_edges + report.boundary_edges;
    };
    for (const char* const held : {"error=0.1", "triangles=5000", "error=0.1&motion=moving"}) {
        EXPECT_GT(edges_at_boundary(held), 0U) << held;
        EXPECT_EQ(edges_at_boundary(held + std::string("&cap=on")), 0U) << held;
    }
    EXPECT_LE(frame_of(explorer, "isovalue=0.1&cap=on&triangles=5000").number("triangles"), 5000);
}

/// The part of a box where x is at least 0.1 is a box, with the normals of one.
TEST(Caps, HaveEdges) {
    InPage<DegreeWorld<3>> page(
        WorldOptions{.levels = 1, .least_degree = 1, .greatest_degree = 2, .seed = 7},
        [](const Point& x) { return x[0]; });
    Explorer& explorer = page.explorer;
    const std::string asked = "isovalue=0.1&error=0.1&cap=on";
    const Surface<3> without = triangles_of(frame_of(explorer, asked));
    for (const std::string motion : {"settled", "moving"}) {
        const Frame frame = frame_of(explorer, asked + "&normals=float32&motion=" + motion);
        const Surface<3> creased = triangles_of(frame);
        ASSERT_EQ(creased.simplices.size(), without.simplices.size());
        for (std::size_t t = 0; t < without.simplices.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_EQ(creased.vertices[creased.simplices[t][k]],
                          without.vertices[without.simplices[t][k]]);
            }
        }
        const std::vector<float> normals = frame.array<float>("isosurface", "normals");
        ASSERT_EQ(normals.size(), 3 * creased.vertices.size());
        for (std::size_t i = 0; i < normals.size(); i += 3) {
            const double greatest = std::max(
                {std::abs(normals[i]), std::abs(normals[i + 1]), std::abs(normals[i + 2])});
            EXPECT_NEAR(greatest, 1, 1e-5);
        }
    }
}

}  // namespace
