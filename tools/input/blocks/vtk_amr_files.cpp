// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Overlapping AMR of VTK (.vthb) and data of Enzo (.hierarchy), which VTK reads in child processes.
#include <vtkAMREnzoReader.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
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
std::pair<std::vector<BlockFile::Field>, bool> fields_in(vtkOverlappingAMR& amr) {
    std::pair<std::vector<BlockFile::Field>, bool> found;
    const bool is_empty = amr.GetNumberOfLevels() == 0 || amr.GetNumberOfDataSets(0) == 0;
    vtkUniformGrid* const block = is_empty ? nullptr : amr.GetDataSet(0, 0);
    const int count = block == nullptr ? 0 : block->GetCellData()->GetNumberOfArrays();
    for (int i = 0; i < count; ++i) {
        vtkDataArray* const array = block->GetCellData()->GetArray(i);
        if (array == nullptr || array->GetName() == nullptr) continue;
        if (array->GetName() == std::string(vtkDataSetAttributes::GhostArrayName())) continue;
        found.first.push_back({array->GetName(), array->GetNumberOfComponents()});
        found.second = found.second || vtkFloatArray::SafeDownCast(array) == nullptr;
    }
    return found;
}

BlockFile open_vthb(const fs::path& path) {
    check_xml_end(path);
    const vtkSmartPointer<vtkOverlappingAMR> amr = read_quietly([&] {
        const vtkNew<vtkXMLUniformGridAMRReader> reader;
        if (reader->CanReadFile(path.c_str()) == 0) {
            throw IoError("'" + path.string() + "' is no file of VTK's overlapping AMR");
        }
        reader->SetFileName(path.c_str());
        reader->SetMaximumLevelsToReadByDefault(0);
        reader->Update();
        return vtkSmartPointer<vtkOverlappingAMR>(
            vtkOverlappingAMR::SafeDownCast(reader->GetOutputDataObject(0)));
    });
    const auto [fields, is_double] = fields_in(*amr);
    return blocks_of_vtk(*amr, fields, is_double, [amr](const std::string&) { return amr; });
}

const RegisteredFormat vthb({.name = "VTK overlapping AMR",
                             .endings = {".vthb"},
                             .holds = "boxes of cells on levels, several fields",
                             .options = {"--array", "--cells", "--component", "--read-limit"},
                             .reads_beside = true,
                             .read_field = read_blocks<open_vthb>,
                             .describe = describe_blocks<open_vthb>});

/// Values stay in the units of the file.
BlockFile open_enzo(const fs::path& path) {
    const vtkNew<vtkAMREnzoReader> reader;
    reader->SetConvertToCGS(0);
    return blocks_of_vtk(*reader, path);
}

const RegisteredFormat enzo({.name = "Enzo",
                             .endings = {".hierarchy"},
                             .holds = "boxes of cells on levels, several fields",
                             .options = {"--array", "--cells", "--read-limit"},
                             .reads_beside = true,
                             .read_field = read_blocks<open_enzo>,
                             .describe = describe_blocks<open_enzo>});

}  // namespace
