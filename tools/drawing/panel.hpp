// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drawn surfaces as data of VTK, for files and pictures.
#pragma once

#include <vector>

#include "drawing/request.hpp"
#include "picture/picture.hpp"

/// The surface with what lies on it and beside it, not yet shaded. The panel borrows its arrays.
/// \param elements whether triangles tell their elements, as cell data
Panel make_panel(Drawn& d, const DrawnField& field, const DrawingRequest& request, bool elements);

/// Adds the normals that shades need, which no file has.
void shade(Panel& panel);

/// What is written of a surface, as one data set with what is known of it: the isolines alone, or
/// all.
vtkSmartPointer<vtkPolyData> data_of(const Panel& panel, const Drawn& d, const DrawnField& field,
                                     const DrawingRequest& request);

/// Surfaces of one walk as one data set, each triangle of which tells its isovalue.
/// \param surfaces at least one; a single one is given back
vtkSmartPointer<vtkPolyData> appended(std::vector<vtkSmartPointer<vtkPolyData>> surfaces);
