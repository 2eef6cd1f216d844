// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Values of P_S U at points, by descent through the hierarchy (paper, section 3). Those along lines
// are in probe_line.hpp.
//
// Each point descends in reference coordinates, where children lie as their rule says, so that no
// search structure is needed and deformed elements are treated exactly; all points descend in one
// walk.
#pragma once

#include <span>
#include <vector>

#include <nestgrid/algorithms/discontinuous_data.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/prerolls.hpp>
#include <nestgrid/algorithms/projection.hpp>
#include <nestgrid/algorithms/watch.hpp>

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

std::vector<double> only_values(ProbeResult result, const Point& x);

}  // namespace detail

/// The field at points. The data on the finest grid need no preroll, and the grid is walked once
/// only to find hanging nodes that it does not name.
/// \throw InvalidInput where a coordinate is not finite, as Projection::check() and
///        Prerolls::choose(), for collapses, and for a number of triangles
/// \throw GridError where the field has no value, or where the grid has changed
ProbeResult probe(const Prerolls& prerolls, std::span<const Point> points,
                  const Projection& projection = {}, const Work& work = {});
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid> ProbeResult probe(const Grid& grid,
                                                                const Field& field,
                                                                std::span<const Point> points,
                                                                const Projection& projection = {},
                                                                const Work& work = {}) {
        return probe(Prerolls(grid, field), points, projection, work);
    }

/// Data that jump between leaves, at points, at full resolution. A point on the border of several
/// leaves takes the data of one of them.
/// \return values of data.components()
/// \throw InvalidInput where a coordinate is not finite
ProbeResult probe(const DiscontinuousData& data, std::span<const Point> points);

/// The field at one point.
/// \return its components
/// \throw InvalidInput also where the point lies outside the grid
inline std::vector<double> probe_point(const Prerolls& prerolls, const Point& x,
                                       const Projection& projection = {}, const Work& work = {}) {
    return detail::only_values(probe(prerolls, std::span(&x, 1), projection, work), x);
}
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid> std::vector<double> probe_point(
        const Grid& grid, const Field& field, const Point& x, const Projection& projection = {},
        const Work& work = {}) {
        return probe_point(Prerolls(grid, field), x, projection, work);
    }

}  // namespace nestgrid
