// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of the interactive page of data of higher degree: within errors of values and of
// positions, closed at the boundary where that is asked for.
#include <gtest/gtest.h>

#include <explored_samples.hpp>
#include <nestgrid/algorithms/high_order.hpp>
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

/// Frames of data of higher degree are surfaces of the polynomials within the error, whatever the
/// page calls it.
TEST(Polynomials, AreDrawnWithinErrorsAndNumbersOfTriangles) {
    const DegreeWorld<3> world(
        {.levels = 1, .least_degree = 2, .greatest_degree = 4, .seed = 5},
        [](const Point& x) { return std::sin(3 * x[0]) + std::cos(4 * x[1]) * x[2]; });
    const DegreeField<3> field(world);
    const SequentialExecutor executor;
    const std::shared_ptr<const DegreeWorld<3>> shared(std::shared_ptr<const void>(), &world);
    ExploredField explored = still_field(shared, field);
    Explorer explorer(std::move(explored), executor);
    EXPECT_NE(explorer.info().find("\"degree\":4"), std::string::npos);

    const HighOrder data(world, field);
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
    for (const char* const none : {"distance=0.1", "error=0.1&collapse=on"}) {
        expect_refused([&] { frame_of(explorer, std::string("isovalue=0.1&") + none); },
                       "data of higher degree are drawn within an error or a number of triangles");
    }
}

/// A frame of curved leaves is that of the library within the same error of positions.
TEST(CurvedLeaves, AreDrawnWithinErrorsOfPositions) {
    using World = CurvedWorld<DegreeWorld<3>>;
    const auto gyroid = [](const Point& x) {
        return std::sin(3 * x[0]) + std::cos(4 * x[1]) * x[2];
    };
    const Bend bend{[](const Point& x) {
        return Point{x[0] + 0.1 * x[1] * x[1], x[1] - 0.1 * x[0] * x[2], x[2]};
    }};
    const World world(bend, WorldOptions{.least_degree = 2, .greatest_degree = 2}, gyroid);
    const DegreeField<3> field(world);
    const SequentialExecutor executor;
    const std::shared_ptr<const World> shared(std::shared_ptr<const void>(), &world);
    Explorer explorer(still_field(shared, field), executor);
    EXPECT_NE(explorer.info().find("\"curved\":true"), std::string::npos);
    const HighOrder data(world, field);
    std::vector<double> triangles;
    for (const double positions : {0.1, 0.01, 0.001}) {
        const VirtualRefinement fine(data, {.tolerance = 0.1, .position_tolerance = positions});
        const auto surface = isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds()));
        const Frame frame =
            frame_of(explorer, "isovalue=0.1&error=0.1&position_error=" + text_of(positions));
        expect_part(frame, "isosurface", surface.surface);
        EXPECT_EQ(frame.number("position_bound"), surface.position_bound);
        EXPECT_LE(frame.number("position_bound"), positions);
        triangles.push_back(frame.number("triangles"));
    }
    EXPECT_GT(triangles.back(), 2 * triangles.front());
    const DegreeWorld<3> straight(WorldOptions{.least_degree = 2, .greatest_degree = 2}, gyroid);
    const DegreeField<3> on_straight(straight);
    const std::shared_ptr<const DegreeWorld<3>> borrowed(std::shared_ptr<const void>(), &straight);
    Explorer without(still_field(borrowed, on_straight), executor);
    expect_refused([&] { frame_of(without, "isovalue=0.1&error=0.1&position_error=0.1"); },
                   "the elements are straight");
}

/// A capped isosurface is closed, whatever detail is held at, and has the triangles asked for.
TEST(Caps, CloseIsosurfaces) {
    const DegreeWorld<3> world(
        {.levels = 1, .least_degree = 1, .greatest_degree = 3, .seed = 7},
        [](const Point& x) { return std::sin(3 * x[0]) + std::cos(4 * x[1]) * x[2]; });
    const DegreeField<3> field(world);
    const SequentialExecutor executor;
    const std::shared_ptr<const DegreeWorld<3>> shared(std::shared_ptr<const void>(), &world);
    Explorer explorer(still_field(shared, field), executor);
    const auto edges_at_boundary = [&](const std::string& what) {
        const Frame frame = frame_of(explorer, "isovalue=0.1&" + what);
        const auto surface = surface_of<3>(frame.array<float>("isosurface", "positions"),
                                           frame.array<std::uint32_t>("isosurface", "indices"));
        const SurfaceReport report = surface_report(surface);
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
    const DegreeWorld<3> world({.levels = 1, .least_degree = 1, .greatest_degree = 2, .seed = 7},
                               [](const Point& x) { return x[0]; });
    const DegreeField<3> field(world);
    const SequentialExecutor executor;
    const std::shared_ptr<const DegreeWorld<3>> shared(std::shared_ptr<const void>(), &world);
    Explorer explorer(still_field(shared, field), executor);
    const auto triangles_of = [](const Frame& frame) {
        return surface_of<3>(frame.array<float>("isosurface", "positions"),
                             frame.array<std::uint32_t>("isosurface", "indices"));
    };
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
