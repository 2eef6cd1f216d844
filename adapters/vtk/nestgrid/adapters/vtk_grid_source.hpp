// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The base of all sources that draw a live grid at the head of a VTK pipeline: says how finely,
// keeps the indicators, and tells the pipeline when the grid has changed.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyDataAlgorithm.h>

#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/prerolls.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// A source without input. Its indicators are made on the first update that needs them, and again
/// when the grid says by its epoch that it has changed; where values change on the same grid, call
/// InvalidateField(). Failures are reported as errors of the algorithm, with an empty output.
class GridSource : public vtkPolyDataAlgorithm {
public:
    using Superclass = vtkPolyDataAlgorithm;

    /// Both must outlive the source.
    /// \param names of the components of the field that points carry
    template <class Grid, class Field>
    void SetGrid(const Grid& grid, const Field& field, std::vector<std::string> names = {}) {
        names_ = std::move(names);
        prerolls_.reset();
        make_prerolls_ = [&grid, &field] {
            return std::make_unique<Prerolls>(FieldOnGrid(grid, field));
        };
        epoch_ = [&grid] { return epoch(grid); };
        Modified();
    }

    /// epsilon, in the units of the indicator. Not used beside a maximum number of triangles.
    void SetThreshold(double threshold) { set(projection_.threshold, std::optional(threshold)); }
    double GetThreshold() const { return projection_.least_threshold(); }
    /// The least threshold that keeps within so many triangles is found; 0 asks for none.
    void SetMaxTriangles(std::uint64_t count) { set(projection_.max_triangles, count); }
    std::uint64_t GetMaxTriangles() const { return projection_.max_triangles; }
    /// What the threshold is compared with: a name of indicators(), or "error", with which the
    /// threshold is the error that is kept.
    void SetIndicator(const std::string& name) {
        set(projection_.keeps_distance, false);
        set(projection_.indicator, name);
    }
    const std::string& GetIndicator() const { return projection_.indicator; }
    /// All data differ from what is drawn by at most this, in their units.
    void SetError(double error) {
        SetIndicator("error");
        SetThreshold(error);
    }
    /// Nodes move between the threshold and this many times it (blended.hpp), at least 1.
    void SetBlend(double factor) { set(projection_.blend, factor); }
    double GetBlend() const { return projection_.blend; }
    /// Elements are small in a domain; without a threshold the lens decides alone.
    void SetLens(const LensRequest& lens) {
        projection_.lens = lens;
        Modified();
    }
    void RemoveLens() {
        projection_.lens.reset();
        Modified();
    }
    /// Edges are taken away while the error, or the distance, is kept.
    void SetCollapse(bool on) { set(projection_.collapse, on); }
    bool GetCollapse() const { return projection_.collapse; }
    /// Everything that says how finely is drawn, at once.
    void SetProjection(const Projection& projection) {
        projection_ = projection;
        Modified();
    }
    const Projection& GetProjection() const { return projection_; }
    /// Borrowed; null: the calling thread alone. The output does not depend on it.
    void SetExecutor(const Executor* executor) { executor_ = executor; }

    void InvalidateField() {
        prerolls_.reset();
        Modified();
    }

    /// A grid that has changed makes the output out of date.
    vtkMTimeType GetMTime() override {
        if (epoch_ && epoch_() != drawn_epoch_) {
            drawn_epoch_ = epoch_();
            prerolls_.reset();
            Modified();
        }
        return Superclass::GetMTime();
    }

    GridSource(const GridSource&) = delete;
    void operator=(const GridSource&) = delete;

protected:
    GridSource() { SetNumberOfInputPorts(0); }

    const char* GetClassNameInternal() const override { return "GridSource"; }

    /// Draws the field of these prerolls as projection() says.
    virtual vtkSmartPointer<vtkPolyData> draw(Prerolls& prerolls, const Work& work) = 0;

    const Projection& projection() const { return projection_; }
    const std::vector<std::string>& names() const { return names_; }

    /// Sets a parameter of the drawing.
    template <class Value>
    void set(Value& member, const Value& value) {
        if (member == value) return;
        member = value;
        Modified();
    }

    int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* out) override {
        if (!make_prerolls_) {
            vtkErrorMacro("the source has no grid");
            return 0;
        }
        try {
            if (prerolls_ == nullptr) prerolls_ = make_prerolls_();
            const Work work = executor_ == nullptr ? Work{} : Work{.executor = *executor_};
            vtkPolyData::GetData(out)->ShallowCopy(draw(*prerolls_, work));
        } catch (const std::exception& error) {
            vtkErrorMacro(<< error.what());
            return 0;
        }
        return 1;
    }

private:
    std::function<std::unique_ptr<Prerolls>()> make_prerolls_;
    std::unique_ptr<Prerolls> prerolls_;  // of the grid as it was drawn last
    std::function<std::uint64_t()> epoch_;
    std::uint64_t drawn_epoch_ = 0;
    Projection projection_;
    std::vector<std::string> names_;
    const Executor* executor_ = nullptr;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
