// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files that VTK's readers take to an overlapping AMR. For child processes.
#pragma once

#include <vtkCellData.h>
#include <vtkDataObject.h>
#include <vtkOverlappingAMR.h>
#include <vtkSmartPointer.h>

#include "input/blocks/block_file.hpp"

/// Calls read(), which any reader of VTK may leave with complaints: some print them only.
/// \throw nestgrid::InvalidInput with the first error or warning, where there was one
vtkSmartPointer<vtkDataObject> read_quietly(
    const std::function<vtkSmartPointer<vtkDataObject>()>& read);

/// The same of one type.
/// \throw nestgrid::InvalidInput also where there is nothing of it
template <class Data, class Read>
vtkSmartPointer<Data> read_quietly(const Read& read) {
    const vtkSmartPointer<vtkDataObject> data = read_quietly(read);
    vtkSmartPointer<Data> result = Data::SafeDownCast(data);
    if (result == nullptr) {
        const std::string given = data == nullptr ? "nothing" : data->GetClassName();
        throw nestgrid::InvalidInput("it holds " + given + ", not " +
                                     vtkSmartPointer<Data>::New()->GetClassName());
    }
    return result;
}

/// The fields of cells, and whether one of them is no float.
std::pair<std::vector<BlockFile::Field>, bool> fields_in(vtkCellData& cells);

/// The boxes of blocks that VTK has read, and the numbers of their fields. Cells that are blanked
/// have none.
/// \throw nestgrid::InvalidInput as vtk_blocks(), and where a level has no data
BlockFile blocks_of_vtk(const vtkSmartPointer<vtkOverlappingAMR>& amr,
                        std::vector<BlockFile::Field> fields, bool is_double);
