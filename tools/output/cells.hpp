// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include <vtkCellArray.h>

/// Calls function(corners) for each cell, with numbers of points of 32 or 64 bits as they are kept,
/// until it returns false. VTK's own iterator copies those of 32 bits.
/// \return whether it never did
template <class Function>
bool for_each_cell(vtkCellArray* cells, const Function& function) {
    const auto visit = [&](auto* offsets, auto* connectivity) {
        const auto* const first = offsets->GetPointer(0);
        const auto* const corners = connectivity->GetPointer(0);
        for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i) {
            const auto count = static_cast<std::size_t>(first[i + 1] - first[i]);
            if (!function(std::span(corners + first[i], count))) return false;
        }
        return true;
    };
    return cells->IsStorage64Bit()
               ? visit(cells->GetOffsetsArray64(), cells->GetConnectivityArray64())
               : visit(cells->GetOffsetsArray32(), cells->GetConnectivityArray32());
}
