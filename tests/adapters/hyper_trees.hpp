// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of VTK's hyper tree grids, for tests.
#pragma once

#include <random>

#include <vtkDoubleArray.h>
#include <vtkHyperTreeGridNonOrientedCursor.h>
#include <vtkNew.h>

namespace nestgrid_test {

/// Coordinates of n points from 0 to 1, not quite uniform.
inline vtkNew<vtkDoubleArray> coordinates(int n) {
    vtkNew<vtkDoubleArray> x;
    for (int i = 0; i < n; ++i) {
        const double t = n == 1 ? 0.0 : static_cast<double>(i) / (n - 1);
        x->InsertNextValue(t + 0.2 * t * (1 - t));
    }
    return x;
}

/// Subdivides a tree at random, and numbers its cells in the order in which they are met.
/// \param next the number of the next cell; moved on
inline void subdivide(vtkHyperTreeGridNonOrientedCursor* cursor, std::mt19937& random, int depth,
                      vtkIdType& next) {
    cursor->SetGlobalIndexFromLocal(next++);
    const bool deeper = depth > 0 && (cursor->GetLevel() == 0 || random() % 3 == 0);
    if (!deeper) return;
    cursor->SubdivideLeaf();
    for (int c = 0; c < cursor->GetNumberOfChildren(); ++c) {
        cursor->ToChild(static_cast<unsigned char>(c));
        subdivide(cursor, random, depth - 1, next);
        cursor->ToParent();
    }
}

}  // namespace nestgrid_test
