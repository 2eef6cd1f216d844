// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What C codes ask for and do not get is refused in a sentence.
#include <nestgrid/algorithms/isolines.h>
#include <nestgrid/algorithms/probe.h>
#include <nestgrid/algorithms/slice.h>

#include "c_scenes.hpp"

namespace c_algorithms_test {

class RefusalsForC : public ::testing::Test {
protected:
    /// What a call says that is refused, which leaves nothing to be freed.
    template <class Call>
    std::string refusal(const Call& call) {
        message.fill('x');
        EXPECT_NE(call(message.data(), message.size()), 0);
        return message.data();
    }
    std::string isosurface_says() {
        return refusal([&](char* text, std::size_t size) {
            nestgrid_surface surface;
            const int code = nestgrid_isosurface_with(&solid.in_c.table, &solid.field, 0.2,
                                                      &options, &surface, text, size);
            EXPECT_EQ(surface.owner, nullptr);
            return code;
        });
    }
    std::string lines_say(const double* values = nullptr, std::size_t count = 0) {
        return refusal([&](char* text, std::size_t size) {
            return nestgrid_isolines(&plane.in_c.table, &plane.field, values, count, &options,
                                     &lines, text, size);
        });
    }
    std::string probe_says(const double* points, std::size_t count) {
        return refusal([&](char* text, std::size_t size) {
            return nestgrid_probe(&solid.in_c.table, &solid.field, points, count, &options, &probed,
                                  text, size);
        });
    }
    std::string slice_says(const nestgrid_level_function* function) {
        return refusal([&](char* text, std::size_t size) {
            nestgrid_surface surface;
            return nestgrid_slice_along(&solid.in_c.table, &solid.field, function, &options,
                                        &surface, text, size);
        });
    }
    void start_again() {
        options = {};
        options.size = sizeof(options);
    }
    void SetUp() override {
        start_again();
        lines.size = sizeof(lines);
        probed.size = sizeof(probed);
    }

