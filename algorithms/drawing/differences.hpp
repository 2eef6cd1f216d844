// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How far data are from what is drawn of them in an element.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/detail/inlining.hpp>
#include <walk/element_view.hpp>

namespace nestgrid::engine {

/// The least and the greatest of some values.
struct Extent {
    double least;
    double greatest;

    NESTGRID_INLINE static Extent of(std::span<const double> values) {
        Extent extent{values[0], values[0]};
        for (const double value : values.subspan(1)) {
            extent.least = std::min(extent.least, value);
            extent.greatest = std::max(extent.greatest, value);
        }
        return extent;
    }
};

/// How far data may be from what is drawn in an element, whatever that is.
/// \param drawn extent of what is drawn
/// \param corners extent of the values at the corners of the element
/// \param off how far the data may leave the extent of the corners
/// \param range tells least() and greatest() of all data
NESTGRID_INLINE double greatest_difference(const Extent& drawn, const Extent& corners, double off,
                                           const auto& range) {
    const double least = std::max(range.least(), corners.least - off);
    const double greatest = std::min(range.greatest(), corners.greatest + off);
    return std::max({0.0, greatest - drawn.least, drawn.greatest - least});
}

/// How far data may be from what is drawn anywhere.
/// \param range tells least() and greatest() of all data
double greatest_difference(const Extent& drawn, const auto& range) {
    return std::max({0.0, range.greatest() - drawn.least, drawn.greatest - range.least()});
}

/// How far U may be from P_S U at the corners of an element that are interpolated.
/// \param keys of the corners
/// \param bounds tells offset_bound(key)
template <class Real>
double corner_offset(const ElementView<Real>& view, const std::array<NodeKey, max_corners>& keys,
                     const auto& bounds) {
    double greatest = 0;
    for (unsigned left = view.interpolated; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        greatest = std::max(greatest, bounds.offset_bound(keys[i]));
    }
    // An interpolated parent that was made in the same split adds its own error.
    return view.made_by == nullptr ? greatest : greatest * view.made_by->steps;
}

/// How far U may be from P_S U on an element that stops.
/// \param below the bound of what S projected away below it
template <class Real>
NESTGRID_INLINE double projected_away(const ElementView<Real>& view,
                                      const std::array<NodeKey, max_corners>& keys, double below,
                                      const Bounds& bounds, const auto& corner_bounds) {
    if (view.interpolated == 0) return below;
    if (!bounds.corners_bound_elements()) {
        return below + corner_offset(view, keys, corner_bounds);
    }
    double least = std::numeric_limits<double>::infinity();
    for (unsigned left = view.interpolated; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        least = std::min(least, bounds.offset_bound(keys[i]));
    }
    return least;
}

}  // namespace nestgrid::engine
