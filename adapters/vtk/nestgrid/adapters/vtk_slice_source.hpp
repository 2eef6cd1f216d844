// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of a live grid of dimension 3 at the head of a VTK pipeline.
#pragma once

#include <algorithm>

#include <vtkImplicitFunction.h>
#include <vtkPlane.h>

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid {

/// One of VTK's implicit functions. Its variation is not known: all elements are searched.
class ImplicitLevelFunction final : public LevelFunction {
public:
    /// \param function borrowed; used by one thread at a time
    explicit ImplicitLevelFunction(vtkImplicitFunction& function) : function_{&function} {}
    double value(const Point& x) const override { return function_->FunctionValue(x.data()); }

private:
    vtkImplicitFunction* function_;
};

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// The slice along the plane through an origin across a normal, or where a function of VTK is 0;
/// oriented towards where the function is negative. At threshold 0 it needs no indicator.
/// The threshold is not used beside a maximum number of triangles.
class SliceSource : public GridSource {
public:
    using Superclass = GridSource;
    static SliceSource* New() { VTK_STANDARD_NEW_BODY(SliceSource); }

    /// Both must outlive the source.
    /// \param names of components 0 ... of the field, as point data
    template <class Grid, class Field>
    void SetGrid(const Grid& grid, const Field& field, std::vector<std::string> names = {}) {
        static_assert(Grid::dimension == 3, "slices need a grid of dimension 3");
        set_grid(grid, field, [this, names](const auto& hierarchy, const auto& indicator) {
            return make_poly_data(this->draw(hierarchy, indicator).surface, names);
        });
    }

    /// A point on the plane; not used beside a function.
    void SetOrigin(double x, double y, double z) { set(origin_, {x, y, z}); }
    const Point& GetOrigin() const { return origin_; }
    /// Across the plane, of any length but 0; not used beside a function.
    void SetNormal(double x, double y, double z) { set(normal_, {x, y, z}); }
    const Point& GetNormal() const { return normal_; }
    /// The slice follows the function, a vtkPlane, say, when it changes; null: the plane again.
    void SetCutFunction(vtkImplicitFunction* function) {
        set(function_, vtkSmartPointer<vtkImplicitFunction>(function));
    }
    vtkImplicitFunction* GetCutFunction() const { return function_; }
    /// The least threshold that keeps within so many triangles is found; 0 asks for none.
    void SetMaxTriangles(std::uint64_t count) { set(options_.max_triangles, count); }
    std::uint64_t GetMaxTriangles() const { return options_.max_triangles; }
    /// Closes the slice along the boundary of the domain, around where the function is positive.
    void SetCap(bool on) { set(options_.cap, on); }
    bool GetCap() const { return options_.cap; }

    vtkMTimeType GetMTime() override {
        const vtkMTimeType own = Superclass::GetMTime();
        return function_ == nullptr ? own : std::max(own, function_->GetMTime());
    }

protected:
    SliceSource() = default;
    const char* GetClassNameInternal() const override { return "SliceSource"; }

private:
    template <class Hierarchy, class Indicator>
    Slice draw(const Hierarchy& hierarchy, const Indicator& indicator) const {
        if (function_ == nullptr) return draw(hierarchy, indicator, Plane(origin_, normal_));
        auto* const plane = vtkPlane::SafeDownCast(function_);
        if (plane == nullptr || plane->GetTransform() != nullptr) {
            return draw(hierarchy, indicator, ImplicitLevelFunction(*function_));
        }
        Point origin;
        Point normal;
        plane->GetOrigin(origin.data());
        plane->GetNormal(normal.data());
        return draw(hierarchy, indicator, Plane(origin, normal));
    }
    template <class Hierarchy, class Indicator>
    Slice draw(const Hierarchy& hierarchy, const Indicator& indicator,
               const LevelFunction& function) const {
        IsosurfaceOptions options = options_;
        options.threshold = GetThreshold();
        if (options.threshold == 0 && options.max_triangles == 0) {
            return slice(hierarchy, function, options);
        }
        return slice(hierarchy, function, indicator(), options);
    }

    Point origin_{0, 0, 0};
    Point normal_{0, 0, 1};
    vtkSmartPointer<vtkImplicitFunction> function_;
    IsosurfaceOptions options_;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
