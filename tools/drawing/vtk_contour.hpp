// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/volume.hpp"
#include "output/report.hpp"

/// Adds the table "vtk": VTK's own contour of the same samples (vtkFlyingEdges3D, without normals),
/// for comparison.
void report_contour(const Volume& volume, double isovalue, Report& report);
