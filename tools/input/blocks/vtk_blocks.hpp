// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files that VTK's readers take to an overlapping AMR. For child processes.
#pragma once

#include <vtkAMRBaseReader.h>
#include <vtkOverlappingAMR.h>
#include <vtkSmartPointer.h>

#include "input/blocks/block_file.hpp"

/// Reads the blocks of a file, with the numbers of a field at least; without a name with none.
using ReadAmr = std::function<vtkSmartPointer<vtkOverlappingAMR>(const std::string& field)>;

/// Calls read(), which any reader of VTK may leave with complaints: some print them only.
/// \throw nestgrid::InvalidInput with the first error or warning, where there was one
vtkSmartPointer<vtkOverlappingAMR> read_quietly(
    const std::function<vtkSmartPointer<vtkOverlappingAMR>()>& read);

/// The boxes of blocks that VTK has read, and the numbers of their fields. Cells that are blanked
/// have none.
/// \throw nestgrid::InvalidInput as vtk_blocks(), and where a level has no data
BlockFile blocks_of_vtk(vtkOverlappingAMR& amr, std::vector<BlockFile::Field> fields,
                        bool is_double, const ReadAmr& read);

/// The same for a reader that knows its fields by name, as Enzo's and FLASH's.
BlockFile blocks_of_vtk(vtkAMRBaseReader& reader, const std::filesystem::path& path);
