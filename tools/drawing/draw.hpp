// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What all commands that draw have in common: options in, a table, files and pictures out.
#pragma once

#include "drawing/request.hpp"

/// The options of a command that draws.
struct DrawingOptions {
    Input input;
    SurfaceOptions surface;
    LensText lens;
    TimeOptions time;
    bool outlines = false;
    bool collapses = false;
    double colour_tolerance = 0;

    /// What the options ask for.
    /// \throw nestgrid::InvalidInput, nestgrid::IoError as parse()
    DrawingRequest request() const;
};

/// Adds --outlines and --colour-tolerance.
/// \param group that the help shows them in
void add_colour_options(CLI::App& command, DrawingOptions& options,
                        const std::string& group = "Options", bool has_tolerance = true);

/// Adds --collapse, which excludes others that are there already.
void add_collapse_option(CLI::App& command, DrawingOptions& options);

/// Draws, writes, paints and reports the surface at each threshold or number of triangles, of the
/// field or at times between its frames.
/// \throw nestgrid::IoError, nestgrid::InvalidInput, nestgrid::GridError
void draw(DrawingOptions& options, const DrawingRequest& request, Report& report);
