// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The laws of slices, boundaries, shading, isolines and probes on a grid inside a solver.
#pragma once

#include <algorithm>
#include <array>
#include <set>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/probe.hpp>

#include "closedness.hpp"
#include "cut_cube.hpp"

namespace nestgrid_test {

/// In general position, along faces of elements, and across them through edges.
inline constexpr std::array<Point, 4> slice_normals{
    Point{0.3, 0.5, 0.81}, {1, 0, 0}, {0, 1, -1}, {0, 0, -1}};

/// The ends of lines that are no rings are `expected`, each the end of one line.
inline void expect_ends(const Polylines& lines, const std::set<Point>& expected) {
    std::set<Point> ends;
    for (std::size_t i = 0; i < lines.count(); ++i) {
        if (lines.closed(i)) continue;
        for (const std::uint32_t v : {lines.line(i).front(), lines.line(i).back()}) {
            EXPECT_TRUE(ends.insert(lines.vertices[v]).second) << "two lines end at one point";
        }
    }
    EXPECT_EQ(ends, expected);
}

/// Lines on a surface end at edges of its boundary across which the attribute passes the value; a
/// line that does not leave a vertex at the value is not drawn.
inline void expect_ends_on_boundary(const Surface<3>& surface, double value) {
    const Polylines lines = isolines(surface, 0, std::array{value});
    std::size_t ends = 0;
    for (std::size_t i = 0; i < lines.count(); ++i) ends += lines.closed(i) ? 0 : 2;
    std::size_t at_value = 0;
    std::size_t across = 0;
    for (const auto& [a, b] : surface.boundary) {
        const auto [lo, hi] = std::minmax(surface.attributes[a], surface.attributes[b]);
        across += lo < value && value < hi ? 1 : 0;
        at_value += lo < value && value == hi ? 1 : 0;
    }
    EXPECT_GE(ends, across);
    EXPECT_LE(ends, across + at_value);
}

/// The boundary of the domain is closed. Slices through its middle are closed and planar, and
/// isolines on them end on the boundary.
template <class Real>
void expect_slices(const Hierarchy<Real>& hierarchy, double isovalue,
                   const HierarchicalIndicator& indicator, double threshold) {
    const Threshold criterion(&indicator, threshold);
    const auto boundary =
        boundary_surface(hierarchy, under(criterion, indicator), {.verify = true});
    expect_closed(boundary.surface, true);
    Point low = boundary.surface.vertices.at(0);
    Point high = low;
    for (const Point& x : boundary.surface.vertices) {
        for (std::size_t d = 0; d < 3; ++d) {
            low[d] = std::min(low[d], x[d]);
            high[d] = std::max(high[d], x[d]);
        }
    }
    for (const Point& normal : slice_normals) {
        SCOPED_TRACE(testing::Message() << "normal " << testing::PrintToString(normal));
        const nestgrid::Plane plane(0.5 * (low + high), normal);
        const auto drawn = slice(hierarchy, plane, under(criterion, indicator), {.verify = true});
        expect_closed(drawn.surface);
        double off = 0;
        for (const Point& x : drawn.surface.vertices) {
            off = std::max(off, std::abs(plane.value(x)));
        }
        EXPECT_LE(off, 1e-12 * norm(high - low));
        expect_ends_on_boundary(drawn.surface, isovalue);
    }
}

/// In two dimensions the triangulation conforms, and isolines end on the boundary of the domain.
/// \param orientable whether the domain is; lines are joined by their orientation
template <class Real>
void expect_shading(const Hierarchy<Real>& hierarchy, double isovalue,
                    const HierarchicalIndicator& indicator, double threshold,
                    bool orientable = true) {
    const Surface<3> triangles = shading(hierarchy, under(indicator, threshold)).surface;
    const SurfaceReport report = surface_report(triangles);
    EXPECT_EQ(report.open_edges, 0U);
    EXPECT_EQ(report.nonmanifold_edges, 0U);
    EXPECT_EQ(report.boundary_edges, triangles.boundary.size());
    EXPECT_TRUE(!orientable || report.misoriented_edges == 0);
    if (!orientable) return;
    const Surface<2> segments =
        isosurface<2>(hierarchy, isovalue, under(indicator, threshold)).surface;
    std::set<Point> ends;
    for (const auto& [v] : segments.boundary) ends.insert(segments.vertices[v]);
    expect_ends(isolines(hierarchy, std::array{isovalue}, under(indicator, threshold)).lines, ends);
}

/// One of the two, by the dimension.
template <int dimension, class Real>
void expect_slices_or_shading(const Hierarchy<Real>& hierarchy, double isovalue,
                              const HierarchicalIndicator& indicator, double threshold,
                              bool orientable = true) {
    if constexpr (dimension == 3) {
        expect_slices(hierarchy, isovalue, indicator, threshold);
    } else {
        expect_shading(hierarchy, isovalue, indicator, threshold, orientable);
    }
}

/// Attribute 0 of every vertex is the function there.
template <class Function>
void expect_coloured_by(const Surface<3>& surface, const Function& f) {
    ASSERT_EQ(surface.attributes.size(), surface.vertices.size());
    double error = 0;
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        error = std::max(error, std::abs(surface.attributes[v] - f(surface.vertices[v])));
    }
    EXPECT_LE(error, 1e-12);
}

