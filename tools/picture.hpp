// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <nestgrid/shape.hpp>

/// The colours of a surface: a point array and the range that they span, the same in all panels.
struct ColourBy {
    std::string array;  ///< empty: one colour
    double least = 0;
    double greatest = 0;
};

struct Panel {
    vtkSmartPointer<vtkPolyData> surface;
    std::string caption;
    ColourBy colour{};
    vtkSmartPointer<vtkPolyData> veil{};   ///< another surface, translucent, or null
    vtkSmartPointer<vtkPolyData> lines{};  ///< drawn over it, or null
    float line_width = 1;                  ///< in pixels
    nestgrid::Point from{1.1, 1.5, 0.7};   ///< the direction from which it is looked at
    bool lit = true;
    bool detail = true;  ///< magnified with its triangles below
};

/// The name of a field, cut off where it is too long for a picture.
std::string short_name(const std::string& name);

/// Writes a PNG with the surfaces side by side, each whole above and, where asked for, magnified
/// with its triangles below. Coloured surfaces have a scalar bar. Debian's VTK draws through an X
/// display; where none can be used, an Xvfb is started for the time of drawing. The drawing happens
/// in a process of its own, so its failure is an error.
/// \throw nestgrid::IoError
void write_picture(const std::vector<Panel>& panels, const std::filesystem::path& path);
