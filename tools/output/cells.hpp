// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkSmartPointer.h>

/// Calls function(corners) for each cell, with numbers of points.
template <class Function>
void for_each_cell(vtkCellArray* cells, const Function& function) {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    const auto cell = vtkSmartPointer<vtkCellArrayIterator>::Take(cells->NewIterator());
    for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell()) {
        cell->GetCurrentCell(count, corners);
        function(std::span<const vtkIdType>(corners, static_cast<std::size_t>(count)));
    }
}
