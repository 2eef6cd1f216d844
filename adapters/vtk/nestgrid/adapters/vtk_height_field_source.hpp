// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Height fields of a live grid of dimension 2 at the head of a VTK pipeline.
#pragma once

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/drawing.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// The grid as a conforming triangulation, lifted along z by a scale times component 0. The names
/// of SetGrid() are those of components 0 ...
class HeightFieldSource : public GridSource {
public:
    using Superclass = GridSource;
    static HeightFieldSource* New() { VTK_STANDARD_NEW_BODY(HeightFieldSource); }

    /// 0: flat, with colours.
    void SetScale(double scale) { set(scale_, scale); }
    double GetScale() const { return scale_; }

protected:
    HeightFieldSource() = default;
    const char* GetClassNameInternal() const override { return "HeightFieldSource"; }

    vtkSmartPointer<vtkPolyData> draw(Prerolls& prerolls, const Work& work) override {
        return make_poly_data(height_field(prerolls, scale_, projection(), {}, work).surface,
                              names());
    }

private:
    double scale_ = 1;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
