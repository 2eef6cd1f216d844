// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Coloured surfaces as panels of a picture.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

#include "drawing/coloured_surface.hpp"
#include "picture/picture.hpp"

/// One surface and what it cost.
struct Drawn {
    std::optional<double> time;       ///< where it is between frames
    nestgrid::TriangleBudget search;  ///< of the threshold; max_triangles is 0 where none was
    double threshold = 0;
    nestgrid::Slice slice;  ///< or an isosurface without one
    nestgrid::SurfaceReport report;
    nestgrid::Surface<3> isosurface;  ///< beside a slice
    nestgrid::SurfaceReport isosurface_report;
    nestgrid::Polylines isolines;
    std::optional<nestgrid::Collapsed> collapsed;
    double seconds = 0;
};

/// All surfaces of one field.
struct DrawnField {
    std::string name;         ///< of the colours
    std::string input_name;   ///< of the field that isosurfaces are of
    std::string length_unit;  ///< empty where it is unknown
    std::string space;        ///< such as RAS; empty where it is unknown
    double least = std::numeric_limits<double>::infinity();  ///< of the colours
    double greatest = -std::numeric_limits<double>::infinity();
    double preroll_seconds = 0;
    std::vector<Drawn> surfaces;
    std::vector<double> values;  ///< of isolines
};

/// The surface with what lies on it and beside it, not yet shaded.
Panel make_panel(const Drawn& d, const DrawnField& field, const ColouredSurface& what);

/// Adds the normals that shades need, which no file has.
void shade(Panel& panel);

/// What is written of a panel, as one data set: the lines alone, or all.
vtkSmartPointer<vtkPolyData> data_of(const Panel& panel, bool lines_alone);
