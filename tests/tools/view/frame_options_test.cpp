// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame may be asked for beside values, slices and detail: each is what the library draws
// under a projection that says the same, on every family in space.
#include <gtest/gtest.h>

#include <explored_field.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "families.hpp"
#include "frame_of.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;
using namespace nestgrid::view;

namespace {

template <class Family>
class FrameOptions : public testing::Test {};
using FamiliesOfOptions =
    testing::Types<BisectionTetrahedra, RedGreenMixed3, UnbalancedOctree, Prisms>;
TYPED_TEST_SUITE(FrameOptions, FamiliesOfOptions);

/// A grid with a field, in a page and in the library.
template <class Grid>
struct PageAndLibrary {
    PageAndLibrary(const Grid& grid, const NodalSamples& samples)
        : field(grid, samples.values),
          prerolls(FieldOnGrid(grid, field)),
          explorer(
              still_field(std::shared_ptr<const Grid>(std::shared_ptr<const void>(), &grid), field),
              executor) {
        const auto [least, greatest] = std::ranges::minmax(samples.values);
        range = greatest - least;
    }
    Frame frame(const std::string& request) { return frame_of(explorer, request); }

    NodeField<Grid, double> field;
    Prerolls prerolls;
    SequentialExecutor executor;
    Explorer explorer;
    double range = 0;
    Sphere sphere{{0.5, 0.5, 0.4}, 0.37};
    std::string along_sphere = "&sphere=0.5,0.5,0.4,0.37";
};

/// Calls law(both) for the grids of a family, with a wave on each.
template <class Family, class Law>
void for_each_explored(const Law& law) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, 2 * Family::steps);
        NodalSamples wave{"a wave", {}, true};
        for (const Point& x : grid.node_positions()) {
            wave.values.push_back(std::sin(4 * x[0]) + std::cos(5 * x[1]) * x[2] - 0.6);
        }
        PageAndLibrary both(grid, wave);
        law(both);
    }
}

/// Segments of lines, as the page gets them.
Surface<2> segments_of(const Polylines& lines) {
    Surface<2> segments;
    segments.vertices = lines.vertices;
    for (std::size_t i = 0; i < lines.count(); ++i) {
        for (std::size_t k = 1; k < lines.line(i).size(); ++k) {
            segments.simplices.push_back({lines.line(i)[k - 1], lines.line(i)[k]});
        }
    }
    return segments;
}

TYPED_TEST(FrameOptions, DrawBands) {
    for_each_explored<TypeParam>([](auto& e) {
        const double low = -0.05 * e.range;
        const double high = 0.05 * e.range;
        const std::string band = "band=" + text_of(low) + "," + text_of(high) + "&report=on";
        for (const auto& [how, indicator] :
             {std::pair{"&threshold=", "offset"}, {"&error=", "error"}}) {
            const Projection within{.threshold = 0.03 * e.range, .indicator = indicator};
            const Cuts cuts = within.indicator == "error" ? Cuts::linear : Cuts::finest;
            const auto direct = isoband<3>(e.prerolls, low, high, within, {.cuts = cuts});
            const Frame frame = e.frame(band + how + text_of(0.03 * e.range));
            expect_part(frame, "band", direct.surface);
            EXPECT_EQ(frame.number("area", "band"), surface_report(direct.surface).area);
        }
        // A number of triangles is that of both its sides.
        const Frame few = e.frame(band + "&triangles=300");
        const Frame all = e.frame(band);
        EXPECT_GT(all.number("triangles"), 0);
        EXPECT_LE(
            few.number("triangles"),
            std::max(300.0, e.frame(band + "&threshold=" + text_of(e.range)).number("triangles")));
    });
}

TYPED_TEST(FrameOptions, AreThoseOfProjections) {
    for_each_explored<TypeParam>([](auto& e) {
        const std::string threshold = "&threshold=" + text_of(0.05 * e.range);
        const auto expect_drawn = [&](const std::string& asked, Projection projection,
                                      IsosurfaceOptions options = {.cuts = Cuts::finest}) {
            if (!projection.threshold) projection.threshold = 0.05 * e.range;
            const auto direct = isosurface<3>(e.prerolls, 0.0, projection, options);
            expect_part(e.frame("isovalue=0" + threshold + asked), "isosurface", direct.surface);
        };
        expect_drawn("&blend=3", {.blend = 3});
        const RegionRequest region{Box{{0.1, 0.2, 0.3}, {0.6, 0.7, 0.8}}, 0.01 * e.range};
        expect_drawn("&box=0.1,0.6,0.2,0.7,0.3,0.8&box_threshold=" + text_of(region.threshold),
                     {.region = region});
        expect_drawn("&at_nodes=on", {}, {.cuts = Cuts::finest, .at_nodes = true});
        expect_drawn("&cuts=linear", {}, {.cuts = Cuts::linear});
    });
}

