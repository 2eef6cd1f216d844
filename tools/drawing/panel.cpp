// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <vtkAppendPolyData.h>
#include <vtkPointData.h>
#include <vtkPolyDataNormals.h>

#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/outlines.hpp>
#include <nestgrid/detail/geometry.hpp>

#include "output/surface_file.hpp"

using nestgrid::dot;
using nestgrid::operator*;
using nestgrid::operator-;

namespace {

/// Whether the surface lies in a plane across the z axis.
bool is_level(const nestgrid::Surface<3>& surface) {
    return std::ranges::all_of(surface.vertices, [&](const nestgrid::Point& x) {
        return x[2] == surface.vertices.front()[2];
    });
}

/// Looks across a flat surface, or, where it is closed to a solid, onto the cut. What is flat has
/// no shades, so that its colours are those of the legend.
void set_view(Panel& panel, const DrawingRequest& request, const nestgrid::Surface<3>& surface) {
    const nestgrid::Point normal = request.flat ? request.normal : nestgrid::Point{0, 0, 1};
    const bool flat = request.flat ||
                      (request.function == nullptr && !request.has_isovalue() && is_level(surface));
    panel.lit = !flat || request.cap;
    if (request.has_isovalue() || !flat) return;
    if (!request.cap) {
        // A plane across y is looked at from the front, where x runs to the right.
        const bool across_y = normal[0] == 0 && normal[1] > 0 && normal[2] == 0;
        panel.view = seen_from(across_y ? -1 * normal : normal);
        return;
    }
    const double side = dot(panel.view.from, normal);
    if (side > 0) panel.view.from = panel.view.from - 2 * side / dot(normal, normal) * normal;
}

/// Gives a surface the normals that its shades need, unless it has some and no cap, around which no
/// vertex has one normal. It has an edge where triangles meet at more than 40 degrees.
vtkSmartPointer<vtkPolyData> shaded(vtkPolyData* surface, bool capped) {
    if (surface->GetPointData()->GetNormals() != nullptr && !capped) return surface;
    const vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(surface);
    normals->SetFeatureAngle(40);
    normals->ConsistencyOff();
    normals->Update();
    return normals->GetOutput();
}

/// The number and the level of the element of each triangle, as cell data.
template <int dimension>
void add_elements(const nestgrid::Surface<dimension>& surface, vtkPolyData* data) {
    const vtkNew<vtkIntArray> element;
    const vtkNew<vtkIntArray> level;
    element->SetName("element");
    level->SetName("level");
    for (const std::uint32_t e : surface.element_of) {
        element->InsertNextValue(static_cast<int>(e));
        level->InsertNextValue(surface.level_of[e]);
    }
    data->GetCellData()->AddArray(element);
    data->GetCellData()->AddArray(level);
}

/// The isovalue of each triangle, as cell data of the name that lines have for theirs.
void add_value(double isovalue, vtkPolyData* data) {
    const vtkNew<vtkDoubleArray> values;
    values->SetName("value");
    values->SetNumberOfValues(data->GetNumberOfCells());
    values->FillValue(isovalue);
    data->GetCellData()->AddArray(values);
}

/// A surface on its own arrays, but for normals, which are of single precision.
/// \param colours the name of its attribute
template <int dimension>
vtkSmartPointer<vtkPolyData> borrowed(nestgrid::Surface<dimension>& surface,
                                      const std::string& colours, bool elements) {
    vtkSmartPointer<vtkPolyData> data = nestgrid::share_poly_data(surface);
    vtkPointData* const points = data->GetPointData();
    if (vtkDataArray* const attribute = points->GetArray("attributes")) {
        attribute->SetName(colours.c_str());
    }
    if (vtkDataArray* const normals = points->GetNormals()) {
        const vtkNew<vtkFloatArray> single;
        single->DeepCopy(normals);
        points->SetNormals(single);
    }
    if (elements) add_elements(surface, data);
    return data;
}

/// Words with a number behind them.
std::string with_number(const std::string& words, const char* format, double number) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), format, number);
    return words + text.data();
}

