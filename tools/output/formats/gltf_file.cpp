// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// glTF (.gltf), in one file, by VTK.
#include <vtkGLTFWriter.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>

#include "formats.hpp"
#include "output/formats/vtk_writing.hpp"

namespace {

/// glTF takes a tree of blocks.
vtkSmartPointer<vtkMultiBlockDataSet> as_blocks(vtkPolyData* surface) {
    const vtkNew<vtkMultiBlockDataSet> building;
    building->SetBlock(0, surface);
    auto scene = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    scene->SetBlock(0, building);
    return scene;
}

std::string write_gltf(vtkPolyData* surface, const std::filesystem::path& path) {
    const vtkNew<vtkGLTFWriter> writer;
    writer->InlineDataOn();
    writer->SetInputData(as_blocks(surface));
    return written_by(writer.Get(), path);
}

const RegisteredFormat gltf({.name = "glTF",
                             .endings = {".gltf"},
                             .holds = "triangles and normals",
                             .single_precision = true,
                             .write_surface = write_gltf});

}  // namespace
