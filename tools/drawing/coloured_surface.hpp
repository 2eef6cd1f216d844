// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <nestgrid/algorithms/slices.hpp>

#include "options/lens_options.hpp"
#include "options/time_options.hpp"

/// A surface that is coloured by the field; an isosurface without a slice by Input::by.
struct ColouredSurface {
    /// A slice of a hierarchy of dimension 3; null for the grid of one of dimension 2, or for an
    /// isosurface.
    const nestgrid::LevelFunction* function = nullptr;
    /// The isosurface with this value, without a slice, or beside it and in the same walk.
    std::optional<double> isovalue{};
    bool cap = false;          ///< with the part of the boundary where the function is positive
    double scale = 0;          ///< heights of a grid of dimension 2, in multiples of the field
    bool outlines = false;     ///< with the edges of elements
    bool flat = false;         ///< in a plane, to be looked at across it
    nestgrid::Point normal{};  ///< of that plane
    std::string empty{};       ///< the sentence that says why there are no triangles
    /// Isolines on the surface, in the place of the surface in files: their values, or their
    /// number.
    std::vector<double> values{};
    int value_count = 0;
    std::optional<LensRequest> lens{};
    /// Triangles are split until colours follow the data within this; 0 splits none.
    double colour_tolerance = 0;
    /// Whether edges are collapsed while colours keep within the thresholds. What is drawn first
    /// has half of them.
    bool collapses = false;
};

/// Adds the option for ColouredSurface::colour_tolerance.
CLI::Option* add_colour_option(CLI::App& command, double& tolerance);

/// Adds the option for ColouredSurface::collapses, which excludes others that are there already.
void add_collapse_option(CLI::App& command, bool& collapses);

/// Draws, writes, paints and prints the surface at each threshold or budget, of the field or at
/// times between its frames.
/// \throw nestgrid::IoError, nestgrid::InvalidInput, nestgrid::GridError
void draw_coloured(Input& input, SurfaceOptions& options, const ColouredSurface& what,
                   const TimeOptions& time, Report& report);