    Scene<3> solid{kuhn<3>(0)};
    Scene<2> plane{kuhn<2>(0)};
    nestgrid_options options{};
    nestgrid_lines lines{};
    nestgrid_probed probed{};
    std::array<char, 200> message{};
};

TEST_F(RefusalsForC, OfOptionsAreSentences) {
    options.size = 3;
    EXPECT_EQ(isosurface_says(),
              "the size of the options says 3 bytes: set it to that of the struct");
    start_again();
    options.threshold = std::nan("");
    EXPECT_EQ(isosurface_says(), "the threshold is negative or not a number");
    start_again();
    options.error = -1;
    EXPECT_EQ(isosurface_says(), "the error is negative or not a number");
    options.error = options.threshold = 1;
    EXPECT_EQ(isosurface_says(), "an error and a threshold are asked for: give one of them");
    options.threshold = 0;
    options.indicator = NESTGRID_VISUAL;
    EXPECT_EQ(isosurface_says(), "an error is asked for, which has an indicator of its own");
    options.indicator = NESTGRID_OFFSET;
    options.max_triangles = 7;
    EXPECT_EQ(isosurface_says(),
              "a number of triangles is asked for beside an error or a threshold: give one of "
              "them");
    start_again();
    options.max_triangles = 1;
    EXPECT_NE(isosurface_says().find("triangles"), std::string::npos);
    start_again();
    options.indicator = NESTGRID_NORM + 1;
    EXPECT_EQ(isosurface_says(), "the indicator 9 does not exist");
    options.indicator = NESTGRID_GEOMETRY;
    EXPECT_EQ(isosurface_says(),
              "the indicator geometry is for curved grids: on this one it is 0 everywhere");
    start_again();
    options.threads = -2;
    EXPECT_EQ(isosurface_says(), "-2 threads are asked for, not -1 to 1024");
}

TEST_F(RefusalsForC, OfSeveralIsosurfacesAreSentences) {
    const std::array<double, 2> isovalues{0.2, 0.3};
    std::array<nestgrid_surface, 2> surfaces{};
    const auto says = [&](std::size_t count, const double* values, nestgrid_surface* out) {
        return refusal([&](char* text, std::size_t size) {
            return nestgrid_isosurfaces(&solid.in_c.table, &solid.field, count, values, &options,
                                        out, text, size);
        });
    };
    const std::string none = "there are no isovalues, or no surfaces for them";
    EXPECT_EQ(says(0, isovalues.data(), surfaces.data()), none);
    EXPECT_EQ(says(2, nullptr, surfaces.data()), none);
    EXPECT_EQ(says(2, isovalues.data(), nullptr), none);
    options.max_triangles = 10;
    EXPECT_NE(says(2, isovalues.data(), surfaces.data()).find("number of triangles"),
              std::string::npos);
    EXPECT_EQ(surfaces[0].owner, nullptr);
}

TEST_F(RefusalsForC, OfProjectionsAreSentences) {
    options.blend = 0.5;
    EXPECT_EQ(isosurface_says(), "blend is not a finite number of at least 1");
    start_again();
    nestgrid_lens lens{};
    options.lens = &lens;
    EXPECT_EQ(isosurface_says(), "the table of the lens is too small: its size says 0 bytes");
    lens.size = sizeof(lens);
    EXPECT_EQ(isosurface_says(), "the table of the lens lacks the function 'distance'");
    lens.distance = [](void*, const double*, double*) { return 5; };
    Scene<3> refined(forests<3>()[0]);
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  nestgrid_surface surface;
                  return nestgrid_isosurface_with(&refined.in_c.table, &refined.field, isovalue,
                                                  &options, &surface, text, size);
              }),
              "the operation 'distance' of the lens failed with code 5");
    lens.finest = -1;
    EXPECT_EQ(isosurface_says(), "a size of the lens is negative or not a number");
    lens.finest = 0;
    lens.slope = -1;
    EXPECT_EQ(isosurface_says(), "the slope of the lens is not a finite number >= 0");
    lens.slope = 0;
    options.collapse = 1;
    options.threshold = 0.1;
    EXPECT_EQ(isosurface_says(), "edges are collapsed without a lens");
    options.lens = nullptr;
    options.cap = 1;
    EXPECT_EQ(isosurface_says(), "edges of surfaces with caps are not collapsed");
    options.cap = 0;
    options.at_nodes = 1;
    EXPECT_EQ(isosurface_says(), "edges of surfaces with vertices at nodes are not collapsed");
    start_again();
    nestgrid_region region{};
    options.region = &region;
    EXPECT_EQ(isosurface_says(), "the table of the region is too small: its size says 0 bytes");
    region.size = sizeof(region);
    EXPECT_EQ(isosurface_says(), "the table of the region lacks the function 'distance'");
    region.distance = [](void*, const double*, double*) { return 5; };
    EXPECT_EQ(isosurface_says(), "the operation 'distance' of the region failed with code 5");
    region.threshold = -1;
    EXPECT_EQ(isosurface_says(), "the threshold in the region is not a number >= 0");
    start_again();
    options.colour_tolerance = -1;
    EXPECT_EQ(isosurface_says(), "the tolerance of colours is not a finite number >= 0");
    start_again();
    options.position_error = -1;
    EXPECT_EQ(isosurface_says(), "the error of positions is negative or not a finite number");
    options.position_error = 0.1;
    options.error = 0.1;
    EXPECT_EQ(isosurface_says(),
              "an error of positions is asked for, which is for curved cells that are drawn within "
              "an error");
    nestgrid_measured measured{};
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  return nestgrid_measure(nullptr, nullptr, nullptr, isovalue, 0, nullptr,
                                          &measured, text, size);
              }),
              "the measured errors are NULL, or their size is not that of the struct");
    measured.size = sizeof(measured);
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  return nestgrid_measure(nullptr, nullptr, nullptr, isovalue, 0, nullptr,
                                          &measured, text, size);
              }),
              "there is no isosurface in space to measure");
    start_again();
    options.keep_distance = 1;
    const double value = 0.2;
    EXPECT_EQ(lines_say(&value, 1), "distances are kept by isosurfaces in space only");
    start_again();
    options.collapse = 1;
    options.threshold = 0.1;
    EXPECT_EQ(lines_say(&value, 1), "edges of isolines are not collapsed");
}

