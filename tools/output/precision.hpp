// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkPolyData.h>

/// What becomes of the points of a surface in numbers of single precision.
struct SinglePrecision {
    double moved = 0;          ///< the greatest distance that a point moves
    double shortest_edge = 0;  ///< of its cells, as long as they are; infinite without cells

    /// Whether no point moves by more than a thousandth of the shortest edge.
    bool suffices() const { return 1000 * moved <= shortest_edge; }
};

SinglePrecision single_precision(vtkPolyData* surface);
