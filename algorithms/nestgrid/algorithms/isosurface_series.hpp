// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many isosurfaces of one field, one after the other: a slider, or the frames of a film.
//
// Kept between two of them: the preroll, what is known of the coarse grid, tables and buffers. On
// one thread, a surface no larger than those before is drawn without any allocation.
#pragma once

#include <memory>

#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid {

namespace detail {

/// What a series keeps.
template <int dimension>
class SeriesState {
public:
    virtual ~SeriesState() = default;
    virtual const Isosurface<dimension>& draw(const HierarchicalIndicator& indicator,
                                              double isovalue, const Projection& projection,
                                              const IsosurfaceOptions& options,
                                              const Executor& executor) = 0;
};

template <int dimension>
std::unique_ptr<SeriesState<dimension>> make_series(
    std::unique_ptr<const Hierarchy<float>> hierarchy, const HierarchicalIndicator& indicator);
template <int dimension>
std::unique_ptr<SeriesState<dimension>> make_series(
    std::unique_ptr<const Hierarchy<double>> hierarchy, const HierarchicalIndicator& indicator);

}  // namespace detail

/// Grid and field must outlive it.
template <int dimension>
class IsosurfaceSeries {
public:
    using Result = Isosurface<dimension>;

    /// Does the preroll, by the threads of an executor.
    /// \throw InvalidInput, GridError as HierarchicalIndicator
    template <class Grid, class Field>
        requires(Grid::dimension == dimension)
    IsosurfaceSeries(const Grid& grid, const Field& field,
                     const Executor& executor = SequentialExecutor{})
        : indicator_{grid, field, executor},
          state_{detail::make_series<dimension>(
              std::unique_ptr<const Hierarchy<typename Field::value_type>>(
                  new detail::ErasedHierarchy<Grid, Field>(grid, field)),
              indicator_)} {}
    /// The same for a hierarchy.
    /// \throw InvalidInput also where it has another dimension
    template <class Real>
    explicit IsosurfaceSeries(std::unique_ptr<const Hierarchy<Real>> hierarchy,
                              const Executor& executor = SequentialExecutor{})
        : indicator_{*hierarchy, LeafErrors{}, executor} {
        hierarchy->facts().require_dimension(dimension);
        state_ = detail::make_series<dimension>(std::move(hierarchy), indicator_);
    }
    IsosurfaceSeries(const IsosurfaceSeries&) = delete;
    IsosurfaceSeries& operator=(const IsosurfaceSeries&) = delete;

    const HierarchicalIndicator& indicator() const { return indicator_; }

    /// What isosurface() gives, until the next call.
    /// \throw as isosurface(); InvalidInput also for a projection by anything but offsets within a
    ///        threshold or a number of triangles
    const Result& draw(double isovalue, const Projection& projection = {},
                       const IsosurfaceOptions& options = {},
                       const Executor& executor = SequentialExecutor{}) {
        return state_->draw(indicator_, isovalue, projection, options, executor);
    }

private:
    HierarchicalIndicator indicator_;
    std::unique_ptr<detail::SeriesState<dimension>> state_;
};

template <class Grid, class Field>
IsosurfaceSeries(const Grid&, const Field&) -> IsosurfaceSeries<Grid::dimension>;
template <class Grid, class Field>
IsosurfaceSeries(const Grid&, const Field&, const Executor&) -> IsosurfaceSeries<Grid::dimension>;

}  // namespace nestgrid