/// On the unit cube with the values of a linear function: slices, in general position, through
/// nodes and in the boundary, have the area of the plane in the cube, the boundary has that of the
/// cube, and both have the colours of the function.
template <class Real, class Function>
void expect_exact_slices(const Hierarchy<Real>& hierarchy, const HierarchicalIndicator& indicator,
                         double threshold, const Function& f) {
    const Threshold criterion(&indicator, threshold);
    const auto boundary = boundary_surface(hierarchy, under(criterion, indicator)).surface;
    EXPECT_NEAR(surface_report(boundary).area, 6, 1e-12);
    EXPECT_NEAR(surface_report(boundary).volume, 1, 1e-12);
    expect_coloured_by(boundary, f);
    for (const Point& normal : slice_normals) {
        for (const Point& through : {Point{0.5, 0.5, 0.5}, {0.25, 0, 0}}) {
            SCOPED_TRACE(testing::Message() << "normal " << testing::PrintToString(normal)
                                            << " through " << testing::PrintToString(through));
            const auto drawn =
                slice(hierarchy, nestgrid::Plane(through, normal), under(criterion, indicator))
                    .surface;
            EXPECT_NEAR(surface_report(drawn).area, area_in_cube(through, normal), 1e-12);
            expect_coloured_by(drawn, f);
        }
    }
}

/// On the unit square with the values of a linear function: shading covers it, a height field is
/// the graph of the function.
template <class Real, class Function>
void expect_exact_shading(const Hierarchy<Real>& hierarchy, const HierarchicalIndicator& indicator,
                          double threshold, const Function& f) {
    const auto flat = shading(hierarchy, under(indicator, threshold)).surface;
    EXPECT_NEAR(surface_report(flat).area, 1, 1e-12);
    expect_coloured_by(flat, f);
    const auto graph = height_field(hierarchy, 2, under(indicator, threshold)).surface;
    double error = 0;
    for (const Point& x : graph.vertices) {
        error = std::max(error, std::abs(x[2] - 2 * f({x[0], x[1], 0})));
    }
    EXPECT_LE(error, 1e-12);
}

/// One of the two, by the dimension; and the values at points are those of the function.
template <int dimension, class Real, class Function>
void expect_exact_values(const Hierarchy<Real>& hierarchy, const HierarchicalIndicator& indicator,
                         double threshold, const Function& f) {
    if constexpr (dimension == 3) {
        expect_exact_slices(hierarchy, indicator, threshold, f);
    } else {
        expect_exact_shading(hierarchy, indicator, threshold, f);
    }
    std::mt19937 random(4);
    std::vector<Point> points(200);
    for (Point& x : points) {
        for (std::size_t d = 0; d < dimension; ++d) x[d] = uniform(random);
    }
    const auto found = probe(hierarchy, points, under(indicator, threshold));
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(found.values[i], f(points[i]), 1e-12);
    }
}

}  // namespace nestgrid_test
