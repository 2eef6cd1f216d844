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

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// What geometry_indicator may be told.
struct GeometryOptions {
    Spread spread{};
};

/// \throw InvalidInput where a position is not finite, and for a spread as in measured_indicator()
SweptIndicator geometry_indicator(const FieldOnGrid& field, const GeometryOptions& options = {});

/// The offset of each node and the greatest bound of finer ones; see
/// IsosurfaceOptions::position_bounds.
/// \throw InvalidInput where a position is not finite
SweptIndicator position_bounds(const FieldOnGrid& field);

}  // namespace nestgrid
