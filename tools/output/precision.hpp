// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What becomes of the points of a surface in numbers of single precision.
#pragma once

#include <vtkPolyData.h>

/// The greatest distance that a point moves, and the mean length of the edges, those of no length
/// left out, which is infinite without edges.
struct SinglePrecision {
    double moved = 0;
    double mean_edge = 0;
};
SinglePrecision single_precision(vtkPolyData* surface);

/// Whether no point moves by more than a thousandth of the mean edge: slivers may lose their area.
/// Looks at as many edges as it takes to know: mostly few.
bool single_keeps_shape(vtkPolyData* surface);

/// Whether none moves by more than a thousandth of the shortest edge. Looks at all edges only where
/// that is so.
bool single_keeps_edges(vtkPolyData* surface);
