// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The base of all sources that draw a live grid at the head of a VTK pipeline: keeps the indicator,
// and tells the pipeline when the grid has changed.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyDataAlgorithm.h>

#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// A source without input. Its indicator is computed on the first update that needs one, and again
/// when the grid says by its epoch that it has changed; where values change on the same grid, call
/// InvalidateField(). Failures are reported as errors of the algorithm, with an empty output.
class GridSource : public vtkPolyDataAlgorithm {
public:
    using Superclass = vtkPolyDataAlgorithm;

    /// epsilon, in the units of the data.
    void SetThreshold(double threshold) { set(threshold_, threshold); }
    double GetThreshold() const { return threshold_; }

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

    GridSource(const GridSource&) = delete;
    void operator=(const GridSource&) = delete;

protected:
    GridSource() { SetNumberOfInputPorts(0); }

    const char* GetClassNameInternal() const override { return "GridSource"; }

    /// Both must outlive the source.
    /// \param draw a function of the hierarchy, and of one without arguments that returns its
    ///        HierarchicalIndicator, which returns a smart pointer to vtkPolyData
    template <class Grid, class Field, class Draw>
    void set_grid(const Grid& grid, const Field& field, Draw draw) {
        auto indicator = std::make_shared<std::optional<HierarchicalIndicator>>();
        invalidate_ = [indicator] { indicator->reset(); };
        epoch_ = [&grid] { return epoch(grid); };
        draw_ = [&grid, &field, indicator, draw] {
            const auto hierarchy = erase(grid, field);
            return draw(hierarchy, [&]() -> const HierarchicalIndicator& {
                if (!*indicator || (*indicator)->epoch() != hierarchy.epoch()) {
                    indicator->emplace(hierarchy);
                }
                return **indicator;
            });
        };
        Modified();
    }

    /// Sets a parameter of the drawing.
    template <class Value>
    void set(Value& member, const Value& value) {
        if (member == value) return;
        member = value;
        Modified();
    }

    int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* out) override {
        if (!draw_) {
            vtkErrorMacro("the source has no grid");
            return 0;
        }
        try {
            vtkPolyData::GetData(out)->ShallowCopy(draw_());
        } catch (const std::exception& error) {
            vtkErrorMacro(<< error.what());
            return 0;
        }
        return 1;
    }

private:
    std::function<vtkSmartPointer<vtkPolyData>()> draw_;
    std::function<void()> invalidate_;
    std::function<std::uint64_t()> epoch_;
    std::uint64_t drawn_epoch_ = 0;
    double threshold_ = 0;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
