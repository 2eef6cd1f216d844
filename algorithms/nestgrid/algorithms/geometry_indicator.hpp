// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The geometry indicator (paper, section 5.2): how far the true position of a node is from the mean
// of the positions of its parents, |x - sum omega x|, in units of length.
//
// Grids that follow a curved or deformed surface are refined for their shape by it; on all others
// it is 0. It does not see the data: combine it, Threshold(&offsets, a) && Threshold(&geometry, b).
// At threshold 0 the projected positions are the true ones.
#pragma once

#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

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

}  // namespace nestgrid
