// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The geometry indicator (paper, section 5.2): how far the true position of a node is from the mean
// of the positions of its parents, |x - sum omega x|, in units of length.
//
// Grids that follow a curved or deformed surface are refined for their shape by it; on all others
// it is 0. It does not see the data: combine it, Threshold(&offsets, a) && Threshold(&geometry, b).
// At threshold 0 the projected positions are the true ones.
//
// Offsets of several levels add up. position_bounds() are their recursive sum (section 4.4): points
// of an element that stops at nodes with bounds up to epsilon are within epsilon of their true
// positions. As an indicator they are saturated, too, and the stricter criterion.
#pragma once

#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// What geometry_indicator may be told.
struct GeometryOptions {
    Spread spread{};
};

/// \throw InvalidInput where a position is not finite, and for a spread as in measured_indicator()
SweptIndicator geometry_indicator(const Hierarchy<float>& hierarchy,
                                  const GeometryOptions& options = {});
SweptIndicator geometry_indicator(const Hierarchy<double>& hierarchy,
                                  const GeometryOptions& options = {});
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
SweptIndicator geometry_indicator(const Grid& grid, const Field& field,
                                  const GeometryOptions& options = {}) {
    return geometry_indicator(erase(grid, field), options);
}

/// The offset of each node and the greatest bound of finer ones; see
/// IsosurfaceOptions::position_bounds.
/// \throw InvalidInput where a position is not finite
SweptIndicator position_bounds(const Hierarchy<float>& hierarchy);
SweptIndicator position_bounds(const Hierarchy<double>& hierarchy);
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
SweptIndicator position_bounds(const Grid& grid, const Field& field) {
    return position_bounds(erase(grid, field));
}

}  // namespace nestgrid
