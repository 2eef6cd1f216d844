// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The boundary of the domain of a hierarchy of dimension 3, coloured by the data. Where the data
// stop elements, the boundary is as coarse as they are; edges between boundary faces of different
// levels conform.
//
// A view of the domain cut open is no boundary but a slice with options.cap: the part of the domain
// on the positive side of the function.
#pragma once

#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid {

namespace detail {

/// A function without a zero, positive everywhere: its capped level set is the boundary.
class Everywhere final : public LevelFunction {
public:
    double value(const Point& /*x*/) const override { return 1; }
    double variation(const Point& /*centre*/, double /*radius*/) const override { return 0; }
    bool affine() const override { return true; }
};

inline IsosurfaceOptions capped(IsosurfaceOptions options) {
    options.cap = true;
    return options;
}

}  // namespace detail

/// The boundary under the projection with `criterion`, oriented outwards: a closed surface.
/// Attribute c of a vertex is component c of the field.
/// \param bounds of the same grid and field
/// \throw InvalidInput where the hierarchy has another dimension
/// \throw GridError as isosurface()
template <class Real>
Slice boundary_surface(const Hierarchy<Real>& hierarchy, const Criterion& criterion,
                       const Bounds& bounds, const IsosurfaceOptions& options = {},
                       const Executor& executor = SequentialExecutor{}) {
    return slice(hierarchy, detail::Everywhere{}, criterion, bounds, detail::capped(options),
                 executor);
}
template <class Grid, class Field>
Slice boundary_surface(const Grid& grid, const Field& field, const Criterion& criterion,
                       const Bounds& bounds, const IsosurfaceOptions& options = {},
                       const Executor& executor = SequentialExecutor{}) {
    return boundary_surface(erase(grid, field), criterion, bounds, options, executor);
}

/// Draws the boundary with S from options.threshold or options.max_triangles, after its own
/// preroll, or, at threshold 0, without any.
template <class Real>
Slice boundary_surface(const Hierarchy<Real>& hierarchy, const IsosurfaceOptions& options = {},
                       const Executor& executor = SequentialExecutor{}) {
    return slice(hierarchy, detail::Everywhere{}, detail::capped(options), executor);
}
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
Slice boundary_surface(const Grid& grid, const Field& field, const IsosurfaceOptions& options = {},
                       const Executor& executor = SequentialExecutor{}) {
    return boundary_surface(erase(grid, field), options, executor);
}

}  // namespace nestgrid
