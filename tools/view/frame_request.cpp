// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_request.hpp"

#include <algorithm>
#include <cmath>

#include <nestgrid/error.hpp>

#include "request_entries.hpp"

namespace nestgrid::view {

namespace {

constexpr const char* known_keys =
    "isovalue, band, axis, at, plane, sphere, boundary, lines, threshold, triangles, error, "
    "position_error, distance, distance_field, collapse, slice_distance, cap, motion, indicator, "
    "blend, lens, finest, coarsest, slope, box, box_threshold, time, normals, at_nodes, cuts, "
    "colour_tolerance, outlines, report and measure";

constexpr std::size_t most_isovalues = 20;
constexpr std::size_t most_lines = 50;

std::string names_of(const std::vector<const IndicatorKind*>& kinds) {
    std::string names;
    for (const IndicatorKind* const kind : kinds) {
        names += (names.empty() ? "" : ", ") + std::string(kind->name);
    }
    return names;
}

Point point_at(const std::vector<double>& numbers, std::size_t first) {
    return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

Ball ball_of(std::string_view key, std::string_view text) {
    const std::vector<double> n = numbers_of(key, text, 4);
    if (n[3] < 0) refuse(key, "a ball with a negative radius", text);
    return {point_at(n, 0), n[3]};
}

void take_plane(Entries& entries, FrameRequest& request) {
    const bool plane = entries.take("plane", [&](auto key, auto text) {
        const std::vector<double> n = numbers_of(key, text, 6);
        request.plane = {point_at(n, 0), point_at(n, 3)};
        const Point& normal = request.plane->normal;
        if (normal == Point{0, 0, 0}) refuse(key, "a plane with the normal 0", text);
    });
    std::size_t d = 0;
    const bool axis = entries.take("axis", [&](auto key, auto text) {
        d = choice_of<std::size_t, 3>(key, text, {{{"x", 0}, {"y", 1}, {"z", 2}}});
    });
    double at = 0;
    const bool placed = entries.take("at", [&](auto key, auto text) { at = number_of(key, text); });
    if (axis != placed || (axis && plane)) {
        throw InvalidInput("a slice needs axis and at, or plane alone");
    }
    if (!axis) return;
    request.plane.emplace();
    request.plane->through[d] = at;
    request.plane->normal[d] = 1;
}

double positive_number(std::string_view key, std::string_view text) {
    const double number = number_of(key, text);
    if (!(number > 0)) refuse(key, "not positive", text);
    return number;
}

void take_detail(Entries& entries, FrameRequest& request) {
    int held = 0;
    held += entries.take("threshold", [&](auto key, auto text) {
        request.threshold = number_at_least_0(key, text);
    });
    held += entries.take("triangles", [&](auto key, auto text) {
        const double number = number_of(key, text);
        if (number != std::floor(number) || number < 1 || number > 1e9) {
            refuse(key, "no count from 1 to 1000000000", text);
        }
        request.triangles = static_cast<std::uint64_t>(number);
    });
    held += entries.take("error",
                         [&](auto key, auto text) { request.error = positive_number(key, text); });
    held += entries.take(
        "distance", [&](auto key, auto text) { request.distance = positive_number(key, text); });
    if (held > 1) {
        throw InvalidInput(
            "the request has several of threshold, triangles, error and distance: leave out all "
            "but one");
    }
    entries.take("position_error",
                 [&](auto key, auto text) { request.position_error = positive_number(key, text); });
}

bool is_on(std::string_view key, std::string_view text) {
    return choice_of<bool, 2>(key, text, {{{"on", true}, {"off", false}}});
}

void take_further(Entries& entries, FrameRequest& request) {
    entries.take("band", [&](auto key, auto value) {
        const std::vector<double> n = numbers_of(key, value, 2);
        if (!(n[0] < n[1])) refuse(key, "no lower value and a greater one", value);
        request.band = {n[0], n[1]};
    });
    entries.take("lines", [&](auto key, auto value) {
        request.lines = number_list_of(key, value, most_lines);
    });
    entries.take("distance_field",
                 [&](auto key, auto value) { request.distance_field = is_on(key, value); });
    entries.take("slice_distance", [&](auto key, auto value) {
        request.slice_distance = positive_number(key, value);
    });
    entries.take("blend", [&](auto key, auto value) {
        request.blend = number_of(key, value);
        if (!(request.blend >= 1)) refuse(key, "below 1", value);
    });
    const bool box = entries.take("box", [&](auto key, auto value) {
        const std::vector<double> n = numbers_of(key, value, 6);
        if (n[0] > n[1] || n[2] > n[3] || n[4] > n[5]) {
            refuse(key, "a box whose end is before its beginning", value);
        }
        request.region.emplace();
        request.region->distance = Box{{n[0], n[2], n[4]}, {n[1], n[3], n[5]}};
    });
    double inside = 0;
    const bool given = entries.take(
        "box_threshold", [&](auto key, auto value) { inside = number_at_least_0(key, value); });
    if (given && !box) throw InvalidInput("box_threshold needs a box");
    if (box) request.region->threshold = inside;
    entries.take("at_nodes", [&](auto key, auto value) { request.at_nodes = is_on(key, value); });
    entries.take("cuts", [&](auto key, auto value) {
        request.cut_edges =
            choice_of<Cuts, 2>(key, value, {{{"linear", Cuts::linear}, {"finest", Cuts::finest}}});
    });
    entries.take("colour_tolerance", [&](auto key, auto value) {
        request.colour_tolerance = positive_number(key, value);
    });
    entries.take("measure", [&](auto key, auto value) { request.measure = is_on(key, value); });
}

void check_further(const FrameRequest& request) {
    const bool surface = !request.isovalues.empty();
    if (request.measure && !surface) {
        throw InvalidInput("errors are measured of isosurfaces: give isovalue");
    }
    if (request.distance_field && !(request.distance > 0)) {
        throw InvalidInput("distance_field keeps a distance: give one");
    }
    if (request.region && (request.blend != 1 || request.collapse)) {
        throw InvalidInput("a box is for nodes that jump and edges that stay: leave out " +
                           std::string(request.collapse ? "collapse" : "blend"));
    }
    const bool sliced = request.plane || request.sphere;
    if (request.slice_distance > 0 && (!request.collapse || !sliced)) {
        throw InvalidInput(
            "slice_distance is for slices that are collapsed: give collapse and one");
    }
    if (!request.cuts() && (request.colour_tolerance > 0 || !request.lines.empty())) {
        throw InvalidInput("lines and colour_tolerance are for slices and boundaries: give one");
    }
    if (request.colour_tolerance > 0 && (request.triangles > 0 || request.collapse)) {
        throw InvalidInput(
            "colours that follow the data take triangles: leave out triangles, collapse or "
            "colour_tolerance");
    }
}

/// What does not go together with an error or a distance.
void check_detail(const FrameRequest& request, bool names_indicator) {
    const bool by_surface = request.error > 0 || request.distance > 0;
    if (by_surface && names_indicator) {
        throw InvalidInput("an error and a distance have indicators of their own: leave it out");
    }
    const bool surface = !request.isovalues.empty();
    if (request.distance > 0 && !surface) {
        throw InvalidInput("a distance is that of an isosurface: give isovalue");
    }
    if (request.cap && !surface) {
        throw InvalidInput("a cap closes an isosurface: give isovalue");
    }
    if (request.report && !request.surfaces()) {
        throw InvalidInput("a report is that of isosurfaces: give isovalue");
    }
    check_further(request);
    if (!request.collapse) return;
    if (request.at_nodes) {
        throw InvalidInput("vertices at nodes stay: leave out at_nodes or collapse");
    }
    if (request.cap) throw InvalidInput("caps are not collapsed: leave out cap or collapse");
    const bool along_slice = request.slice_distance > 0;
    if (!(request.error > 0) || (!surface && !along_slice)) {
        throw InvalidInput("collapse needs the error of an isosurface that is to be kept");
    }
    if (request.outlines) {
        throw InvalidInput("triangles that are collapsed have no outlines of elements");
    }
}

void take_lens(Entries& entries, FrameRequest& request) {
    LensRequest lens;
    const bool ball =
        entries.take("lens", [&](auto key, auto text) { lens.distance = ball_of(key, text); });
    bool sized = false;
    for (const auto& [key, number] : {std::pair{"finest", &lens.finest},
                                      {"coarsest", &lens.coarsest},
                                      {"slope", &lens.slope}}) {
        sized |= entries.take(
            key, [to = number](auto name, auto text) { *to = number_at_least_0(name, text); });
    }
    if (sized && !ball) throw InvalidInput("finest, coarsest and slope need a lens");
    if (lens.coarsest < lens.finest) throw InvalidInput("coarsest is below finest");
    if (ball) request.lens = lens;
}

}  // namespace

std::vector<const IndicatorKind*> page_indicators() {
    std::vector<const IndicatorKind*> kinds;
    for (const IndicatorKind& kind : indicators()) {
        if (!kind.needs && !kind.of_level_sets) kinds.push_back(&kind);
    }
    return kinds;
}

FrameRequest parse_request(std::string_view text) {
    Entries entries(text);
    FrameRequest request;
    entries.take("isovalue", [&](auto key, auto value) {
        request.isovalues = number_list_of(key, value, most_isovalues);
    });
    take_plane(entries, request);
    entries.take("sphere", [&](auto key, auto value) {
        request.sphere = ball_of(key, value);
        if (!(request.sphere->radius > 0)) refuse(key, "a sphere without a radius", value);
    });
    entries.take("boundary", [&](auto key, auto value) { request.boundary = is_on(key, value); });
    take_detail(entries, request);
    take_lens(entries, request);
    take_further(entries, request);
    entries.take("motion", [&](auto key, auto value) {
        request.moving = choice_of<bool, 2>(key, value, {{{"moving", true}, {"settled", false}}});
    });
    const bool names_indicator = entries.take("indicator", [&](auto key, auto value) {
        const auto kinds = page_indicators();
        const auto named = [&](const IndicatorKind* kind) { return kind->name == value; };
        if (std::ranges::none_of(kinds, named)) {
            refuse(key, "none of " + names_of(kinds), value);
        }
        request.indicator = value;
    });
    entries.take("time", [&](auto key, auto value) { request.time = number_of(key, value); });
    entries.take("normals", [&](auto key, auto value) {
        request.normals = choice_of<NormalType, 3>(key, value,
                                                   {{{"none", NormalType::none},
                                                     {"int8", NormalType::int8},
                                                     {"float32", NormalType::float32}}});
    });
    entries.take("outlines", [&](auto key, auto value) { request.outlines = is_on(key, value); });
    entries.take("report", [&](auto key, auto value) { request.report = is_on(key, value); });
    entries.take("cap", [&](auto key, auto value) { request.cap = is_on(key, value); });
    entries.take("collapse", [&](auto key, auto value) { request.collapse = is_on(key, value); });
    entries.require_empty(known_keys);
    if (!request.surfaces() && !request.cuts()) {
        throw InvalidInput(
            "nothing is to be drawn: give isovalue, band, plane, axis and at, sphere, or "
            "boundary");
    }
    check_detail(request, names_indicator);
    return request;
}

}  // namespace nestgrid::view
