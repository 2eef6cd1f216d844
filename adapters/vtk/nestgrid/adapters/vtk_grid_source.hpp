// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The base of all sources that draw a live grid at the head of a VTK pipeline: says how finely,
// keeps the indicators, and tells the pipeline when the grid has changed.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyDataAlgorithm.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/frame_weights.hpp>
#include <nestgrid/algorithms/frames.hpp>
#include <nestgrid/algorithms/prerolls.hpp>
#include <nestgrid/algorithms/watch.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// A source without input. Its indicators are made on the first update that needs them, and again
/// when the grid says by its epoch that it has changed; where values change on the same grid, call
/// InvalidateField(). Failures are reported as errors of the algorithm, with an empty output. Long
/// work tells its progress, and ends with an empty output where an observer of that calls
/// SetAbortExecute(1).
class GridSource : public vtkPolyDataAlgorithm {
public:
    using Superclass = vtkPolyDataAlgorithm;

    /// Both must outlive the source.
    /// \param names of the components of the field that points carry
    template <class Grid, class Field>
    void SetGrid(const Grid& grid, const Field& field, std::vector<std::string> names = {}) {
        names_ = std::move(names);
        frames_ = {};
        prerolls_.reset();
        make_prerolls_ = [&grid, &field] {
            return std::make_shared<Prerolls>(FieldOnGrid(grid, field));
        };
        epoch_ = [&grid] { return epoch(grid); };
        Modified();
    }

    /// Draws frames at the time that the pipeline asks for, or at the first; between two of them,
    /// the field is interpolated. The pipeline is told their times.
    /// \throw InvalidInput where there is no frame
    void SetFrames(const Frames& frames, std::vector<std::string> names = {}) {
        if (frames.count() == 0) throw InvalidInput("there are no frames to draw");
        names_ = std::move(names);
        frames_ = frames;
        make_prerolls_ = {};
        prerolls_.reset();
        epoch_ = {};
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
        frames_.clear();
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

    int RequestInformation(vtkInformation*, vtkInformationVector**,
                           vtkInformationVector* out) override {
        using Pipeline = vtkStreamingDemandDrivenPipeline;
        vtkInformation* const told = out->GetInformationObject(0);
        if (frames_.count() > 1) {
            std::vector<double> times = frames_.times();
            told->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
            std::array<double, 2> range{times.front(), times.back()};
            told->Set(Pipeline::TIME_RANGE(), range.data(), 2);
        } else {
            told->Remove(Pipeline::TIME_STEPS());
            told->Remove(Pipeline::TIME_RANGE());
        }
        return 1;
    }

    int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* out) override {
        if (!make_prerolls_ && frames_.count() == 0) {
            vtkErrorMacro("the source has no grid");
            return 0;
        }
        try {
            const Telling telling(this);
            const SequentialExecutor alone;
            const TellingExecutor executor(executor_ == nullptr ? alone : *executor_,
                                           [&](double share) { telling.tell(share); });
            const Work work{.executor = executor, .watch = &telling};
            const auto prerolls = prerolls_at(out->GetInformationObject(0), work);
            vtkPolyData::GetData(out)->ShallowCopy(draw(*prerolls, work));
        } catch (const Aborted&) {
            vtkPolyData::GetData(out)->Initialize();
        } catch (const std::exception& error) {
            vtkErrorMacro(<< error.what());
            return 0;
        }
        return 1;
    }

private:
    struct Aborted {};

    /// Tells the source's observers ten times a second that it works, in the thread that updates
    /// it, and throws Aborted where one of them asks for that.
    class Telling final : public Watch {
    public:
        explicit Telling(GridSource* source) : source_{source} {}

        void check() const override {
            if (std::this_thread::get_id() != thread_ || ++checks_ % 256 != 1) return;
            if (std::chrono::steady_clock::now() >= next_) tell(source_->GetProgress());
        }
        void tell(double share) const {
            next_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
            source_->UpdateProgress(share);
            if (source_->GetAbortExecute() != 0) throw Aborted{};
        }

    private:
        GridSource* source_;
        std::thread::id thread_ = std::this_thread::get_id();
        mutable std::uint64_t checks_ = 0;
        mutable std::chrono::steady_clock::time_point next_{};
    };

    /// The prerolls of the grid, or of the frames at the time that is asked for.
    std::shared_ptr<Prerolls> prerolls_at(vtkInformation* out, const Work& work) {
        if (frames_.count() == 0) {
            if (prerolls_ == nullptr) prerolls_ = make_prerolls_();
            return prerolls_;
        }
        const std::vector<double>& times = frames_.times();
        double time = times.front();
        if (out->Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP()) != 0) {
            const double asked = out->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
            time = std::clamp(asked, times.front(), times.back());
        }
        vtkPolyData::GetData(out)->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
        if (times.size() > 1) frames_.prepare(projection_, work);
        if (prerolls_ == nullptr || time != drawn_time_) {
            prerolls_ = frames_.at(linear_weights(times, time));
            drawn_time_ = time;
        }
        return prerolls_;
    }

    std::function<std::shared_ptr<Prerolls>()> make_prerolls_;
    std::shared_ptr<Prerolls> prerolls_;  // of the grid, or the frames, as drawn last
    Frames frames_;                       // in the place of a grid
    double drawn_time_ = 0;               // of the frames
    std::function<std::uint64_t()> epoch_;
    std::uint64_t drawn_epoch_ = 0;
    Projection projection_;
    std::vector<std::string> names_;
    const Executor* executor_ = nullptr;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
