// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces of a live grid at the head of a VTK pipeline: each update extracts what has changed.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyDataAlgorithm.h>

#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

namespace nestgrid {

/// A source without input. Its indicator is computed on the first update, and again when the grid
/// says by its epoch that it has changed; where values change on the same grid, call
/// InvalidateField(). Failures are reported as errors of the algorithm, with an empty output.
class IsosurfaceSource : public vtkPolyDataAlgorithm {
public:
    using Superclass = vtkPolyDataAlgorithm;
    static IsosurfaceSource* New() { VTK_STANDARD_NEW_BODY(IsosurfaceSource); }

    /// Both must outlive the source.
    /// \param attributes names of components 1 ... of the field
    template <class Grid, class Field>
    void SetGrid(const Grid& grid, const Field& field, std::vector<std::string> attributes = {}) {
        constexpr int dimension = Grid::dimension;
        auto indicator = std::make_shared<std::optional<HierarchicalIndicator>>();
        invalidate_ = [indicator] { indicator->reset(); };
        epoch_ = [&grid] { return epoch(grid); };
        extract_ = [this, &grid, &field, indicator, attributes] {
            if (!*indicator || (*indicator)->epoch() != epoch(grid)) {
                indicator->emplace(grid, field);
            }
            PolyDataSink<dimension> sink(attributes);
            extract_isosurfaces(grid, field, std::span<const double>(&isovalue_, 1),
                                std::vector{sink},
                                criterion_for(grid, field, isovalue_, **indicator, options_),
                                **indicator, options_);
            return vtkSmartPointer<vtkPolyData>(sink.data());
        };
        Modified();
    }

    void SetIsovalue(double isovalue) { set(isovalue_, isovalue); }
    double GetIsovalue() const { return isovalue_; }
    /// epsilon, in the units of the data; not used beside a maximum number of triangles.
    void SetThreshold(double threshold) { set(options_.threshold, threshold); }
    double GetThreshold() const { return options_.threshold; }
    /// The least threshold that keeps within so many triangles is found; 0 asks for none.
    void SetMaxTriangles(std::uint64_t count) { set(options_.max_triangles, count); }
    std::uint64_t GetMaxTriangles() const { return options_.max_triangles; }
    void SetNormals(bool on) { set(options_.normals, on); }
    bool GetNormals() const { return options_.normals; }

    void InvalidateField() {
        if (invalidate_) invalidate_();
        Modified();
    }

    /// A grid that has changed makes the output out of date.
    vtkMTimeType GetMTime() override {
        if (epoch_ && epoch_() != drawn_epoch_) {
            drawn_epoch_ = epoch_();
            Modified();
        }
        return Superclass::GetMTime();
    }

    IsosurfaceSource(const IsosurfaceSource&) = delete;
    void operator=(const IsosurfaceSource&) = delete;

protected:
    IsosurfaceSource() { SetNumberOfInputPorts(0); }

    const char* GetClassNameInternal() const override { return "IsosurfaceSource"; }
    int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* out) override {
        vtkPolyData* output = vtkPolyData::GetData(out);
        if (!extract_) {
            vtkErrorMacro("the source has no grid");
            return 0;
        }
        try {
            output->ShallowCopy(extract_());
        } catch (const std::exception& error) {
            vtkErrorMacro(<< error.what());
            return 0;
        }
        return 1;
    }

private:
    template <class Value>
    void set(Value& member, const Value& value) {
        if (member == value) return;
        member = value;
        Modified();
    }

    std::function<vtkSmartPointer<vtkPolyData>()> extract_;
    std::function<void()> invalidate_;
    std::function<std::uint64_t()> epoch_;
    std::uint64_t drawn_epoch_ = 0;
    double isovalue_ = 0;
    IsosurfaceOptions options_;
};

}  // namespace nestgrid
