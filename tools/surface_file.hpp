// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <nestgrid/algorithms/surface.hpp>

/// Points, triangles or segments, normals where there are some, and per triangle the number of its
/// element in the order of extraction and its level.
template <int dimension, class Element>
vtkSmartPointer<vtkPolyData> make_poly_data(const nestgrid::Surface<dimension, Element>& surface) {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(static_cast<vtkIdType>(surface.vertices.size()));
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        points->SetPoint(static_cast<vtkIdType>(v), surface.vertices[v].data());
    }
    const vtkNew<vtkCellArray> simplices;
    const vtkNew<vtkIntArray> element;
    const vtkNew<vtkIntArray> level;
    element->SetName("element");
    level->SetName("level");
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        simplices->InsertNextCell(dimension);
        for (const std::uint32_t v : surface.simplices[t]) simplices->InsertCellPoint(v);
        element->InsertNextValue(static_cast<int>(surface.element_of[t]));
        level->InsertNextValue(surface.level_of[surface.element_of[t]]);
    }
    data->SetPoints(points);
    if (dimension == 3) {
        data->SetPolys(simplices);
    } else {
        data->SetLines(simplices);
    }
    data->GetCellData()->AddArray(element);
    data->GetCellData()->AddArray(level);
    if (!surface.normals.empty()) {
        const vtkNew<vtkFloatArray> normals;
        normals->SetName("Normals");
        normals->SetNumberOfComponents(3);
        for (const nestgrid::Point& n : surface.normals) normals->InsertNextTuple(n.data());
        data->GetPointData()->SetNormals(normals);
    }
    return data;
}

/// Throws nestgrid::IoError where the format of the name is unknown or its folder cannot be
/// written, so that this is known before any work is done.
void check_output(const std::filesystem::path& path);

/// The same for a file of any format.
void check_writable(const std::filesystem::path& path);

/// Writes .vtp, .ply, .stl, .obj or .gltf. The file appears complete, by rename, or not at all.
/// \throw nestgrid::IoError
void write_surface(vtkPolyData* surface, const std::filesystem::path& path);

/// A name in the same folder and of the same format that nobody uses.
std::filesystem::path temporary_beside(const std::filesystem::path& path);
