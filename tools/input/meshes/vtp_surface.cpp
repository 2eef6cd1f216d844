// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces in VTK poly data, read by VTK.
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLPolyDataReader.h>

#include "formats.hpp"
#include "input/end_checks.hpp"
#include "input/meshes/mesh_file.hpp"
#include "input/vtk_errors.hpp"

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;
using nestgrid::Point;
namespace fs = std::filesystem;

/// The triangles of a VTK file; polygons and strips are divided.
nestgrid::CoarseGrid read_vtp(const fs::path& path, const WantedMesh& /*wanted*/) {
    const std::string name = "'" + path.string() + "'";
    const vtkNew<vtkXMLPolyDataReader> reader;
    const vtkNew<ErrorCollector> errors;
    reader->AddObserver(vtkCommand::ErrorEvent, errors);
    reader->AddObserver(vtkCommand::WarningEvent, errors);
    if (reader->CanReadFile(path.c_str()) == 0) throw IoError(name + " is no VTK poly data file");
    check_xml_end(path);
    reader->SetFileName(path.c_str());
    const vtkNew<vtkTriangleFilter> filter;
    filter->SetInputConnection(reader->GetOutputPort());
    filter->PassVertsOff();
    filter->PassLinesOff();
    filter->Update();
    if (!errors->message.empty()) throw IoError(name + " cannot be read: " + errors->message);
    vtkPolyData* const surface = filter->GetOutput();
    nestgrid::CoarseGrid grid;
    grid.dimension = 2;
    std::vector<Point> points(static_cast<std::size_t>(surface->GetNumberOfPoints()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        surface->GetPoint(static_cast<vtkIdType>(i), points[i].data());
    }
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    vtkCellArray* const cells = surface->GetPolys();
    for (cells->InitTraversal(); cells->GetNextCell(count, corners) != 0;) {
        std::vector<std::uint32_t> loop;
        for (vtkIdType i = 0; i < count; ++i) {
            if (corners[i] < 0 || corners[i] >= surface->GetNumberOfPoints()) {
                throw InvalidInput(name + " has a face that names a point which is not there");
            }
            loop.push_back(static_cast<std::uint32_t>(corners[i]));
        }
        grid.add_loop(loop);
    }
    grid.nodes = nestgrid::Coordinates(std::move(points));
    return grid;
}

const RegisteredFormat vtp_mesh({.name = "VTK poly data",
                                 .endings = {".vtp"},
                                 .read_mesh = read_vtp});

}  // namespace
