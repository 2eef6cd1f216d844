// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data that jump between the elements of a live grid, at the head of a VTK pipeline.
#pragma once

#include <functional>
#include <optional>

#include <nestgrid/adapters/vtk_slice_source.hpp>
#include <nestgrid/algorithms/discontinuous.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// Elements that are drawn alone, each with its own values: the slice of a grid of dimension 3, or
/// a grid of dimension 2, lifted along z. Of what says how finely, a threshold, which is an error
/// that is kept, and a number of triangles are taken; the rest is an error of the algorithm.
class DiscontinuousSource final : public SliceSource {
public:
    using Superclass = SliceSource;
    static DiscontinuousSource* New() { VTK_STANDARD_NEW_BODY(DiscontinuousSource); }

    /// All must outlive the source.
    /// \param values with leaf_values(), or callable with a leaf, as of DiscontinuousData
    /// \param names of the components that points carry
    template <class Grid, class Values>
    void SetGrid(const Grid& grid, const Values& values, std::vector<std::string> names = {}) {
        static constexpr ZeroField<Grid> zero;
        Superclass::SetGrid(grid, zero, std::move(names));
        make_data_ = [&grid, &values] { return DiscontinuousData(grid, values); };
        epoch_ = [&grid] { return epoch(grid); };
        data_.reset();
    }
    void SetFrames(const Frames&, std::vector<std::string> = {}) = delete;
    void SetCap(bool) = delete;
    void SetReference(bool) = delete;

    /// Heights over a grid of dimension 2 are this times component 0; 0: flat, with colours.
    void SetScale(double scale) { set(scale_, scale); }
    double GetScale() const { return scale_; }

    void InvalidateField() {
        data_.reset();
        Superclass::InvalidateField();
    }
    /// How far component 0, as it was drawn last, may be from the data.
    const ErrorBounds& GetErrorBounds() const { return bounds_; }

protected:
    DiscontinuousSource() = default;
    const char* GetClassNameInternal() const override { return "DiscontinuousSource"; }

    vtkSmartPointer<vtkPolyData> draw(Prerolls&, const Work& work) override {
        DiscontinuousOptions options{.threshold = projection().least_threshold(),
                                     .max_triangles = projection().max_triangles};
        require_no_more();
        if (!data_ || epoch_() != data_epoch_) {
            data_.emplace(make_data_());
            data_epoch_ = epoch_();
            deviations_.reset();
        }
        if (work.watch != nullptr) {
            options.progress = [&](const TraversalCounts&) {
                work.watch->check();
                return true;
            };
        }
        if (options.threshold > 0 || options.max_triangles > 0) {
            if (!deviations_) deviations_.emplace(*data_);
            options.deviations = &*deviations_;
        }
        const DiscontinuousSurface drawn =
            data_->grid().facts().dimension == 2
                ? height_field(*data_, scale_, options, work.executor)
                : with_function(work, [&](const LevelFunction& function, const Work& how) {
                      return slice(*data_, function, options, how.executor);
                  });
        bounds_ = drawn;
        return make_poly_data(drawn.surface, names());
    }

private:
    void require_no_more() const {
        const Projection& p = projection();
        const bool by_error = p.indicator == "offset" || p.indicator == "error";
        if (by_error && p.blend == 1 && !p.lens && !p.region && !p.collapse && !p.criterion &&
            p.slice_distance == 0 && p.colour_tolerance == 0 && p.position_error == 0) {
            return;
        }
        throw InvalidInput(
            "data that jump are drawn within a threshold or a number of triangles alone");
    }

    std::function<DiscontinuousData()> make_data_;
    std::function<std::uint64_t()> epoch_;
    std::uint64_t data_epoch_ = 0;
    std::optional<DiscontinuousData> data_;
    std::optional<ElementDeviations> deviations_;
    double scale_ = 1;
    ErrorBounds bounds_;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
