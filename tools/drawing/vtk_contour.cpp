// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkNew.h>

#include "drawing/extract.hpp"

Contour contour_with_vtk(const Volume& volume, double isovalue) {
    const vtkNew<vtkFlyingEdges3D> filter;
    filter->SetInputData(volume.image);
    filter->SetValue(0, isovalue);
    filter->ComputeNormalsOff();
    filter->ComputeGradientsOff();
    const double start = now();
    filter->Update();
    Contour contour;
    contour.seconds = now() - start;

    vtkPolyData* output = filter->GetOutput();
    nestgrid::Surface<3> surface;
    surface.vertices.resize(static_cast<std::size_t>(output->GetNumberOfPoints()));
    const vtkNew<vtkIdList> corners;
    for (vtkIdType t = 0; t < output->GetNumberOfCells(); ++t) {
        output->GetCellPoints(t, corners);
        surface.simplices.push_back({static_cast<std::uint32_t>(corners->GetId(0)),
                                     static_cast<std::uint32_t>(corners->GetId(1)),
                                     static_cast<std::uint32_t>(corners->GetId(2))});
    }
    const nestgrid::SurfaceReport report = nestgrid::surface_report(surface);
    contour.triangles = report.triangles;
    contour.vertices = report.vertices;
    contour.once_edges = report.open_edges;
    contour.nonmanifold_edges = report.nonmanifold_edges;
    return contour;
}
