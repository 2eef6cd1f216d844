// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <nestgrid/error.hpp>

#include "options/number_list.hpp"

using nestgrid::cross;
using nestgrid::dot;
using nestgrid::norm;
using nestgrid::Point;
using nestgrid::operator+;
using nestgrid::operator-;
using nestgrid::operator*;

namespace {

constexpr double half_angle = 15 * std::numbers::pi / 180;  ///< of a picture in perspective

Point unit(const Point& x) { return (1 / norm(x)) * x; }

/// The least and the greatest coordinate of points along a direction.
std::array<double, 2> extent(std::span<const Point> points, const Point& direction) {
    std::array<double, 2> range{INFINITY, -INFINITY};
    for (const Point& x : points) {
        const double at = dot(direction, x);
        range = {std::min(range[0], at), std::max(range[1], at)};
    }
    return range[0] <= range[1] ? range : std::array<double, 2>{0, 0};
}

/// Azimuth and elevation in degrees: 0,0 is the front, 90,0 the right, 0,90 the top.
Viewpoint seen_at(double azimuth, double elevation) {
    const double a = azimuth * std::numbers::pi / 180;
    const double e = elevation * std::numbers::pi / 180;
    const Point outwards{std::sin(a), -std::cos(a), 0};
    const Point z{0, 0, 1};
    return {std::cos(e) * outwards + std::sin(e) * z, std::cos(e) * z - std::sin(e) * outwards};
}

}  // namespace

Viewpoint seen_from(const Point& direction) {
    const bool steep = std::abs(direction[2]) > 0.9 * norm(direction);
    return {direction, steep ? Point{0, 1, 0} : Point{0, 0, 1}};
}

Viewpoint parse_view(const std::string& text) {
    if (text == "front") return seen_at(0, 0);
    if (text == "right") return seen_at(90, 0);
    if (text == "back") return seen_at(180, 0);
    if (text == "left") return seen_at(270, 0);
    if (text == "top") return seen_at(0, 90);
    if (text == "bottom") return seen_at(0, -90);
    const std::vector<double> n = numbers_of(text);
    if (n.size() == 2) return seen_at(n[0], n[1]);
    if (n.size() != 6 && n.size() != 9) {
        throw nestgrid::InvalidInput(
            "'" + text +
            "' is no view: --view takes front, back, left, right, top or bottom, two angles "
            "az,el, or a position, a focus and, if need be, the direction upwards, "
            "x,y,z,x,y,z,x,y,z");
    }
    Viewpoint view{{n[0], n[1], n[2]}, {0, 0, 1}, Point{n[3], n[4], n[5]}};
    const Point towards = view.from - *view.focus;
    if (!(norm(towards) > 0)) {
        throw nestgrid::InvalidInput("--view: the position is where the focus is");
    }
    view.up = n.size() == 9 ? Point{n[6], n[7], n[8]} : seen_from(towards).up;
    if (!(norm(cross(view.up, towards)) > 1e-9 * norm(view.up) * norm(towards))) {
        throw nestgrid::InvalidInput(
            "--view: the direction upwards is that from the focus to the position, or 0");
    }
    return view;
}

Pixel Projector::at(const Point& x) const {
    const Point d = x - focus;
    const double scale = std::isinf(distance)
                             ? pixels_per_unit
                             : pixels_per_unit * distance / (distance - dot(towards, d));
    return {centre[0] + scale * dot(right, d), centre[1] + scale * dot(up, d)};
}

Point Projector::nearer(const Point& x, double pixels) const {
    const double length = pixels / pixels_per_unit;
    if (std::isinf(distance)) return x + length * towards;
    return x + length * unit(focus + distance * towards - x);
}

void Projector::set(vtkCamera* camera) const {
    const bool parallel = std::isinf(distance);
    const double away = parallel ? cell.height / pixels_per_unit : distance;
    camera->SetFocalPoint(focus.data());
    camera->SetPosition((focus + away * towards).data());
    camera->SetViewUp(up.data());
    camera->SetParallelProjection(parallel);
    camera->SetParallelScale(cell.height / 2 / pixels_per_unit);
    camera->SetViewAngle(360 / std::numbers::pi *
                         std::atan(cell.height / 2 / (pixels_per_unit * away)));
    const Pixel middle = cell.centre();
    camera->SetWindowCenter((middle[0] - centre[0]) / (cell.width / 2),
                            (middle[1] - centre[1]) / (cell.height / 2));
}

Projector fit(std::span<const Point> points, const Viewpoint& view, bool perspective,
              const Box& cell, const Box& inside) {
    Projector p;
    p.cell = cell;
    p.centre = inside.centre();
    p.towards = unit(view.focus ? view.from - *view.focus : view.from);
    p.right = unit(cross(view.up, p.towards));
    p.up = cross(p.towards, p.right);
    // Pixels of the picture of a unit at a unit's distance.
    const double lens = inside.height / 2 / std::tan(half_angle);
    if (view.focus) {
        const double away = norm(view.from - *view.focus);
        p.focus = *view.focus;
        p.pixels_per_unit = lens / away;
        if (perspective) p.distance = away;
        return p;
    }
    const auto sideways = extent(points, p.right);
    const auto upright = extent(points, p.up);
    const auto depth = extent(points, p.towards);
    const auto middle = [](const std::array<double, 2>& range) {
        return (range[0] + range[1]) / 2;
    };
    p.focus = middle(sideways) * p.right + middle(upright) * p.up + middle(depth) * p.towards;
    if (!perspective) {
        const double size = std::max((sideways[1] - sideways[0]) / inside.width,
                                     (upright[1] - upright[0]) / inside.height);
        p.pixels_per_unit = size > 0 ? 1 / size : 1;
        return p;
    }
    double away = 0;
    for (const Point& x : points) {
        const Point d = x - p.focus;
        away = std::max({away,
                         dot(p.towards, d) + std::abs(dot(p.right, d)) * lens / (inside.width / 2),
                         dot(p.towards, d) + std::abs(dot(p.up, d)) * lens / (inside.height / 2)});
    }
    p.distance = away > 0 ? away : 1;
    p.pixels_per_unit = lens / p.distance;
    return p;
}
