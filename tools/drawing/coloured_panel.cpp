// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/coloured_panel.hpp"

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
void set_view(Panel& panel, const ColouredSurface& what, const nestgrid::Surface<3>& surface) {
    const nestgrid::Point normal = what.flat ? what.normal : nestgrid::Point{0, 0, 1};
    const bool flat =
        what.flat || (what.function == nullptr && !what.isovalue && is_level(surface));
    panel.lit = !flat || what.cap;
    if (what.isovalue || !flat) return;
    if (!what.cap) {
        // A plane across y is looked at from the front, where x runs to the right.
        const bool across_y = normal[0] == 0 && normal[1] > 0 && normal[2] == 0;
        panel.view = seen_from(across_y ? -1 * normal : normal);
        return;
    }
    const double side = dot(panel.view.from, normal);
    if (side > 0) panel.view.from = panel.view.from - 2 * side / dot(normal, normal) * normal;
}

/// Gives a surface the normals that its shades need, unless it has some. It has an edge where
/// triangles meet at more than 40 degrees.
vtkSmartPointer<vtkPolyData> shaded(vtkPolyData* surface) {
    if (surface->GetPointData()->GetNormals() != nullptr) return surface;
    const vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(surface);
    normals->SetFeatureAngle(40);
    normals->ConsistencyOff();
    normals->Update();
    return normals->GetOutput();
}

/// "threshold 0.1", or nothing where a lens decides alone; and the time, where there is one.
std::string drawn_at(const Drawn& d) {
    std::array<char, 80> text{};
    std::string result;
    if (std::isfinite(d.threshold)) {
        std::snprintf(text.data(), text.size(), ", threshold %.4g", d.threshold);
        result += text.data();
    }
    if (d.time) {
        std::snprintf(text.data(), text.size(), ", time %.4g", *d.time);
        result += text.data();
    }
    return result;
}

std::string caption(const Drawn& d, const DrawnField& field, const ColouredSurface& what) {
    std::array<char, 200> text{};
    const std::string name = short_name(field.name);
    const std::size_t triangles = d.report.triangles + d.isosurface_report.triangles;
    if (what.isovalue) {
        const bool alone = what.function == nullptr;
        std::snprintf(text.data(), text.size(), "%s %s %s = %.4g%s\n%zu triangles", name.c_str(),
                      alone ? "where" : "and the surface", short_name(field.input_name).c_str(),
                      *what.isovalue, drawn_at(d).c_str(), triangles);
    } else {
        std::snprintf(text.data(), text.size(), "%s%s\n%zu triangles", name.c_str(),
                      drawn_at(d).c_str(), triangles);
    }
    return text.data();
}

}  // namespace

Panel make_panel(const Drawn& d, const DrawnField& field, const ColouredSurface& what) {
    const auto data_of = [&](const nestgrid::Surface<3>& surface) {
        return nestgrid::make_poly_data(surface, {field.name});
    };
    Panel panel{.surface = data_of(d.slice.surface), .caption = caption(d, field, what)};
    if (!d.isosurface.simplices.empty()) panel.veil = data_of(d.isosurface);
    panel.colour = {field.name, {field.least, field.greatest}, field.values};
    if (!field.values.empty()) {
        panel.lines = make_poly_data(d.isolines, {field.name});
        panel.kind = Lines::isolines;
    }
    if (what.outlines) {
        panel.lines = nestgrid::make_poly_data(nestgrid::outlines(d.slice.surface), {field.name});
    }
    set_view(panel, what, d.slice.surface);
    return panel;
}

void shade(Panel& panel) {
    if (panel.lit) panel.surface = shaded(panel.surface);
    if (panel.veil != nullptr) panel.veil = shaded(panel.veil);
}

vtkSmartPointer<vtkPolyData> data_of(const Panel& panel, bool lines_alone) {
    if (lines_alone) return panel.lines;
    const vtkNew<vtkAppendPolyData> append;
    for (const auto& part : {panel.surface, panel.veil, panel.lines}) {
        if (part != nullptr) append->AddInputData(part);
    }
    append->Update();
    return append->GetOutput();
}