TEST_F(RefusalsForC, OfAttributesAreSentences) {
    options.attribute_count = 1;
    EXPECT_EQ(isosurface_says(), "there are attributes, but the list of their tables is NULL");
    const nestgrid_field* none = nullptr;
    options.attributes = &none;
    EXPECT_EQ(isosurface_says(), "the table of an attribute is NULL");
}

TEST_F(RefusalsForC, OfLinesAreSentences) {
    const double value = 0.2;
    EXPECT_EQ(lines_say(nullptr, 2), "the values of the isolines are NULL");
    options.max_triangles = 10;
    EXPECT_EQ(lines_say(&value, 1),
              "a limit of segments is for one isoline: take nestgrid_isosurface_with");
    start_again();
    const double wrong = std::nan("");
    EXPECT_EQ(lines_say(&wrong, 1), "the isovalue is not a finite number");
    lines.size = 8;
    EXPECT_EQ(lines_say(&value, 1),
              "the size of the result says 8 bytes: set it to that of the struct");
    lines.size = sizeof(lines);
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  return nestgrid_isolines(&solid.in_c.table, &solid.field, &value, 1, nullptr,
                                           &lines, text, size);
              }),
              "the hierarchy has dimension 3, not 2");
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  return nestgrid_surface_isolines(nullptr, 0, &value, 1, &lines, text, size);
              }),
              "there is no surface of triangles to draw isolines on");
}

TEST_F(RefusalsForC, OfSlicesAreSentences) {
    EXPECT_EQ(slice_says(nullptr), "the level function is NULL");
    nestgrid_level_function function{};
    function.size = 8;
    EXPECT_EQ(slice_says(&function),
              "the table of the level function is too small: its size says 8 bytes");
    function.size = sizeof(function);
    EXPECT_EQ(slice_says(&function), "the table of the level function lacks the function 'value'");
    function.value = [](const void*, const double*, double*) { return 7; };
    EXPECT_EQ(slice_says(&function),
              "the operation 'value' of the level function failed with code 7");
    options.threshold = 0.1;
    options.indicator = NESTGRID_CUT;
    EXPECT_EQ(slice_says(&function),
              "the indicator cut is for isosurfaces and isolines with given values");
    nestgrid_surface surface;
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  return nestgrid_slice(&solid.in_c.table, &solid.field, nullptr, nullptr, nullptr,
                                        &surface, text, size);
              }),
              "the point or the normal of the plane is NULL");
}

TEST_F(RefusalsForC, OfProbesAreSentences) {
    const Point far{std::nan(""), 0, 0};
    EXPECT_EQ(probe_says(nullptr, 1), "the points are NULL");
    EXPECT_NE(probe_says(far.data(), 1).find("finite"), std::string::npos) << message.data();
    options.max_triangles = 3;
    EXPECT_EQ(probe_says(far.data(), 1),
              "a number of triangles is asked for, but a probe draws none");
}

TEST_F(RefusalsForC, OfDetailsAreSentences) {
    nestgrid_surface surface{};
    nestgrid_surface_details details{};
    const auto says = [&] {
        return refusal([&](char* text, std::size_t size) {
            return nestgrid_details(&surface, &details, text, size);
        });
    };
    EXPECT_EQ(says(), "the details are NULL, or their size is not that of the struct");
    details.size = sizeof(details);
    EXPECT_EQ(says(), "there is no surface to tell details of");
}

}  // namespace c_algorithms_test