TYPED_TEST(FrameOptions, KeepDistancesThereAndBack) {
    for_each_explored<TypeParam>([](auto& e) {
        for (const double distance : {0.03, 0.06, 0.12}) {
            const auto direct =
                isosurface<3>(e.prerolls, 0.0,
                              {.threshold = distance, .indicator = "slope", .keeps_distance = true},
                              {.cuts = Cuts::finest});
            const Frame frame =
                e.frame("isovalue=0&distance_field=on&measure=on&distance=" + text_of(distance));
            expect_part(frame, "isosurface", direct.surface);
            EXPECT_LE(frame.number("measured_distance"), distance);
            EXPECT_LE(frame.number("measured_back"), distance);
        }
    });
}

TYPED_TEST(FrameOptions, TellMeasuredErrors) {
    for_each_explored<TypeParam>([](auto& e) {
        const std::string asked = "isovalue=0&measure=on&threshold=" + text_of(0.05 * e.range);
        const auto drawn =
            isosurface<3>(e.prerolls, 0.0, {.threshold = 0.05 * e.range}, {.cuts = Cuts::finest});
        const MeasuredError measured = measure_error(e.prerolls, drawn.surface, 0.0, 50000);
        const Frame frame = e.frame(asked);
        EXPECT_GT(measured.value.greatest, 0);
        EXPECT_EQ(frame.number("measured_error"), measured.value.greatest);
        EXPECT_EQ(frame.number("measured_distance"), measured.distance.greatest);
        EXPECT_EQ(frame.number("measured_back"), measured.back.greatest);
        const std::string moving = e.frame(asked + "&motion=moving").text();
        EXPECT_EQ(moving.find("measured_error"), std::string::npos);
    });
}

TYPED_TEST(FrameOptions, ColourSlicesAndDrawLinesOnThem) {
    for_each_explored<TypeParam>([](auto& e) {
        const double tolerance = 0.01 * e.range;
        const Projection within{.threshold = 0.05 * e.range, .colour_tolerance = tolerance};
        const auto direct = slice(e.prerolls, e.sphere, within);
        const std::array values{0.0, -0.05 * e.range, 0.1 * e.range};
        const std::string asked = "threshold=" + text_of(0.05 * e.range) + e.along_sphere +
                                  "&lines=" + text_of(values[0]) + "," + text_of(values[1]) + "," +
                                  text_of(values[2]);
        const Frame frame = e.frame(asked + "&colour_tolerance=" + text_of(tolerance));
        expect_part(frame, "slice", direct.surface);
        const Polylines lines = isolines(direct.surface, 0, values);
        EXPECT_GT(lines.count(), 0U);
        expect_part(frame, "isolines", segments_of(lines));
        // Colours wait until nothing moves.
        const auto plain = slice(e.prerolls, e.sphere, {.threshold = 0.05 * e.range});
        expect_part(e.frame(asked + "&motion=moving&colour_tolerance=" + text_of(tolerance)),
                    "slice", plain.surface);
    });
}

TYPED_TEST(FrameOptions, TakeTrianglesOfSlicesAway) {
    for_each_explored<TypeParam>([](auto& e) {
        const double error = 0.1 * e.range;
        const std::string asked = "error=" + text_of(error) + "&collapse=on" + e.along_sphere;
        const auto direct = slice(
            e.prerolls, e.sphere,
            {.threshold = error, .indicator = "error", .collapse = true, .slice_distance = 0.02});
        const Frame frame = e.frame(asked + "&slice_distance=0.02");
        expect_part(frame, "slice", direct.surface);
        const auto before = slice(e.prerolls, e.sphere);
        EXPECT_LT(frame.number("triangles"), double(before.surface.simplices.size()));
    });
}

}  // namespace
