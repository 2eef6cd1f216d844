// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "picture/layout.hpp"

/// The surfaces and lines of a panel, lit, as they are seen by a camera.
/// \param factor pixels on a side of each pixel of the layout
/// \param detail with the sides of triangles
vtkSmartPointer<vtkRenderer> make_scene(const Panel& panel, const PictureStyle& style,
                                        const ColourRange& range, const Projector& view, int factor,
                                        bool detail);

/// Whether anything in a panel lets through what is behind it.
bool is_translucent(const Panel& panel, const PictureStyle& style);
