// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The boundary of the domain of a live grid at the head of a VTK pipeline.
#pragma once

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/drawing.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// The boundary of the domain of a grid of dimension 3, oriented outwards: a closed surface. The
/// names of SetGrid() are those of components 0 ...
class BoundarySource : public GridSource {
public:
    using Superclass = GridSource;
    static BoundarySource* New() { VTK_STANDARD_NEW_BODY(BoundarySource); }

protected:
    BoundarySource() = default;
    const char* GetClassNameInternal() const override { return "BoundarySource"; }

    vtkSmartPointer<vtkPolyData> draw(Prerolls& prerolls, const Work& work) override {
        return make_poly_data(boundary_surface(prerolls, projection(), {}, work).surface, names());
    }
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
