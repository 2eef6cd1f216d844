// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/vtk_contour.hpp"

#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkNew.h>

#include <nestgrid/algorithms/surface_report.hpp>

#include "drawing/meter.hpp"

namespace {

nestgrid::Surface<3> triangles_of(vtkPolyData* contour) {
    nestgrid::Surface<3> surface;
    surface.vertices.resize(static_cast<std::size_t>(contour->GetNumberOfPoints()));
    const vtkNew<vtkIdList> corners;
    for (vtkIdType t = 0; t < contour->GetNumberOfCells(); ++t) {
        contour->GetCellPoints(t, corners);
        surface.simplices.push_back({static_cast<std::uint32_t>(corners->GetId(0)),
                                     static_cast<std::uint32_t>(corners->GetId(1)),
                                     static_cast<std::uint32_t>(corners->GetId(2))});
    }
    return surface;
}

}  // namespace

void report_contour(const Volume& volume, double isovalue, Report& report) {
    const vtkNew<vtkFlyingEdges3D> filter;
    filter->SetInputData(volume.image);
    filter->SetValue(0, isovalue);
    filter->ComputeNormalsOff();
    filter->ComputeGradientsOff();
    const Meter meter;
    filter->Update();
    const double seconds = meter.seconds();
    const nestgrid::SurfaceReport contour =
        nestgrid::surface_report(triangles_of(filter->GetOutput()));
    Row row;
    row.add("contour", "vtkFlyingEdges3D").add("triangles", contour.triangles);
    // Edges of one triangle only, those on the boundary of the volume included.
    row.add("vertices", contour.vertices).add("boundary_edges", contour.open_edges);
    row.add("nonmanifold_edges", contour.nonmanifold_edges).add("seconds", seconds);
    report.add_row("vtk", std::move(row));
}
