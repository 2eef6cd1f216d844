// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkPolyData.h>

/// What becomes of the points of a surface in numbers of single precision.
struct SinglePrecision {
    double moved = 0;          ///< the greatest distance that a point moves
    double shortest_edge = 0;  ///< of its cells, as long as they are; infinite without cells
    double mean_edge = 0;      ///< the mean length of these edges

    /// Whether no point moves by more than a thousandth of the shortest edge.
    bool keeps_edges() const { return 1000 * moved <= shortest_edge; }
    /// Whether none moves by more than a thousandth of the mean edge: slivers may lose their area.
    bool keeps_shape() const { return 1000 * moved <= mean_edge; }
};

SinglePrecision single_precision(vtkPolyData* surface);
