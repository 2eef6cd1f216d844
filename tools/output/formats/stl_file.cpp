// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Stereolithography (.stl), binary, by VTK.
#include <vtkSTLWriter.h>

#include "formats.hpp"
#include "output/formats/vtk_writing.hpp"

namespace {

std::string write_stl(vtkPolyData* surface, const std::filesystem::path& path,
                      const SurfaceEncoding& /*no choice*/) {
    const vtkNew<vtkSTLWriter> writer;
    writer->SetInputData(surface);
    writer->SetFileTypeToBinary();
    return written_by(writer.Get(), path);
}

const RegisteredFormat stl({.name = "STL",
                            .endings = {".stl"},
                            .holds = "triangles",
                            .single_precision = true,
                            .write_surface = write_stl});

}  // namespace
