// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Overlapping AMR of VTK (.vthb), which VTK reads in child processes.
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkUniformGrid.h>
#include <vtkXMLUniformGridAMRReader.h>

#include "input/blocks/read_blocks.hpp"
#include "input/blocks/vtk_blocks.hpp"
#include "input/end_checks.hpp"

namespace {

using nestgrid::IoError;
namespace fs = std::filesystem;

/// The fields of the first block, and whether one of them is no float.
std::pair<std::vector<BlockFile::Field>, bool> fields_of_block(vtkOverlappingAMR& amr) {
    const bool is_empty = amr.GetNumberOfLevels() == 0 || amr.GetNumberOfDataSets(0) == 0;
    vtkUniformGrid* const block = is_empty ? nullptr : amr.GetDataSet(0, 0);
    if (block == nullptr) return {};
    return fields_in(*block->GetCellData());
}

BlockFile open_vthb(const fs::path& path) {
    check_xml_end(path);
    const vtkSmartPointer<vtkOverlappingAMR> amr = read_quietly<vtkOverlappingAMR>([&] {
        const vtkNew<vtkXMLUniformGridAMRReader> reader;
        if (reader->CanReadFile(path.c_str()) == 0) {
            throw IoError("'" + path.string() + "' is no file of VTK's overlapping AMR");
        }
        reader->SetFileName(path.c_str());
        reader->SetMaximumLevelsToReadByDefault(0);
        reader->Update();
        return vtkSmartPointer<vtkDataObject>(reader->GetOutputDataObject(0));
    });
    const auto [fields, is_double] = fields_of_block(*amr);
    return blocks_of_vtk(amr, fields, is_double);
}

const RegisteredFormat vthb({.name = "VTK overlapping AMR",
                             .endings = {".vthb"},
                             .holds = "boxes of cells on levels, several fields",
                             .options = {"--array", "--cells", "--component", "--read-limit"},
                             .reads_beside = true,
                             .read_field = read_blocks<open_vthb>,
                             .describe = describe_blocks<open_vthb>});

}  // namespace
