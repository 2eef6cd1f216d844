// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include <levels/element_cuts.hpp>
#include <levels/level_search.hpp>

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

/// How far U may be from the level on what is drawn in an element, or on a slice from the colour of
/// component 0: the bound of what S projected away below it, the offsets of its interpolated
/// corners, and what the flatness of triangles adds in shapes other than simplices.
/// \param below how far U may leave the range of the corners
template <class Real>
NESTGRID_INLINE double error_bound(const ElementCuts<Real>& element,
                                   const LevelSearch<Real>& search, Real below) {
    const ElementView<Real>& view = element.view();
    if (view.is_leaf()) {
        const float told = view.inner_bounds().error;
        if (told > 0) return static_cast<double>(told);
    }
    const Topology& t = view.topology();
    const double bound =
        projected_away(view, element.keys(), static_cast<double>(below), search.bounds(), search);
    if (t.corners == t.dimension + 1U) return bound;
    const auto data = element.data(0);
    const auto u = std::span(data).first(t.corners);
    const double residual = affine_residual(std::span(element.positions()).first(t.corners), u);
    const Extent corners = Extent::of(u);
    const Level<Real>& level = element.level();
    const Extent drawn = search.is_slice(level) ? corners : Extent{level.value, level.value};
    return std::min(bound + 2 * residual,
                    greatest_difference(drawn, corners, bound, search.data_range()));
}

/// How far U may be from a level, or on a slice from the colour of component 0, anywhere.
template <class Real>
double range_bound(const Level<Real>& level, const LevelSearch<Real>& search) {
    const Bounds& bounds = search.bounds();
    return greatest_difference(search.is_slice(level) ? Extent{bounds.least(), bounds.greatest()}
                                                      : Extent{level.value, level.value},
                               bounds);
}

/// How far points of an element may be from their true positions.
/// \param bounds of positions, at least their offsets
/// \param below what S projected away below the element
template <class Real>
double position_bound(const ElementCuts<Real>& element, const Indicator& bounds, double below) {
    struct Offsets {
        const Indicator* bounds;
        double offset_bound(NodeKey node) const { return bounds->stop(node); }
    };
    return below + corner_offset(element.view(), element.keys(), Offsets{&bounds});
}

}  // namespace nestgrid::engine