/// Which field is drawn, and at which value, of which part, with which threshold, and when. A
/// threshold is left out where a lens decides alone.
std::string caption(const Drawn& d, const DrawnField& field, const DrawingRequest& request) {
    std::vector<std::string> parts;
    if (!request.in_one_colour()) {
        parts.push_back(short_name(field.name));
        if (request.has_isovalue()) {
            parts.back() += request.has_two_surfaces() ? " and the surface " : " where ";
            parts.back() += with_number(short_name(field.input_name) + " = ", "%.4g",
                                        request.isovalues.front());
        }
    }
    if (d.isovalue) parts.push_back(with_number("isovalue ", "%.10g", *d.isovalue));
    if (d.label) parts.push_back(with_number("label ", "%.10g", *d.label));
    if (std::isfinite(d.threshold)) parts.push_back(with_number("threshold ", "%.4g", d.threshold));
    if (d.time) parts.push_back(with_number("time ", "%.4g", *d.time));
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
    const bool in_plane = field.dimension == 2 && request.in_one_colour();
    text += "\n" + std::to_string(d.report.triangles + d.isosurface_report.triangles) +
            (in_plane ? " segments" : " triangles");
    if (request.in_one_colour() && !in_plane) {
        text += ", " + std::to_string(d.report.open_edges) + " open edges";
    }
    return text;
}

}  // namespace

Panel make_panel(Drawn& d, const DrawnField& field, const DrawingRequest& request, bool elements) {
    const auto data = [&](auto& surface) { return borrowed(surface, field.name, elements); };
    Panel panel{.surface = data(d.result.surface), .caption = caption(d, field, request)};
    panel.capped = request.cap && panel.surface->GetPointData()->GetNormals() != nullptr;
    if (request.in_one_colour()) {
        if (field.dimension == 3) return panel;
        panel.surface = data(d.segments);
        panel.view = seen_from({0, 0, 1});
        return panel;
    }
    if (!d.isosurface.simplices.empty()) panel.veil = data(d.isosurface);
    panel.colour = {field.name, {field.least, field.greatest}, field.values};
    if (!field.values.empty()) {
        panel.lines = nestgrid::make_poly_data(d.isolines, {field.name});
        panel.kind = Lines::isolines;
    }
    if (request.outlines) {
        panel.lines = nestgrid::make_poly_data(nestgrid::outlines(d.result.surface), {field.name});
    }
    set_view(panel, request, d.result.surface);
    return panel;
}

void shade(Panel& panel) {
    if (panel.lit) panel.surface = shaded(panel.surface, panel.capped);
    if (panel.veil != nullptr) panel.veil = shaded(panel.veil, panel.capped);
}

vtkSmartPointer<vtkPolyData> data_of(const Panel& panel, const Drawn& d, const DrawnField& field,
                                     const DrawingRequest& request) {
    vtkSmartPointer<vtkPolyData> data = field.values.empty() ? panel.surface : panel.lines;
    if (field.values.empty() && (panel.veil != nullptr || panel.lines != nullptr)) {
        const vtkNew<vtkAppendPolyData> append;
        for (const auto& part : {panel.surface, panel.veil, panel.lines}) {
            if (part != nullptr) append->AddInputData(part);
        }
        append->Update();
        data = append->GetOutput();
    }
    std::map<std::string, double> values;
    if (request.in_one_colour() && !request.upper && !d.isovalue) {
        values[field.input_name] = request.isovalues.front();
    }
    if (d.label) values["label"] = *d.label;
    if (d.isovalue) add_value(*d.isovalue, data);
    describe(data, field.length_unit, field.space, values);
    return data;
}

vtkSmartPointer<vtkPolyData> appended(std::vector<vtkSmartPointer<vtkPolyData>> surfaces) {
    vtkSmartPointer<vtkPolyData> first = surfaces.front();
    std::erase_if(surfaces, [](vtkPolyData* each) { return each->GetNumberOfCells() == 0; });
    if (surfaces.empty()) return first;
    if (surfaces.size() == 1) return surfaces.front();
    const vtkNew<vtkAppendPolyData> append;
    for (const auto& surface : surfaces) append->AddInputData(surface);
    append->Update();
    vtkSmartPointer<vtkPolyData> all = append->GetOutput();
    all->SetFieldData(surfaces.front()->GetFieldData());
    return all;
}
