// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What explains a picture: colours, lengths, coordinates, directions.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "picture/picture.hpp"
#include "picture/sheet.hpp"

/// Round numbers (1, 2 or 5 times a power of ten) within a range, and their distance.
struct Ticks {
    std::vector<double> values;
    double step = 0;

    /// A value with the digits that tell it from its neighbours.
    std::string text(double value) const;
};

/// \param most so many values at most, at least 2
Ticks make_ticks(double least, double greatest, int most);

/// The width that the colours of a picture and their numbers take.
double legend_width(const ColourBy& colour, const ColourRange& range, double font, double height);

/// Colours from below upwards, the numbers beside them, and the name of the array.
/// \param place as wide as legend_width()
void draw_legend(Sheet& sheet, const ColourBy& colour, const ColourMap& map,
                 const ColourRange& range, double font, const Box& place);

/// A round length with its unit, in the lower left corner of a place.
void draw_scale_bar(Sheet& sheet, const Projector& view, const std::string& unit, double font,
                    const Box& place);

/// The directions of x, y and z, in the lower right corner of a place.
void draw_orientation(Sheet& sheet, const Projector& view, double font, const Box& place);

/// The ends of the edges along which draw_axes() draws coordinates, for fit().
std::vector<nestgrid::Point> axis_ends(const Viewpoint& view, const std::array<double, 6>& bounds);

/// Coordinates along edges of a box that nothing in it hides.
/// \param bounds least and greatest x, y, z
void draw_axes(Sheet& sheet, const Projector& view, const std::array<double, 6>& bounds,
               double font);
