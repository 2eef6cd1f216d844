// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Curves over logarithmic axes, drawn into a PNG file for the figures of the documentation.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "picture.hpp"

struct Curve {
    std::string name;  ///< small letters, digits and . , / ( ) - =, and 2^3 for superscripts
    Colour colour{};
    std::vector<std::array<double, 2>> points{};  ///< both coordinates positive
    bool dots = true;                             ///< at the points
};

/// Draws the curves, each with its name beside its last point, under titles of the axes.
/// \throw nestgrid::IoError where the file cannot be written
void plot_logarithmic(const std::string& file, const std::string& x_title,
                      const std::string& y_title, const std::vector<Curve>& curves);
