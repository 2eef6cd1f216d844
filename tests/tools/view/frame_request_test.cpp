// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a page may ask for, and a sentence for each request that is none.
#include <gtest/gtest.h>

#include <frame_request.hpp>

#include "refusal.hpp"

using namespace nestgrid_test;
using namespace nestgrid;
using namespace nestgrid::view;

namespace {

TEST(Requests, ThatAreMalformedAreRefusedInOneSentence) {
    const std::vector<std::array<std::string, 2>> cases{
        {"", "nothing is to be drawn"},
        {"isovalue=", "isovalue is no finite number"},
        {"isovalue=high", "isovalue is no finite number: 'high'"},
        {"isovalue=nan", "no finite number"},
        {"isovalue=inf", "no finite number"},
        {"isovalue=1e999", "no finite number"},
        {"isovalue=0x10", "no finite number"},
        {"isovalue=1,", "not 2 finite numbers"},
        {"isovalue=1,,2", "not 3 finite numbers"},
        {"isovalue=" + std::string(40, '1') + std::string(20, ','), "more than 20 numbers"},
        {"sphere=0,0,0", "not 4 finite numbers"},
        {"sphere=0,0,0,0", "a sphere without a radius"},
        {"sphere=0,0,0,-1", "a negative radius"},
        {"boundary=off", "nothing is to be drawn"},
        {"boundary=yes", "boundary is none of on, off"},
        {"boundary=on&report=on", "a report is that of isosurfaces"},
        {"isovalue= 1", "no finite number"},
        {"isovalue=1 ", "no finite number"},
        {"isovalue=1%20", "no finite number"},
        {"isovalue=1&isovalue=2", "twice"},
        {"isovalue", "key=value"},
        {"isovalue=1&&", "key=value"},
        {"isovalue=1&colour=red", "knows only"},
        {"isovalue=1&threshold=-1", "threshold is negative"},
        {"isovalue=1&threshold=a", "threshold is no finite number"},
        {"isovalue=1&triangles=0", "triangles is no count"},
        {"isovalue=1&triangles=1.5", "triangles is no count"},
        {"isovalue=1&triangles=1e10", "triangles is no count"},
        {"isovalue=1&triangles=100&threshold=1", "leave out all but one"},
        {"isovalue=1&error=0", "error is not positive"},
        {"isovalue=1&error=-1", "error is not positive"},
        {"isovalue=1&error=1%", "error is no finite number"},
        {"isovalue=1&distance=0", "distance is not positive"},
        {"isovalue=1&distance=nan", "distance is no finite number"},
        {"isovalue=1&distance=1mm", "distance is no finite number"},
        {"isovalue=1&error=1&distance=1", "leave out all but one"},
        {"isovalue=1&error=1&triangles=10", "leave out all but one"},
        {"isovalue=1&error=1&indicator=offset", "indicators of their own"},
        {"axis=x&at=1&distance=1", "that of an isosurface"},
        {"isovalue=1&collapse=on", "collapse needs the error"},
        {"isovalue=1&distance=1&collapse=on", "collapse needs the error"},
        {"axis=x&at=1&error=1&collapse=on", "collapse needs the error"},
        {"isovalue=1&error=1&collapse=yes", "collapse is none of on, off"},
        {"isovalue=1&error=1&collapse=on&outlines=on", "no outlines"},
        {"isovalue=1&error=1&collapse=on&cap=on", "caps are not collapsed"},
        {"axis=x&at=1&cap=on", "a cap closes an isosurface"},
        {"isovalue=1&cap=1", "cap is none of on, off"},
        {"isovalue=1&position_error=0", "position_error is not positive"},
        {"isovalue=1&position_error=1mm", "position_error is no finite number"},
        {"isovalue=1&motion=fast", "motion is none of moving, settled"},
        {"isovalue=1&indicator=best", "indicator is none of offset"},
        {"isovalue=1&normals=yes", "normals is none of"},
        {"isovalue=1&outlines=1", "outlines is none of"},
        {"axis=x", "axis and at"},
        {"at=1", "axis and at"},
        {"axis=w&at=1", "axis is none of x, y, z"},
        {"axis=x&at=", "at is no finite number"},
        {"axis=x&at=1&plane=0,0,0,1,0,0", "plane alone"},
        {"plane=0,0,0,1,0", "not 6 finite numbers"},
        {"plane=0,0,0,1,0,0,0", "not 6 finite numbers"},
        {"plane=0,0,0,0,0,0", "normal 0"},
        {"isovalue=1&lens=0,0,0", "not 4 finite numbers"},
        {"isovalue=1&lens=0,0,0,-1", "negative radius"},
        {"isovalue=1&slope=1", "need a lens"},
        {"isovalue=1&lens=0,0,0,1&slope=-1", "slope is negative"},
        {"isovalue=1&lens=0,0,0,1&finest=2&coarsest=1", "coarsest is below finest"},
        {"band=1", "not 2 finite numbers"},
        {"band=2,1", "band is no lower value and a greater one"},
        {"band=1,1", "band is no lower value and a greater one"},
        {"band=1,2&cap=on", "a cap closes an isosurface"},
        {"isovalue=1&lines=1", "lines and colour_tolerance are for slices"},
        {"isovalue=1&colour_tolerance=1", "lines and colour_tolerance are for slices"},
        {"boundary=on&lines=" + std::string(50, ','), "more than 50 numbers"},
        {"boundary=on&colour_tolerance=0", "colour_tolerance is not positive"},
        {"boundary=on&colour_tolerance=1&triangles=9", "leave out triangles"},
        {"isovalue=1&boundary=on&error=1&collapse=on&colour_tolerance=1", "take triangles"},
        {"isovalue=1&error=1&distance_field=on", "distance_field keeps a distance"},
        {"sphere=0,0,0,1&error=1&slice_distance=1", "slices that are collapsed"},
        {"isovalue=1&error=1&collapse=on&slice_distance=1", "slices that are collapsed"},
        {"isovalue=1&error=1&collapse=on&at_nodes=on", "vertices at nodes"},
        {"isovalue=1&blend=0.5", "blend is below 1"},
        {"isovalue=1&box=0,1,0,1,0", "not 6 finite numbers"},
        {"isovalue=1&box=0,1,1,0,0,1", "whose end is before its beginning"},
        {"isovalue=1&box_threshold=1", "box_threshold needs a box"},
        {"isovalue=1&box=0,1,0,1,0,1&blend=2", "leave out blend"},
        {"isovalue=1&error=1&collapse=on&box=0,1,0,1,0,1", "leave out collapse"},
        {"isovalue=1&at_nodes=1", "at_nodes is none of on, off"},
        {"isovalue=1&cuts=best", "cuts is none of linear, finest"},
        {"boundary=on&measure=on", "errors are measured of isosurfaces"},
        {"isovalue=1&time=now", "time is no finite number"},
        {"isovalue=" + std::string(3000, '1'), "longer than"},
        {"isovalue=\x1b[31m" + std::string(60, 'x'), "'?[31mxxx"}};
    for (const auto& [request, part] : cases) {
        const std::string sentence = refusal([&text = request] { parse_request(text); });
        EXPECT_NE(sentence.find(part), std::string::npos) << request << ": " << sentence;
        EXPECT_LT(sentence.size(), 400U) << sentence;  // with all keys
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    }
}

TEST(Requests, SayWhatTheyAskFor) {
    const FrameRequest r = parse_request(
        "isovalue=-1.5e-3&axis=y&at=2&triangles=1e5&motion=moving&indicator=numerical&"
        "lens=1,2,3,4&finest=0.1&coarsest=8&slope=2&time=3&normals=int8&outlines=on");
    EXPECT_EQ(r.isovalues, std::vector{-1.5e-3});
    EXPECT_EQ(r.plane->through, (Point{0, 2, 0}));
    EXPECT_EQ(r.plane->normal, (Point{0, 1, 0}));
    EXPECT_EQ(r.triangles, 100000U);
    EXPECT_TRUE(r.moving);
    EXPECT_EQ(r.indicator, "numerical");
    EXPECT_EQ(r.lens->distance({1, 2, 3}), 0);
    EXPECT_EQ(r.lens->distance({1, 2, 9}), 2);
    EXPECT_EQ(r.lens->finest, 0.1);
    EXPECT_EQ(r.lens->coarsest, 8);
    EXPECT_EQ(r.lens->slope, 2);
    EXPECT_EQ(r.time, 3);
    EXPECT_EQ(r.normals, NormalType::int8);
    EXPECT_TRUE(r.outlines);
    EXPECT_FALSE(r.cap);
    EXPECT_FALSE(r.boundary);
    EXPECT_EQ(parse_request("isovalue=1&distance=0.5").distance, 0.5);
    const FrameRequest several =
        parse_request("isovalue=3,1,2&sphere=1,2,3,4&boundary=on&report=on");
    EXPECT_EQ(several.isovalues, (std::vector<double>{3, 1, 2}));
    EXPECT_EQ(several.sphere->centre, (Point{1, 2, 3}));
    EXPECT_EQ(several.sphere->radius, 4);
    EXPECT_TRUE(several.boundary && several.report);
    const FrameRequest closed = parse_request("isovalue=1&error=1&cap=on&position_error=0.125");
    EXPECT_TRUE(closed.cap);
    EXPECT_EQ(closed.position_error, 0.125);
    const FrameRequest collapsed = parse_request("isovalue=1&error=0.25&collapse=on");
    EXPECT_EQ(collapsed.error, 0.25);
    EXPECT_TRUE(collapsed.collapse);
}

TEST(Requests, SayWhatElseTheyAskFor) {
    const FrameRequest r = parse_request(
        "isovalue=3&band=1,2&boundary=on&lines=4,5&distance=1&distance_field=on&box=1,2,3,4,5,6&"
        "box_threshold=0.5&at_nodes=on&cuts=finest&colour_tolerance=0.25&measure=on");
    EXPECT_EQ(*r.band, (std::array<double, 2>{1, 2}));
    EXPECT_EQ(r.level_sets(), (std::vector<double>{3, 1, 2}));
    EXPECT_EQ(r.lines, (std::vector<double>{4, 5}));
    EXPECT_TRUE(r.keeps_distance() && r.at_nodes && r.measure);
    EXPECT_EQ(r.cut_edges, Cuts::finest);
    EXPECT_EQ(r.colour_tolerance, 0.25);
    const Projection projection = r.projection("offset");
    EXPECT_EQ(projection.region->threshold, 0.5);
    EXPECT_LE(projection.region->distance({1.5, 3.5, 5.5}), 0);
    EXPECT_EQ(projection.region->distance({1.5, 3.5, 8}), 2);
    EXPECT_EQ(parse_request("isovalue=3&blend=2").projection("offset").blend, 2);
    const FrameRequest collapsed =
        parse_request("sphere=0,0,0,1&error=1&collapse=on&slice_distance=0.125");
    EXPECT_EQ(collapsed.slice_distance, 0.125);
}

}  // namespace
