// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isolines of a live grid of dimension 2 at the head of a VTK pipeline.
#pragma once

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/drawing.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// Isolines of component 0, joined: one cell a line, with its value in the array "value". The names
/// of SetGrid() are those of components 1 ...
class IsolinesSource : public GridSource {
public:
    using Superclass = GridSource;
    static IsolinesSource* New() { VTK_STANDARD_NEW_BODY(IsolinesSource); }

    void SetValues(const std::vector<double>& values) { set(values_, values); }
    const std::vector<double>& GetValues() const { return values_; }

protected:
    IsolinesSource() = default;
    const char* GetClassNameInternal() const override { return "IsolinesSource"; }

    vtkSmartPointer<vtkPolyData> draw(Prerolls& prerolls, const Work& work) override {
        return make_poly_data(isolines(prerolls, values_, projection(), {}, work).lines, names());
    }

private:
    std::vector<double> values_;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
