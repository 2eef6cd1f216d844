// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces of a live grid at the head of a VTK pipeline: each update extracts what has changed.
#pragma once

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// The isosurface of component 0. The threshold is not used beside a maximum number of triangles.
class IsosurfaceSource : public GridSource {
public:
    using Superclass = GridSource;
    static IsosurfaceSource* New() { VTK_STANDARD_NEW_BODY(IsosurfaceSource); }

    /// Both must outlive the source.
    /// \param attributes names of components 1 ... of the field
    template <class Grid, class Field>
    void SetGrid(const Grid& grid, const Field& field, std::vector<std::string> attributes = {}) {
        set_grid(grid, field, [this, attributes](const auto& hierarchy, const auto& indicator) {
            IsosurfaceOptions options = options_;
            options.threshold = GetThreshold();
            PolyDataSink<Grid::dimension> sink(attributes);
            const auto drawn = extract_isosurfaces<Grid::dimension>(
                hierarchy, std::span<const double>(&isovalue_, 1), std::vector{sink},
                criterion_for<Grid::dimension>(hierarchy, isovalue_, indicator(), options),
                indicator(), options);
            bounds_ = drawn.front();
            return vtkSmartPointer<vtkPolyData>(sink.data());
        });
    }

    void SetIsovalue(double isovalue) { set(isovalue_, isovalue); }
    double GetIsovalue() const { return isovalue_; }
    /// The least threshold that keeps within so many triangles is found; 0 asks for none.
    void SetMaxTriangles(std::uint64_t count) { set(options_.max_triangles, count); }
    std::uint64_t GetMaxTriangles() const { return options_.max_triangles; }
    void SetNormals(bool on) { set(options_.normals, on); }
    bool GetNormals() const { return options_.normals; }
    /// Closes the surface along the boundary of the domain.
    void SetCap(bool on) { set(options_.cap, on); }
    bool GetCap() const { return options_.cap; }
    /// How far the surface of the last update may be from the data.
    const ErrorBounds& GetErrorBounds() const { return bounds_; }

protected:
    IsosurfaceSource() = default;
    const char* GetClassNameInternal() const override { return "IsosurfaceSource"; }

private:
    double isovalue_ = 0;
    IsosurfaceOptions options_;
    ErrorBounds bounds_;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
