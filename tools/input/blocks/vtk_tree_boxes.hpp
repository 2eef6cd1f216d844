// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hyper tree grids of VTK as boxes of cells. Their trees are the cells of level 0, and parts of a
// tree that are divided everywhere alike are boxes of finer levels.
#pragma once

#include <array>

#include <vtkDataArray.h>
#include <vtkHyperTreeGrid.h>
#include <vtkSmartPointer.h>

#include "input/blocks/block_file.hpp"

/// A grid, its boxes, and for each cell of them its number in the arrays of the grid, -1 where it
/// is hidden or has no tree.
struct TreeBoxes {
    vtkSmartPointer<vtkHyperTreeGrid> grid;
    int dimension;
    nestgrid::Blocks<3> blocks;
    std::vector<std::vector<std::vector<vtkIdType>>> cells;  // by level and box, x fastest
};

/// The coordinates of the trees along the three directions; null where there are none.
std::array<vtkDataArray*, 3> coordinates_of(vtkHyperTreeGrid& grid);
/// \throw nestgrid::InvalidInput where its mask or its ghost array is too short
void require_masks(vtkHyperTreeGrid& grid);
/// Whether all trees are as long in each direction.
bool trees_have_one_size(vtkHyperTreeGrid& grid);

/// \param grid of trees of one size that are divided by two, in space or in a plane of constant z
/// \throw nestgrid::InvalidInput where its mask or its ghost array is too short
TreeBoxes tree_boxes(vtkSmartPointer<vtkHyperTreeGrid> grid);
