// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include <vtkColorTransferFunction.h>
#include <vtkSmartPointer.h>

/// Red, green and blue, from 0 to 1.
using Colour = std::array<double, 3>;

/// The part `share` of b in the rest of a.
Colour mixed(const Colour& a, const Colour& b, double share);

/// A colour map by its name, and whether it runs backwards.
struct ColourMap {
    std::string name = "viridis";
    bool reversed = false;
};

/// The names of all colour maps, for help and for sentences: "viridis, plasma, ...".
std::string colour_map_names();

/// The map of a name; "_r" behind the name reverses it.
/// \throw nestgrid::InvalidInput for a name that is none
ColourMap parse_colour_map(const std::string& text);

/// The colours of values between a least and a greatest one. Values beyond have the colours of the
/// ends.
vtkSmartPointer<vtkColorTransferFunction> make_colours(const ColourMap& map, double least,
                                                       double greatest);
