// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Values of P_S U at points, by descent through the hierarchy (paper, section 3). Those along lines
// are in probe_line.hpp.
//
// Each point descends in reference coordinates, where children lie as their rule says, so that no
// search structure is needed and deformed elements are treated exactly; all points descend in one
// walk. The functions below take a Hierarchy in the place of grid and field, too.
#pragma once

#include <span>
#include <vector>

#include <nestgrid/algorithms/discontinuous_data.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>

namespace nestgrid {

/// Values at points.
struct ProbeResult {
    std::size_t components = 1;
    /// P_S U: component c at point i is values[i * components + c]; not a number outside the grid.
    std::vector<double> values;
    std::vector<int> level;  ///< of the element around each point; -1 outside the grid
    /// The element around each point, an index into elements; no_element outside the grid and, on
    /// ranks, where another rank has the element. All else is the same on all ranks.
    std::vector<std::uint32_t> element_of;
    std::vector<Point> reference;  ///< each point in the reference element (shape.hpp)
    Elements elements;             ///< around points: as<Grid::Element>() gives the grid's own
    std::vector<Shape> shape_of;   ///< shape of each of them
    TraversalCounts counts;

    static constexpr std::uint32_t no_element = ~std::uint32_t{0};

    bool found(std::size_t i) const { return level[i] >= 0; }
};

namespace detail {

/// Defined for float and double. Without criterion and bounds: at full resolution.
template <class Real>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points,
                  const Criterion& criterion, const Bounds& bounds);
template <class Real>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points);

std::vector<double> only_values(ProbeResult result, const Point& x);

}  // namespace detail

/// The field at points.
/// \param s nothing, for the data on the finest grid: no preroll is needed, and the grid is walked
///        once only to find hanging nodes that it does not name; or a criterion, and Bounds of the
///        same grid and field, such as a HierarchicalIndicator
/// \throw InvalidInput where a coordinate is not finite, and for a criterion that is not saturated
/// \throw GridError where the field has no value, or where the grid has changed since the bounds
///        were computed
template <class Real, class... S>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points, const S&... s) {
    return detail::probe<Real>(hierarchy, points, s...);
}
template <class Grid, class Field, class... S>
    requires NodalField<Field, Grid> ProbeResult probe(const Grid& grid, const Field& field,
                                                       std::span<const Point> points,
                                                       const S&... s) {
        return probe<typename Field::value_type>(erase(grid, field), points, s...);
    }

/// Data that jump between leaves, at points, at full resolution. A point on the border of several
/// leaves takes the data of one of them.
/// \return values of data.components()
/// \throw InvalidInput where a coordinate is not finite
ProbeResult probe(const DiscontinuousData& data, std::span<const Point> points);

/// The field at one point.
/// \return its components
/// \throw InvalidInput also where the point lies outside the grid
template <class Real, class... S>
std::vector<double> probe_point(const Hierarchy<Real>& hierarchy, const Point& x, const S&... s) {
    return detail::only_values(probe<Real>(hierarchy, std::span(&x, 1), s...), x);
}
template <class Grid, class Field, class... S>
    requires NodalField<Field, Grid> std::vector<double> probe_point(const Grid& grid,
                                                                     const Field& field,
                                                                     const Point& x,
                                                                     const S&... s) {
        return probe_point<typename Field::value_type>(erase(grid, field), x, s...);
    }

}  // namespace nestgrid
