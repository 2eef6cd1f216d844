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

/// A grid, its boxes, and for each cell of them its number in the arrays of the grid.
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
/// Whether all trees are there and as long in each direction, and all cells are shown.
/// \throw nestgrid::InvalidInput as require_masks()
bool trees_fill_boxes(vtkHyperTreeGrid& grid);

/// \param grid trees_fill_boxes(), which are divided by two, in space or in a plane of constant z
TreeBoxes tree_boxes(const vtkSmartPointer<vtkHyperTreeGrid>& grid);
