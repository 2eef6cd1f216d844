// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces of a live grid at the head of a VTK pipeline: each update extracts what has changed.
#pragma once

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/drawing.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// The isosurface of component 0 of a field of dimension 3, or its isoline in dimension 2. The
/// names of SetGrid() are those of components 1 ...
class IsosurfaceSource : public GridSource {
public:
    using Superclass = GridSource;
    static IsosurfaceSource* New() { VTK_STANDARD_NEW_BODY(IsosurfaceSource); }

    void SetIsovalue(double isovalue) { set(isovalue_, isovalue); }
    double GetIsovalue() const { return isovalue_; }
    /// A distance that the surface and that of all data keep there and back, in units of length.
    void SetDistance(double distance) {
        Projection kept = GetProjection();
        kept.threshold = distance;
        kept.indicator = "slope";
        kept.keeps_distance = true;
        SetProjection(kept);
    }
    void SetNormals(bool on) { set(options_.normals, on); }
    bool GetNormals() const { return options_.normals; }
    /// Closes the surface along the boundary of the domain.
    void SetCap(bool on) { set(options_.cap, on); }
    bool GetCap() const { return options_.cap; }
    /// Vertices lie at nodes in the place of slivers around them.
    void SetAtNodes(bool on) { set(options_.at_nodes, on); }
    bool GetAtNodes() const { return options_.at_nodes; }
    /// Edges are cut where the finest data pass through the isovalue.
    void SetFinestCuts(bool on) { set(options_.cuts, on ? Cuts::finest : Cuts::linear); }
    bool GetFinestCuts() const { return options_.cuts == Cuts::finest; }
    /// How far the surface of the last update may be from the data.
    const ErrorBounds& GetErrorBounds() const { return bounds_; }
    /// The threshold of the last update, which a number of triangles leads to.
    double GetDrawnThreshold() const { return drawn_threshold_; }

protected:
    IsosurfaceSource() = default;
    const char* GetClassNameInternal() const override { return "IsosurfaceSource"; }

    vtkSmartPointer<vtkPolyData> draw(Prerolls& prerolls, const Work& work) override {
        return prerolls.field().dimension() == 2 ? draw_in<2>(prerolls, work)
                                                 : draw_in<3>(prerolls, work);
    }

private:
    template <int dimension>
    vtkSmartPointer<vtkPolyData> draw_in(Prerolls& prerolls, const Work& work) {
        const auto drawn = isosurface<dimension>(prerolls, isovalue_, projection(), options_, work);
        bounds_ = drawn;
        drawn_threshold_ = drawn.search.threshold;
        return make_poly_data(drawn.surface, names());
    }

    double isovalue_ = 0;
    IsosurfaceOptions options_;
    ErrorBounds bounds_;
    double drawn_threshold_ = 0;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
