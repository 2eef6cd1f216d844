// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of a live grid of dimension 3 at the head of a VTK pipeline.
#pragma once

#include <algorithm>

#include <vtkImplicitFunction.h>
#include <vtkPlane.h>

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/drawing.hpp>

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
/// oriented towards where the function is negative. At threshold 0 it needs no indicator. The names
/// of SetGrid() are those of components 0 ...
class SliceSource : public GridSource {
public:
    using Superclass = GridSource;
    static SliceSource* New() { VTK_STANDARD_NEW_BODY(SliceSource); }

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
    /// Closes the slice along the boundary of the domain, around where the function is positive.
    void SetCap(bool on) { set(options_.cap, on); }
    bool GetCap() const { return options_.cap; }
    /// Whether cells tell where in their element each of their corners lies ("reference").
    void SetReference(bool on) { set(options_.reference, on); }
    bool GetReference() const { return options_.reference; }

    vtkMTimeType GetMTime() override {
        const vtkMTimeType own = Superclass::GetMTime();
        return function_ == nullptr ? own : std::max(own, function_->GetMTime());
    }

protected:
    SliceSource() = default;
    const char* GetClassNameInternal() const override { return "SliceSource"; }

    /// What draw(function, work) makes of the function whose zero is the slice. Functions of VTK
    /// are called by one thread.
    template <class Draw>
    auto with_function(const Work& work, const Draw& draw) const {
        if (function_ == nullptr) return draw(Plane(origin_, normal_), work);
        auto* const plane = vtkPlane::SafeDownCast(function_);
        if (plane == nullptr || plane->GetTransform() != nullptr) {
            return draw(ImplicitLevelFunction(*function_), Work{});
        }
        Point origin;
        Point normal;
        plane->GetOrigin(origin.data());
        plane->GetNormal(normal.data());
        return draw(Plane(origin, normal), work);
    }

    vtkSmartPointer<vtkPolyData> draw(Prerolls& prerolls, const Work& work) override {
        return with_function(work, [&](const LevelFunction& function, const Work& how) {
            return make_poly_data(slice(prerolls, function, projection(), options_, how).surface,
                                  names());
        });
    }

private:
    Point origin_{0, 0, 0};
    Point normal_{0, 0, 1};
    vtkSmartPointer<vtkImplicitFunction> function_;
    IsosurfaceOptions options_;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
