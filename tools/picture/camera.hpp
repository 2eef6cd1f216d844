// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From where a picture is looked at, and where on it a point is drawn. Needs no display.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include <vtkCamera.h>

#include <nestgrid/detail/geometry.hpp>

/// A place on a picture, in pixels from its lower left corner.
using Pixel = std::array<double, 2>;

/// A rectangle on a picture, in pixels.
struct Box {
    double x = 0, y = 0, width = 0, height = 0;

    Pixel centre() const { return {x + width / 2, y + height / 2}; }
    bool holds(const Box& other) const {
        return x <= other.x && other.x + other.width <= x + width && y <= other.y &&
               other.y + other.height <= y + height;
    }
    bool meets(const Box& other) const {
        return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
               other.y < y + height;
    }
};

/// From where surfaces are looked at.
struct Viewpoint {
    nestgrid::Point from{1.1, 1.5, 0.7};  ///< the direction, or a position
    nestgrid::Point up{0, 0, 1};
    /// What the camera at the position `from` looks at; empty: it looks at the whole surface.
    std::optional<nestgrid::Point> focus{};
};

/// The view from a direction; upwards is z, or y where that would be along it.
Viewpoint seen_from(const nestgrid::Point& direction);

/// The view of a text: front, back, left, right, top, bottom; azimuth and elevation in degrees,
/// "az,el"; or a position, a focus and the direction upwards, "x,y,z,x,y,z,x,y,z".
/// \throw nestgrid::InvalidInput for a text that is none
Viewpoint parse_view(const std::string& text);

/// Where points are drawn in a cell of a picture.
/// Invariant: right, up and towards are orthonormal; towards points to the viewer.
struct Projector {
    nestgrid::Point right{1, 0, 0};
    nestgrid::Point up{0, 1, 0};
    nestgrid::Point towards{0, 0, 1};
    nestgrid::Point focus{};
    double pixels_per_unit = 1;                                 ///< at the focus
    double distance = std::numeric_limits<double>::infinity();  ///< of the eye; infinite: parallel
    Box cell{};                                                 ///< of this camera alone
    Pixel centre{};                                             ///< where the focus is drawn

    Pixel at(const nestgrid::Point& x) const;
    /// The point moved towards the eye by so many pixels of the focus. It is drawn where it was.
    nestgrid::Point nearer(const nestgrid::Point& x, double pixels) const;
    /// The camera of a renderer whose viewport is the cell. Its clipping range is left to VTK.
    void set(vtkCamera* camera) const;
};

/// Looks at points so that they fill `inside`, or as the viewpoint has its focus.
/// \param cell the rectangle of the camera, around `inside`
Projector fit(std::span<const nestgrid::Point> points, const Viewpoint& view, bool perspective,
              const Box& cell, const Box& inside);
