// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The laws that every grid of Dune must obey through its adapter.
#pragma once

#include <nestgrid/adapters/dune_fields.hpp>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>
#include <walk/project.hpp>

#include "closedness.hpp"
#include "element_in.hpp"
#include "refusal.hpp"
#include "solver_laws.hpp"
#include "thread_executor.hpp"

namespace nestgrid_test {

using namespace nestgrid;

/// Values of a function of places at the vertices of the leaf grid, in the order of its indices.
template <class Solver>
std::vector<double> at_vertices(const Solver& solver,
                                const std::function<double(const Point&)>& f) {
    std::vector<double> values(static_cast<std::size_t>(solver.size(Solver::dimension)));
    for (const auto& v : vertices(solver.leafGridView())) {
        const auto i = static_cast<std::size_t>(solver.leafIndexSet().index(v));
        values[i] = f(nestgrid::detail::dune_point(v.geometry().corner(0)));
    }
    return values;
}

inline double linear(const Point& x) { return 0.25 + x[0] - 2 * x[1] + 0.5 * x[2]; }

inline double ball(const Point& x) {
    return 0.35 - norm(x - Point{0.51, 0.49, x[2] == 0 ? 0 : 0.5});
}

template <class Solver>
std::vector<double> noise(const Solver& solver) {
    std::mt19937 random(7);
    return at_vertices(solver, [&](const Point&) { return uniform(random) - 0.5; });
}

/// Nothing to complain about, the volume of the leaves is that of the domain, and linear functions
/// stay what they are at any threshold.
template <class Grid>
void expect_sound(const Grid& grid, double volume) {
    const auto& solver = grid.solver();
    const std::vector<double> values = at_vertices(solver, linear);
    const DuneVertexField field(grid, values);
    const auto violation = check_grid(grid, field, {.hanging_values = true});
    ASSERT_FALSE(violation) << violation->sentence;

    const HierarchicalIndicator indicator(grid, field);
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.positions = true}, indicator.hanging());
    for (const double threshold : six_thresholds) {
        double sum = 0;
        double error = 0;
        std::size_t count = 0;
        engine::project(walk, Threshold(&indicator, threshold), [&](const auto& view) {
            std::array<Point, max_corners> x;
            walk.corners(view, nullptr, x.data());
            const std::size_t corners = view.corner_count();
            const double size = measure(view.shape, std::span(x).first(corners));
            EXPECT_GT(Grid::dimension == 3 ? view.orientation * size : size, 0);
            sum += std::abs(size);
            ++count;
            for (std::size_t k = 0; k < corners; ++k) {
                error = std::max(error, std::abs(view.value[k] - linear(x[k])));
            }
        });
        EXPECT_NEAR(sum, volume, 1e-11 * volume);
        EXPECT_LT(error, 1e-14);
        if (threshold == 10) {
            EXPECT_EQ(count, grid.coarse_count());
        }
    }
}

/// Level sets of the vector at any threshold; returns the triangles of the finest.
template <class Grid>
std::size_t expect_closed_at_all_thresholds(const Grid& grid, const std::vector<double>& values) {
    const DuneVertexField field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    std::vector<std::size_t> triangles;
    for (const double threshold : six_thresholds) {
        IsosurfaceOptions options;
        options.verify = true;
        const auto result = isosurface(grid, field, 0, under(indicator, threshold), options);
        SCOPED_TRACE(threshold);
        expect_closed(result.surface);
        expect_slices_or_shading<Grid::dimension>(erase(grid, field), 0, indicator, threshold);
        triangles.push_back(result.surface.simplices.size());
    }
    EXPECT_GT(triangles.front(), triangles.back());
    return triangles.front();
}

/// All of it, in the unit cube or square.
template <class Solver>
void expect_laws(const Solver& solver) {
    const DuneGrid grid(solver);
    expect_sound(grid, 1);
    const std::vector<double> plane = at_vertices(solver, slanted<Solver::dimension>);
    expect_linear_exact(grid, DuneVertexField(grid, plane));
    EXPECT_GT(expect_closed_at_all_thresholds(grid, at_vertices(solver, ball)), 8U);
    EXPECT_GT(expect_closed_at_all_thresholds(grid, noise(solver)), 8U);
}

/// A grid that does not allow several threads.
template <class Grid>
void expect_one_thread_only(const Grid& grid) {
    const std::vector<double> values = noise(grid.solver());
    const DuneVertexField field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    EXPECT_EQ(
        refusal([&] { isosurface(grid, field, 0, under(indicator, 0), {}, {ThreadExecutor(2)}); }),
        "this Dune grid can only be walked by the thread that made its adapter");
}

/// Marks what a sphere of radius 0.35 about the middle of the unit cube passes near, level by
/// level. Green elements are judged by the width of their level, not by their own.
template <class Solver>
void refine_at_sphere(Solver& solver, int levels, double width) {
    for (int level = 0; level < levels; ++level) {
        for (const auto& e : elements(solver.leafGridView())) {
            auto x = e.geometry().center();
            x -= Dune::FieldVector<double, Solver::dimension>(0.5);
            const bool near = std::abs(x.two_norm() - 0.35) < std::ldexp(width, -e.level());
            if (near && e.level() <= level) solver.mark(1, e);
        }
        solver.preAdapt();
        solver.adapt();
        solver.postAdapt();
    }
}

}  // namespace nestgrid_test
