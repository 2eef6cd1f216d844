// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <drawing/differences.hpp>
#include <level_sets/element_cuts.hpp>
#include <level_sets/level_search.hpp>

namespace nestgrid::engine {

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
