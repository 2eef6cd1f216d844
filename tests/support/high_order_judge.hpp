// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every surface of data of higher degree must be: within its bound, which keeps the tolerance.
#pragma once

#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "closedness.hpp"
#include "long_run.hpp"

namespace nestgrid_test {

inline double gyroid(const Point& x) {
    return std::sin(4 * x[0]) * std::cos(4 * x[1]) + std::sin(4 * x[1]) * std::cos(4 * x[2]) +
           std::sin(4 * x[2]) * std::cos(4 * x[0]);
}
/// Its zero passes through nodes, and through the middles of faces.
inline double ties(const Point& x) {
    return (x[0] + x[1] - x[2]) * (1 + x[0] * x[0] + x[1] * x[1]);
}
/// Touches faces of cells at 0.
inline double tangent(const Point& x) { return x[0] * x[0] + x[1] * x[1] * x[1] - x[2] * x[0]; }
inline double waves(const Point& x) {
    return std::cos(3 * x[0]) * std::cos(3 * x[1]) * std::cos(3 * x[2]) + 0.1;
}
template <int dim>
double square(const Point& x) {
    return x[0] * x[0] + x[1] * x[1] + (dim == 3 ? x[2] * x[2] : 0);
}

using Function = double (*)(const Point&);
inline constexpr std::array<Function, 4> functions{gyroid, ties, tangent, waves};

/// The data of a world, ready to be drawn.
template <class World, class Field>
struct DrawnWorld {
    static constexpr int dim = World::dimension;
    World world;
    Field field{world};
    HighOrder data{world, field};

    template <class... Arguments>
    explicit DrawnWorld(Arguments&&... arguments) : world{std::forward<Arguments>(arguments)...} {}

    /// Drawn as front ends do: leaves that the level set does not pass through are left out.
    Isosurface<dim> surface(double isovalue, VirtualOptions at,
                            const IsosurfaceOptions& options = {}) const {
        const double greatest = options.cap ? std::numeric_limits<double>::infinity() : isovalue;
        at.values.emplace({std::array{isovalue, greatest}});
        return surface_of_all(isovalue, at, options);
    }
    Isosurface<dim> surface_of_all(double isovalue, const VirtualOptions& at,
                                   const IsosurfaceOptions& options = {}) const {
        const VirtualRefinement fine(data, at);
        return isosurface<dim>(fine, isovalue, under(fine.criterion(), fine.bounds()), options);
    }
};

/// The greatest |U - isovalue| at 15 points of every triangle, or 5 of every segment; of large
/// surfaces, of about 2,000 of them. Points lie a little inwards: a leaf is looked for there.
template <class World, int dim = World::dimension>
double measured(const World& world, const Surface<World::dimension>& surface, double isovalue) {
    double greatest = 0;
    const std::size_t step = 1 + surface.simplices.size() / 2000;
    for (std::size_t s = 0; s < surface.simplices.size(); s += step) {
        const auto& simplex = surface.simplices[s];
        Point middle{0, 0, 0};
        for (const auto v : simplex) middle = middle + (1.0 / dim) * surface.vertices[v];
        for (int a = 0; a <= 4; ++a) {
            for (int b = 0; a + b <= (dim == 3 ? 4 : a); ++b) {
                const std::array<double, 3> weight{a / 4.0, dim == 3 ? b / 4.0 : 1 - a / 4.0,
                                                   1 - (a + b) / 4.0};
                Point x{0, 0, 0};
                for (std::size_t k = 0; k < std::size_t{dim}; ++k) {
                    x = x + weight[k] * surface.vertices[simplex[k]];
                }
                x = x + 1e-9 * (middle - x);
                greatest = std::max(greatest, std::abs(world(x) - isovalue));
            }
        }
    }
    return greatest;
}

/// |U - isovalue| <= bound, which is at most tolerance + jump where no element met the depth limit,
/// but for linear data, which are drawn as ever.
template <class Drawn>
void expect_bound(const Drawn& drawn, const Isosurface<Drawn::dim>& result, double isovalue,
                  double tolerance) {
    // Cuts stay 2^-20 of an edge away from its ends.
    const VirtualRefinement leaves(drawn.data, {.tolerance = 1, .values = {{}}});
    const double range = leaves.bounds().greatest() - leaves.bounds().least();
    EXPECT_LE(measured(drawn.world, result.surface, isovalue),
              result.error_bound + std::ldexp(std::max(4.0, range), -20));
    if (result.counts.limited != 0 || drawn.data.greatest_degree() == 1) return;
    EXPECT_LE(result.error_bound, (tolerance + drawn.data.jump()) * (1 + 1e-6));
}

/// The level set of a quadratic is a circle, and a sphere.
template <class Drawn>
void expect_round(const Drawn& drawn) {
    constexpr int dim = Drawn::dim;
    const double radius = 0.8;
    for (const double relative : {1e-2, 1e-3, 1e-4}) {
        // Millions of triangles.
        if (dim == 3 && relative < 1e-3 && !is_long_run()) continue;
        const double tolerance = radius * radius * (1 - (1 - relative) * (1 - relative));
        const auto result = drawn.surface(radius * radius, {tolerance, 9});
        expect_closed(result.surface);
        EXPECT_EQ(result.counts.limited, 0U);
        double off = 0;
        for (const auto& simplex : result.surface.simplices) {
            Point middle{0, 0, 0};
            for (const auto v : simplex) middle = middle + (1.0 / dim) * result.surface.vertices[v];
            off = std::max(off, std::abs(norm(middle) - radius));
        }
        for (const Point& x : result.surface.vertices)
            off = std::max(off, std::abs(norm(x) - radius));
        EXPECT_LE(off, relative * radius);
    }
}

}  // namespace nestgrid_test
