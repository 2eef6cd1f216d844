// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The laws that a grid inside a real solver must obey, with the solver's own data on it.
#pragma once

#include <bit>

#include <nestgrid/algorithms/discontinuous.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <walk/project.hpp>

#include "closedness.hpp"
#include "copied.hpp"
#include "slice_laws.hpp"

namespace nestgrid_test {

/// The grid keeps the contract, hanging values included where the solver has constrained them.
template <class Grid, class Field>
void expect_sound_grid(const Grid& grid, const Field& field, const CheckOptions& options = {}) {
    const auto violation = check_grid(grid, field, options);
    EXPECT_FALSE(violation) << violation->sentence;
}

/// A node has one projected value and one place, whichever element is asked.
template <class Grid, class Field>
void expect_single_valued(const Grid& grid, const Field& field,
                          const HierarchicalIndicator& indicator, double threshold) {
    using Real = typename Field::value_type;
    const auto hierarchy = erase(grid, field);
    const engine::Walk<Real> walk(hierarchy, {.positions = true}, indicator.hanging());
    KeyTable<NodeKey, std::pair<Real, Point>> seen;
    engine::project(walk, Threshold(&indicator, threshold), [&](const auto& view) {
        std::array<NodeKey, max_corners> keys;
        std::array<Point, max_corners> x;
        walk.corners(view, keys.data(), x.data());
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            const std::pair here{view.value[k * walk.components()], x[k]};
            const auto [at, is_new] = seen.insert(keys[k], here);
            EXPECT_EQ(*at, here);
        }
    });
}

/// Capped and not: no open edge inside the domain, a manifold, shared vertices equal to the last
/// bit, and one value per node; and the laws of slices or shading. Returns the lesser number of
/// triangles.
template <class Grid, class Field>
std::size_t expect_closed_level(const Grid& grid, const Field& field, double isovalue,
                                const HierarchicalIndicator& indicator, double threshold) {
    SCOPED_TRACE("threshold " + std::to_string(threshold));
    expect_single_valued(grid, field, indicator, threshold);
    std::size_t triangles = std::numeric_limits<std::size_t>::max();
    for (const bool cap : {false, true}) {
        const auto result = isosurface(grid, field, isovalue, under(indicator, threshold),
                                       {.cap = cap, .verify = true});
        expect_closed(result.surface, cap);
        triangles = std::min(triangles, result.surface.simplices.size());
    }
    expect_slices_or_shading<Grid::dimension>(erase(grid, field), isovalue, indicator, threshold);
    return triangles;
}

/// The same at six thresholds, for an isovalue that is met; and of a copy.
template <class Grid, class Field>
void expect_closed_levels(const Grid& grid, const Field& field, double isovalue, double scale = 1) {
    const HierarchicalIndicator indicator(grid, field);
    for (const double threshold : six_thresholds) {
        const std::size_t triangles =
            expect_closed_level(grid, field, isovalue, indicator, scale * threshold);
        if (threshold == 0) {
            EXPECT_GT(triangles, 0U);
        }
    }
    expect_copied<Grid::dimension>(erase(grid, field), isovalue, {0.0, scale * six_thresholds[2]});
}

/// A linear function, and where it has a value in the unit cube, square or segment.
struct LinearFunction {
    Point slope;  ///< no component 0, but the last of the plane
    double isovalue;

    double operator()(const Point& x) const {
        return slope[0] * x[0] + slope[1] * x[1] + slope[2] * x[2];
    }
    /// Area, or length in two dimensions, by the corners on one side.
    double area(int dim) const {
        const auto n = static_cast<unsigned>(dim);
        double sum = 0;
        double product = dim == 3 ? 2 : 1;
        for (unsigned d = 0; d < n; ++d) product *= slope[d];
        for (unsigned corner = 0; corner < 1U << n; ++corner) {
            const Point x{double(corner & 1U), double(corner >> 1U & 1U), double(corner >> 2U)};
            const double above = std::max(0.0, isovalue - (*this)(x));
            sum += (std::popcount(corner) % 2 == 0 ? 1 : -1) * std::pow(above, dim - 1);
        }
        return norm(slope) * std::abs(sum / product);
    }
};

/// A plane through the unit cube, and a line through the unit square, that pass by all nodes.
inline constexpr LinearFunction slanted_plane{{1, -2, 0.5}, -0.9 + 1 / 7.7};
inline constexpr LinearFunction slanted_line{{1, -2, 0}, -0.9 + 1 / 7.7};
template <int dim>
constexpr const LinearFunction& slanted = dim == 2 ? slanted_line : slanted_plane;

inline double size_of(const Surface<3>& surface) { return surface_report(surface).area; }
inline double size_of(const Surface<2>& lines) {
    double length = 0;
    for (const auto& [a, b] : lines.simplices)
        length += norm(lines.vertices[b] - lines.vertices[a]);
    return length;
}

/// Data in cells that are 1 cover what elements of the grid cover, alone and where they stop.
template <class Grid>
void expect_pieces_of_one(const Grid& grid) {
    const auto one = [](const ElementOf<Grid>&) { return 1.0; };
    const DiscontinuousData data(grid, one);
    const ElementDeviations deviations(data);
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (const double threshold : {0.0, 1e-12}) {
        const DiscontinuousOptions options{.threshold = threshold, .deviations = &deviations};
        DiscontinuousSurface drawn;
        if constexpr (Grid::dimension == 2) {
            drawn = shading(data, options);
            EXPECT_NEAR(size_of(drawn.surface), 1, 1e-12);
        } else {
            const Point& slope = slanted_plane.slope;
            const Plane plane(slanted_plane.isovalue / dot(slope, slope) * slope, slope);
            drawn = slice(data, plane, options);
            EXPECT_NEAR(size_of(drawn.surface), slanted_plane.area(3), 1e-12);
        }
        for (const double u : drawn.surface.attributes) EXPECT_NEAR(u, 1, 1e-14);
        EXPECT_LT(drawn.surface.level_of.size(), before);
        before = drawn.surface.level_of.size();
    }
}

/// On a grid that fills the unit cube or square, with the plane's values at the nodes: a linear
/// function is its own projection, so its surface is the plane, at any threshold, and slices and
/// height fields have its values.
template <class Grid, class Field>
void expect_linear_exact(const Grid& grid, const Field& field) {
    const LinearFunction& plane = slanted<Grid::dimension>;
    const HierarchicalIndicator indicator(grid, field);
    expect_pieces_of_one(grid);
    for (const double threshold : {0.0, 1e-12, 1.0}) {
        const auto surface =
            isosurface(grid, field, plane.isovalue, under(indicator, threshold)).surface;
        double off = 0;
        for (const Point& x : surface.vertices) {
            off = std::max(off, std::abs(plane(x) - plane.isovalue));
        }
        EXPECT_LE(off, 1e-14);
        EXPECT_NEAR(size_of(surface), plane.area(Grid::dimension), 1e-12);
        expect_exact_values<Grid::dimension>(erase(grid, field), indicator, threshold, plane);
    }
}

}  // namespace nestgrid_test
