// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many isosurfaces of one field, one after the other: a slider, or the frames of a film.
//
// Kept between two of them: the preroll, what is known of the coarse grid, tables and buffers. On
// one thread, a surface no larger than those before is drawn without any allocation.
#pragma once

#include <optional>

#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid {

/// Grid and field must outlive it.
template <class Grid, class Field>
class IsosurfaceSeries {
public:
    using Result = Isosurface<Grid::dimension, ElementOf<Grid>>;

    /// Does the preroll, by the threads of an executor.
    /// \throw InvalidInput, GridError as HierarchicalIndicator
    template <Executor E = SequentialExecutor>
    IsosurfaceSeries(const Grid& grid, const Field& field, const E& executor = {})
        : indicator_{grid, field, executor},
          criterion_{&indicator_, 0},
          walk_{grid, field, indicator_.hanging()} {}
    IsosurfaceSeries(const IsosurfaceSeries&) = delete;
    IsosurfaceSeries& operator=(const IsosurfaceSeries&) = delete;

    const HierarchicalIndicator& indicator() const { return indicator_; }

    /// What isosurface() gives, until the next call.
    /// \throw as isosurface()
    template <Executor E = SequentialExecutor>
    const Result& draw(double isovalue, const IsosurfaceOptions& options = {},
                       const E& executor = {}) {
        const std::span<const double> isovalues(&isovalue, 1);
        detail::require_drawable(walk_.grid(), isovalues, indicator_);
        criterion_ =
            criterion_for(walk_.grid(), walk_.field(), isovalue, indicator_, options, executor);
        options_ = options;
        Surface<Grid::dimension, ElementOf<Grid>>& surface = result_.surface;
        surface.clear();
        sinks_.clear();
        sinks_.emplace_back(surface, options.elements);
        if (visitor_) {
            visitor_->begin_again(isovalues, sinks_);
        } else {
            visitor_.emplace(walk_, isovalues, sinks_, criterion_, indicator_, options_);
        }
        result_.cancelled = detail::run_visitor(*visitor_, executor);
        visitor_->report(0, result_);
        return result_;
    }

private:
    using S = Threshold<HierarchicalIndicator>;
    using Sink = SurfaceSink<Grid::dimension, ElementOf<Grid>>;
    using Visitor = detail::IsosurfaceVisitor<Grid, Field, S, HierarchicalIndicator, Sink>;

    HierarchicalIndicator indicator_;
    S criterion_;
    IsosurfaceOptions options_;
    typename Visitor::Walk walk_;
    std::vector<Sink> sinks_;
    std::optional<Visitor> visitor_;
    Result result_;
};

}  // namespace nestgrid
