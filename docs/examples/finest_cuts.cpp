// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Linear cuts beside cuts on the finest pieces of edges, at the same number of triangles
// (docs/isosurface.md).
#include <cmath>
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/probe.hpp>

#include "bucky_ball.hpp"

using namespace nestgrid;

namespace {

/// The root mean square of |U - isovalue| at the vertices and in the middle of the triangles.
template <class Grid, class Field>
double root_mean_square(const Grid& grid, const Field& field, const Surface<3>& s,
                        double isovalue) {
    std::vector<Point> points = s.vertices;
    for (const auto& t : s.simplices) {
        points.push_back((1.0 / 3) * (s.vertices[t[0]] + s.vertices[t[1]] + s.vertices[t[2]]));
    }
    const ProbeResult found = probe(grid, field, points);
    double sum = 0;
    for (const double value : found.values) sum += (value - isovalue) * (value - isovalue);
    return std::sqrt(sum / static_cast<double>(points.size()));
}

}  // namespace

int main() {
    constexpr int n = 65;
    constexpr double isovalue = 0.275;
    const LatticeBisection<3> grid({.samples = {n, n, n}});
    const std::vector<float> samples = bucky_ball(n);
    const LatticeField field(grid, std::span<const float>(samples));
    const Prerolls prerolls(grid, field);
    const auto linear = isosurface<3>(prerolls, isovalue, {.max_triangles = 20'000});
    // [finest]
    const auto result = isosurface<3>(prerolls, isovalue, {.max_triangles = 20'000},
                                      {.cuts = Cuts::finest, .normals = true});
    // [finest]
    const double before = root_mean_square(grid, field, linear.surface, isovalue);
    const double after = root_mean_square(grid, field, result.surface, isovalue);
    std::printf("linear: %zu triangles, |U - C| %.4f (rms), at most %.3f\n",
                linear.surface.simplices.size(), before, linear.error_bound);
    std::printf("finest: %zu triangles, |U - C| %.4f (rms), at most %.3f\n",
                result.surface.simplices.size(), after, result.error_bound);
    return after < before ? 0 : 1;
}
