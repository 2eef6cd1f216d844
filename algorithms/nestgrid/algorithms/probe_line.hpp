// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Values of P_S U along lines (probe.hpp).
#pragma once

#include <vector>

#include <nestgrid/algorithms/probe.hpp>

namespace nestgrid {

/// Values along a line.
struct LineProbe : ProbeResult {
    std::vector<Point> points;
    std::vector<double> distance;  ///< from the first point, in units of the grid
};

namespace detail {

/// The points and distances of a line, without values.
LineProbe make_line(const Point& from, const Point& to, std::size_t count);

}  // namespace detail

/// The field at `count` points from one to another, equally spaced, both included.
/// \throw InvalidInput also where count is below 2
inline LineProbe probe_line(const Prerolls& prerolls, const Point& from, const Point& to,
                            std::size_t count, const Projection& projection = {},
                            const Work& work = {}) {
    LineProbe line = detail::make_line(from, to, count);
    static_cast<ProbeResult&>(line) = probe(prerolls, line.points, projection, work);
    return line;
}
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid> LineProbe
    probe_line(const Grid& grid, const Field& field, const Point& from, const Point& to,
               std::size_t count, const Projection& projection = {}, const Work& work = {}) {
        return probe_line(Prerolls(grid, field), from, to, count, projection, work);
    }

}  // namespace nestgrid
