// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of surfaces, drawn by VTK.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "picture/camera.hpp"
#include "picture/colour_map.hpp"

/// The values of the first and the last colour of a map.
struct ColourRange {
    double least = 0;
    double greatest = 1;
};

/// What a surface is coloured by: a point array.
struct ColourBy {
    std::string array;  ///< empty: one colour
    ColourRange range{};
    std::vector<double> isovalues{};  ///< marked beside the colours
};

/// Lines on a surface.
enum class Lines {
    isolines,
    outlines,  ///< of elements: paler where they lie close together
};

/// Surfaces that are drawn together.
struct Panel {
    vtkSmartPointer<vtkPolyData> surface;
    std::string caption{};                 ///< above it, where there are several panels
    ColourBy colour{};                     ///< the same in all panels
    vtkSmartPointer<vtkPolyData> veil{};   ///< another surface, translucent, or null
    vtkSmartPointer<vtkPolyData> lines{};  ///< on the surface, or null
    Lines kind = Lines::outlines;
    Viewpoint view{};
    bool lit = true;      ///< the surface; a veil always is
    bool capped = false;  ///< has normals, and edges where caps begin
};

/// What the pictures of all commands have in common.
struct PictureStyle {
    int width = 0;  ///< in pixels; 0: as the number of panels asks for
    int height = 0;
    std::optional<Colour> background{{1, 1, 1}};  ///< none: transparent
    std::optional<Viewpoint> view{};              ///< in the place of the panels'
    bool perspective = false;
    ColourMap colours{};
    std::optional<ColourRange> range{};  ///< in the place of the panels'
    /// That of the veil if there is one, else of the surface; empty: the veil is translucent.
    std::optional<double> opacity{};
    std::string title{};
    bool axes = false;
    std::optional<std::string> unit{};  ///< of the scale bar
    bool orientation = false;
    bool detail = false;  ///< each panel again below, magnified and with its triangles
};

/// Draws a picture in a process of its own (virtual_display.hpp). The file appears complete, by
/// rename, or not at all.
/// \throw nestgrid::IoError
/// \throw nestgrid::InvalidInput where the panels do not fit into the size
void write_picture(const std::vector<Panel>& panels, const PictureStyle& style,
                   const std::filesystem::path& path);

/// The name of a field, cut off where it is too long for a caption.
std::string short_name(const std::string& name);
