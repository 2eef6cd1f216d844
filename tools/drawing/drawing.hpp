// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of a field at one moment.
#pragma once

#include "drawing/moments.hpp"
#include "drawing/request.hpp"

/// Whether surfaces are drawn as finely as the grid is, without a preroll.
bool is_drawn_exactly(const DrawingRequest& request, const SurfaceOptions& options);

/// Told what is being done: a text, or nothing while a surface is drawn.
using Telling = std::function<void(const std::string& work)>;

/// Takes the surfaces of one walk: that of each isovalue, or a single one.
using TakeWalk = std::function<void(std::vector<Drawn>&& walk)>;

/// Draws the surfaces at each threshold or number of triangles.
/// \throw nestgrid::InvalidInput where the surface is none of a field of this dimension, or options
///        do not go together; and as isosurface(), slice(), shading()
/// \throw nestgrid::GridError
void draw_moment(const Moment& moment, const nestgrid::Executor& executor,
                 const SurfaceOptions& options, const DrawingRequest& request, const Telling& tell,
                 const TakeWalk& take);
