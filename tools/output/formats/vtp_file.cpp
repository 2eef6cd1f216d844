// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK poly data (.vtp), packed with LZ4 and not coded as text, which takes a thirtieth of the time
// of VTK's defaults. Points are of single precision where that suffices.
#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkXMLPolyDataWriter.h>

#include "formats.hpp"
#include "output/formats/vtk_writing.hpp"
#include "output/precision.hpp"

namespace {

/// The same surface with points and numbers of corners that take less room.
vtkSmartPointer<vtkPolyData> in_short(vtkPolyData* surface, bool doubles) {
    auto result = vtkSmartPointer<vtkPolyData>::New();
    result->ShallowCopy(surface);
    if (!doubles && single_keeps_shape(surface)) {
        const vtkNew<vtkPoints> points;
        points->SetDataTypeToFloat();
        points->DeepCopy(surface->GetPoints());
        result->SetPoints(points);
    }
    const auto shortened = [](vtkCellArray* cells) -> vtkSmartPointer<vtkCellArray> {
        if (!cells->IsStorage64Bit()) return cells;
        const vtkNew<vtkCellArray> copy;
        copy->DeepCopy(cells);
        copy->ConvertTo32BitStorage();
        return vtkSmartPointer<vtkCellArray>(copy);
    };
    if (surface->GetNumberOfPolys() > 0) result->SetPolys(shortened(surface->GetPolys()));
    if (surface->GetNumberOfLines() > 0) result->SetLines(shortened(surface->GetLines()));
    return result;
}

std::string write_vtp(vtkPolyData* surface, const std::filesystem::path& path,
                      const SurfaceEncoding& encoding) {
    const vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(in_short(surface, encoding.doubles));
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    switch (encoding.compression) {
        case SurfaceEncoding::Compression::lz4:
            writer->SetCompressorTypeToLZ4();
            break;
        case SurfaceEncoding::Compression::zlib:
            writer->SetCompressorTypeToZLib();
            break;
        case SurfaceEncoding::Compression::none:
            writer->SetCompressorTypeToNone();
    }
    writer->SetHeaderTypeToUInt64();
    writer->SetBlockSize(std::size_t{1} << 20U);  // blocks of 32 KB, as by default, take longer
    return written_by(writer.Get(), path);
}

const RegisteredFormat vtp({.name = "VTK poly data",
                            .endings = {".vtp"},
                            .holds = "triangles, lines, normals and values",
                            .keeps_elements = true,
                            .compresses = true,
                            .has_doubles = true,
                            .write_surface = write_vtp});

}  // namespace
