// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every level set must be, and the fields that catch a wrong implementation: each of them is
// the only one that notices some omission. A sphere alone proves nothing.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

namespace nestgrid_test {

using namespace nestgrid;
using nestgrid::norm;  // ALBERTA has a global one

/// From everything to hardly anything, for fields of the order of 1.
inline constexpr std::array<double, 6> six_thresholds{0, 0.01, 0.1, 0.3, 1, 10};

/// In [0, 1), the same with every library.
inline double uniform(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

/// No open edge inside the domain, a manifold, one orientation.
inline void expect_closed(const Surface<3>& surface, bool capped = false) {
    const SurfaceReport report = surface_report(surface);
    EXPECT_EQ(report.open_edges, 0U);
    EXPECT_EQ(report.nonmanifold_edges, 0U);
    EXPECT_EQ(report.nonmanifold_vertices, 0U);
    EXPECT_EQ(report.misoriented_edges, 0U);
    EXPECT_EQ(report.boundary_edges, capped ? 0U : surface.boundary.size());
}

/// In two dimensions every vertex ends one segment and begins another, or lies on the boundary.
inline void expect_closed(const Surface<2>& lines, bool capped = false) {
    std::vector<int> begins(lines.vertices.size(), 0), ends(begins), boundary(begins);
    for (const auto& [a, b] : lines.simplices) {
        ++begins[a];
        ++ends[b];
    }
    for (const auto& [v] : lines.boundary) ++boundary[v];
    for (std::size_t v = 0; v < begins.size(); ++v) {
        EXPECT_LE(begins[v], 1);
        EXPECT_LE(ends[v], 1);
        EXPECT_EQ(begins[v] + ends[v] + (capped ? 0 : boundary[v]), 2);
    }
}

/// The attribute of every vertex is that of a function.
template <class Function>
void expect_colours(const Surface<3>& surface, Function&& f) {
    ASSERT_EQ(surface.attributes.size(), surface.vertices.size());
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        EXPECT_NEAR(surface.attributes[v], f(surface.vertices[v]), 1e-12);
    }
}

struct NodalSamples {
    std::string name;
    std::vector<double> values;
    bool generic;  ///< no value at the isovalue 0, nor so near that rounding places cuts
};

/// Values at nodes in the unit cube, to be cut at 0.
inline std::vector<NodalSamples> catching_fields(const std::vector<Point>& nodes, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<NodalSamples> fields;
    const auto add = [&](const char* name, bool generic, auto&& f) {
        NodalSamples samples{name, {}, generic};
        for (const Point& x : nodes) samples.values.push_back(f(x));
        fields.push_back(std::move(samples));
    };
    add("sphere", true, [](const Point& x) {
        return 0.36 - norm(x - Point{0.51, 0.49, x[2] == 0 ? 0 : 0.5});
    });
    add("gyroid", true, [](const Point& x) {
        const auto [a, b, c] = 9.0 * x;
        return std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) + std::sin(c) * std::cos(a) +
               1e-3;
    });
    add("noise", true, [&](const Point&) { return uniform(random) - 0.5; });
    add("plane through nodes and edges", false, [](const Point& x) { return x[0] + x[1] - 1; });
    add("plateau at the isovalue", false, [](const Point& x) {
        return std::max(0.0, norm(x - Point{0.5, 0.5, 0.5}) - 0.3);
    });
    add("integers", false, [&](const Point&) { return static_cast<double>(random() % 3) - 1; });
    add("saddle", true, [&](const Point& x) {
        return (x[0] - 0.51) * (x[1] - 0.47) + 0.3 * (x[2] - 0.5) * (x[0] - 0.4) +
               1e-3 * (uniform(random) - 0.5);
    });
    add("5 units in the last place", false,
        [&](const Point&) { return (static_cast<double>(random() % 11) - 5) * 0x1p-52; });
    add("tiny", false, [&](const Point&) {
        return (random() % 2 == 0 ? -1 : 1) * std::pow(10, -18 * uniform(random));
    });
    add("checkerboard of every level", true, [&](const Point& x) {
        int sum = 0;  // of the coordinates on the coarsest lattice that has the node
        for (const double at : x) {
            double q = at;
            while (q != std::floor(q) && std::abs(q) < 4096) q *= 2;
            sum += static_cast<int>(q);
        }
        return (sum % 2 == 0 ? -1 : 1) * (0.1 + uniform(random));
    });
    return fields;
}

}  // namespace nestgrid_test
