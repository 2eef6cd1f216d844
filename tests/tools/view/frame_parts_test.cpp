// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of several isosurfaces, slices along spheres and boundaries: the parts that the library
// draws, of every family in space.
#include <gtest/gtest.h>

#include <explored_field.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "families.hpp"
#include "frame_of.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;
using namespace nestgrid::view;

namespace {

template <class Family>
class FrameParts : public testing::Test {};
using FamiliesInSpace = testing::Types<BisectionTetrahedra, RedGreenTetrahedra, RedGreenMixed3,
                                       UnbalancedOctree, Prisms>;
TYPED_TEST_SUITE(FrameParts, FamiliesInSpace);

void expect_values(const Frame& frame, const std::string& kind, const std::vector<double>& values) {
    expect_same_bits(frame.array<float>(kind, "values"),
                     std::vector<float>(values.begin(), values.end()), "values");
}

TYPED_TEST(FrameParts, AreThoseOfTheLibrary) {
    for_each_field_at_sphere<TypeParam>(2, 5, [](const auto& grid, const NodalSamples& samples) {
        using Grid = std::decay_t<decltype(grid)>;
        const NodeField<Grid, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        const SequentialExecutor executor;
        Explorer explorer(borrowed_field(grid, samples.values), executor);
        const double range = indicator.greatest() - indicator.least();
        const Projection within = under(Threshold(&indicator, 0.05 * range), indicator);
        const std::string finely = "&threshold=" + text_of(0.05 * range);
        const Sphere sphere({0.5, 0.5, 0.4}, 0.37);

        const std::array isovalues{0.1 * range, 0.0};
        const auto surfaces = isosurfaces(grid, field, isovalues, within, {.cuts = Cuts::finest});
        const auto cut = slice(grid, field, sphere, within);
        const auto hull = boundary_surface(grid, field, within);
        std::size_t triangles = cut.surface.simplices.size() + hull.surface.simplices.size();
        for (const std::size_t first : {std::size_t{0}, std::size_t{1}}) {
            triangles += surfaces[first].surface.simplices.size();
            const Frame frame =
                frame_of(explorer, "isovalue=" + text_of(isovalues[first]) + "," +
                                       text_of(isovalues[1 - first]) + "&boundary=on&report=on" +
                                       finely + "&sphere=0.5,0.5,0.4,0.37");
            expect_part(frame, "slice", cut.surface);
            expect_values(frame, "slice", cut.surface.attributes);
            expect_part(frame, "boundary", hull.surface);
            expect_values(frame, "boundary", hull.surface.attributes);
            expect_part(frame, "isosurface", surfaces[first].surface);
            for (const double isovalue : isovalues) {
                const std::string told = "\"isovalue\":" + text_of(isovalue) + ",";
                EXPECT_NE(frame.text().find(told), std::string::npos) << told;
            }
            EXPECT_EQ(frame.number("isovalue", "isosurface"), isovalues[first]);
            const SurfaceReport report = surface_report(surfaces[first].surface);
            EXPECT_EQ(frame.number("area", "isosurface"), report.area);
            EXPECT_EQ(frame.number("open_edges", "isosurface"), double(report.open_edges));
            EXPECT_EQ(frame.has_number("volume"), report.closed());
            if (report.closed()) {
                EXPECT_EQ(frame.number("volume", "isosurface"), report.volume);
            }
            if (first == 1) {
                EXPECT_EQ(frame.number("triangles"), double(triangles));
            }
        }
    });
}

/// A number of triangles is that of all parts together.
TYPED_TEST(FrameParts, KeepWithinTheTrianglesTogether) {
    for_each_field_at_sphere<TypeParam>(2, 5, [](const auto& grid, const NodalSamples& samples) {
        const SequentialExecutor executor;
        Explorer explorer(borrowed_field(grid, samples.values), executor);
        const std::string what = "isovalue=0,0.1&boundary=on&sphere=0.5,0.5,0.4,0.37";
        const double all = frame_of(explorer, what).number("triangles");
        const double least = frame_of(explorer, what + "&triangles=1").number("triangles");
        const double goal = std::floor(0.5 * (all + least));
        const Frame frame = frame_of(explorer, what + "&triangles=" + text_of(goal));
        EXPECT_LE(frame.number("triangles"), goal);
        EXPECT_GE(frame.number("triangles"), least);
    });
}

/// In light, a boundary has the edges of the domain: vertices on them are taken apart, with their
/// values.
TEST(Boundaries, HaveCreasesInLight) {
    for_each_field_at_sphere<UnbalancedOctree>(2, 5, [](const auto& grid, const auto& samples) {
        const SequentialExecutor executor;
        Explorer explorer(borrowed_field(grid, samples.values), executor);
        const Frame plain = frame_of(explorer, "boundary=on");
        const Frame lit = frame_of(explorer, "boundary=on&normals=float32");
        const auto normals = lit.array<float>("boundary", "normals");
        const auto positions = lit.array<float>("boundary", "positions");
        const auto values = lit.array<float>("boundary", "values");
        ASSERT_EQ(normals.size(), positions.size());
        ASSERT_EQ(3 * values.size(), positions.size());
        EXPECT_GT(positions.size(), plain.array<float>("boundary", "positions").size());
        std::map<std::array<float, 3>, float> value_at;
        const auto places = plain.array<float>("boundary", "positions");
        const auto plain_values = plain.array<float>("boundary", "values");
        for (std::size_t i = 0; i < plain_values.size(); ++i) {
            value_at[{places[3 * i], places[3 * i + 1], places[3 * i + 2]}] = plain_values[i];
        }
        for (std::size_t i = 0; i < values.size(); ++i) {
            // The domain is a cube: each normal is along one axis.
            const float* n = &normals[3 * i];
            EXPECT_EQ(std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]), 1);
            EXPECT_EQ(
                values[i],
                (value_at.at({positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]})));
        }
    });
}

}  // namespace
