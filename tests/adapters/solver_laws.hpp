// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The laws that a grid inside a real solver must obey, with the solver's own data on it.
#pragma once

#include <nestgrid/algorithms/project.hpp>
#include <nestgrid/check_grid.hpp>

#include "closedness.hpp"

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
    using Walk = Traversal<Grid, Field, Needs{.keys = true, .positions = true}>;
    const Walk walk(grid, field, indicator.hanging());
    using Real = typename Field::value_type;
    KeyTable<NodeKey, std::pair<Real, Point>> seen;
    project(walk, Threshold<HierarchicalIndicator>{&indicator, threshold}, [&](const auto& s) {
        std::array<NodeKey, max_corners> keys;
        std::array<Point, max_corners> x;
        walk.keys(s, keys);
        walk.positions(s, x);
        for (std::size_t k = 0; k < static_cast<std::size_t>(s.corner_count()); ++k) {
            const std::pair here{s.value[k * Walk::State::components], x[k]};
            const auto [at, is_new] = seen.insert(keys[k], here);
            EXPECT_EQ(*at, here);
        }
    });
}

/// Capped and not: no open edge inside the domain, a manifold, shared vertices equal to the last
/// bit, and one value per node. Returns the lesser number of triangles.
template <class Grid, class Field>
std::size_t expect_closed_level(const Grid& grid, const Field& field, double isovalue,
                                const HierarchicalIndicator& indicator, double threshold) {
    SCOPED_TRACE("threshold " + std::to_string(threshold));
    expect_single_valued(grid, field, indicator, threshold);
    std::size_t triangles = std::numeric_limits<std::size_t>::max();
    for (const bool cap : {false, true}) {
        const auto result = isosurface(grid, field, isovalue, indicator,
                                       {.threshold = threshold, .cap = cap, .verify = true});
        expect_closed(result.surface, cap);
        triangles = std::min(triangles, result.surface.simplices.size());
    }
    return triangles;
}

/// The same at six thresholds, for an isovalue that is met.
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
}

/// A linear function is its own projection: every vertex lies on the plane, at any threshold.
template <class Grid, class Field, class Linear>
void expect_linear_exact(const Grid& grid, const Field& field, double isovalue,
                         const Linear& linear) {
    const HierarchicalIndicator indicator(grid, field);
    for (const double threshold : {1e-12, 1.0}) {
        const auto result = isosurface(grid, field, isovalue, indicator, {.threshold = threshold});
        EXPECT_GT(result.surface.vertices.size(), 0U);
        for (const Point& x : result.surface.vertices) {
            EXPECT_NEAR(linear(x), isovalue, 2e-6);  // cuts keep away from nodes
        }
    }
}

}  // namespace nestgrid_test
