// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Joined, oriented lines, made of the segments of isolines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// Lines through numbered vertices, each with the value of the function on it. Lines are oriented
/// as the segments they are made of: the right-hand side points to where U is below the value.
/// Each line passes two different positions at least, and consecutive positions differ. A ring
/// names its first vertex again at its end.
struct Polylines {
    std::vector<Point> vertices;
    std::size_t attribute_count = 0;
    std::vector<double> attributes;     ///< attribute_count numbers for each vertex
    std::vector<std::uint32_t> points;  ///< the vertices of each line, line by line
    std::vector<std::size_t> first{0};  ///< where each line begins in points; count() + 1 offsets
    std::vector<double> value;          ///< for each line

    std::size_t count() const { return value.size(); }
    /// The vertices of line i in their order, 0 <= i < count().
    std::span<const std::uint32_t> line(std::size_t i) const {
        return std::span(points).subspan(first[i], first[i + 1] - first[i]);
    }
    /// Whether line i is a ring.
    bool closed(std::size_t i) const { return line(i).front() == line(i).back(); }
    /// The length of line i, in the units of the positions.
    double length(std::size_t i) const;
};

/// Joins segments where one ends in the vertex in which another begins. A line begins where no
/// segment ends; what remains are rings. A point at the position of its predecessor is left out,
/// and so is a line that has one position only; nothing else is merged, for lines would branch.
/// Where several segments begin in one vertex, lines touch there, and each segment is in one line.
/// Takes time and memory proportional to the number of segments and vertices.
/// \param value of the function on the segments
/// \throw InvalidInput where a segment names a vertex that does not exist
Polylines polylines(const Surface<2>& segments, double value);

namespace detail {

/// The same, behind the lines of `to`.
/// \throw InvalidInput also where the vertices of `to` have another number of attributes
void append_polylines(Polylines& to, const Surface<2>& segments, double value);

}  // namespace detail

}  // namespace nestgrid
