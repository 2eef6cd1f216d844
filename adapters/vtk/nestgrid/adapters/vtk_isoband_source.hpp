// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bands between two isovalues of a live grid at the head of a VTK pipeline.
#pragma once

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/drawing.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// The surface around low <= U < high of component 0 of a field of dimension 3, both level sets
/// oriented away from the band. The names of SetGrid() are those of components 1 ...
class IsobandSource : public GridSource {
public:
    using Superclass = GridSource;
    static IsobandSource* New() { VTK_STANDARD_NEW_BODY(IsobandSource); }

    void SetLow(double low) { set(low_, low); }
    double GetLow() const { return low_; }
    void SetHigh(double high) { set(high_, high); }
    double GetHigh() const { return high_; }
    void SetNormals(bool on) { set(options_.normals, on); }
    bool GetNormals() const { return options_.normals; }

protected:
    IsobandSource() = default;
    const char* GetClassNameInternal() const override { return "IsobandSource"; }

    vtkSmartPointer<vtkPolyData> draw(Prerolls& prerolls, const Work& work) override {
        return make_poly_data(
            isoband<3>(prerolls, low_, high_, projection(), options_, work).surface, names());
    }

private:
    double low_ = 0;
    double high_ = 1;
    IsosurfaceOptions options_;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
