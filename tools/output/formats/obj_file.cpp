// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wavefront (.obj), by VTK.
#include <vtkOBJWriter.h>

#include "formats.hpp"
#include "output/formats/vtk_writing.hpp"

namespace {

std::string write_obj(vtkPolyData* surface, const std::filesystem::path& path,
                      const SurfaceEncoding& /*no choice*/) {
    const vtkNew<vtkOBJWriter> writer;
    writer->SetInputData(surface);
    return written_by(writer.Get(), path);
}

const RegisteredFormat obj({.name = "Wavefront",
                            .endings = {".obj"},
                            .holds = "triangles, lines and normals",
                            .write_surface = write_obj});

}  // namespace
