// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fewer triangles of the same error (docs/collapse.md), and a distance that is kept
// (docs/error.md).
#include <algorithm>
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "bucky_ball.hpp"

using namespace nestgrid;

int main() {
    constexpr int n = 33;
    constexpr double isovalue = 0.275;
    const LatticeBisection<3> grid({.samples = {n, n, n}});
    const std::vector<float> samples = bucky_ball(n);
    const LatticeField field(grid, std::span<const float>(samples));
    // [collapse]
    constexpr double error = 0.02;
    const HierarchicalIndicator deviations(grid, field, NodeError::deviation);
    auto surface =
        isosurface(grid, field, isovalue, under(deviations, collapse_start * error)).surface;
    const std::size_t drawn = surface.simplices.size();
    const Collapsed collapsed =
        collapse(surface, erase(grid, field), isovalue, deviations, {.error = error});
    // [collapse]
    std::printf("%zu triangles, then %zu, |U - C| <= %.3f\n", drawn, surface.simplices.size(),
                collapsed.error);
    // [colours]
    const Plane plane({16, 16, 16}, {1, 2, 3});
    Surface<3> coloured = slice(grid, field, plane, under(deviations, error / 2)).surface;
    const std::size_t in_slice = coloured.simplices.size();
    const Collapsed kept =
        collapse_colours(coloured, erase(grid, field), deviations, {.errors = {error}});
    // [colours]
    std::printf("a slice of %zu triangles, then %zu, colours within %.3f\n", in_slice,
                coloured.simplices.size(), kept.error);
    // [curved]
    const Sphere sphere({16, 16, 16}, 9);
    const Surface<3> all = slice(grid, field, sphere).surface;
    Surface<3> curved = all;
    const Collapsed moved = collapse_colours(curved, erase(grid, field), deviations,
                                             {.errors = {error}, .nearness = Nearness{all, 0.5}});
    // [curved]
    std::printf("a sphere of %zu triangles, then %zu, colours within %.3f\n", all.simplices.size(),
                curved.simplices.size(), moved.error);
    // [measure]
    const auto whole = isosurface(grid, field, isovalue).surface;
    const MeasuredError measured = measure_error({grid, field}, surface, whole, isovalue);
    // [measure]
    std::printf("measured: |U - C| <= %.3f, distances %.4f there, %.4f back\n",
                measured.value.greatest, measured.distance.greatest, measured.back.greatest);
    // [within]
    constexpr double distance = 0.5;
    const Surface<3> finest = isosurface(grid, field, isovalue, under(Exact{}, deviations)).surface;
    const auto slopes =
        slope_deviations({grid, field}, std::span<const double>(&isovalue, 1), deviations);
    const IsosurfaceWithin within =
        isosurface_within(erase(grid, field), isovalue, {finest, distance},
                          Threshold(&slopes, distance), deviations, {.cuts = Cuts::finest});
    // [within]
    const MeasuredError off =
        measure_error({grid, field}, within.isosurface.surface, finest, isovalue);
    std::printf("%zu of %zu triangles, distances %.4f there, %.4f back\n",
                within.isosurface.surface.simplices.size(), finest.simplices.size(),
                off.distance.greatest, off.back.greatest);
    // [nearness]
    const Nearness near{finest, distance};
    Surface<3> fewer =
        isosurface_within(erase(grid, field), isovalue, {finest, distance / 2},
                          Threshold(&slopes, distance / 2), deviations, {.cuts = Cuts::finest})
            .isosurface.surface;
    collapse(fewer, erase(grid, field), isovalue, deviations, {.nearness = near});
    // [nearness]
    const MeasuredError left = measure_error({grid, field}, fewer, finest, isovalue);
    std::printf("%zu of them left, distances %.4f there, %.4f back\n", fewer.simplices.size(),
                left.distance.greatest, left.back.greatest);
    // [budget]
    const auto few = isosurface(
        grid, field, isovalue, {.max_triangles = 2000, .indicator = "deviation", .collapse = true});
    // [budget]
    std::printf("%zu triangles at an error of %.4f\n", few.surface.simplices.size(),
                few.search.threshold);
    const SurfaceReport report = surface_report(surface);
    const bool keeps = measured.value.greatest <= error && collapsed.error <= error &&
                       std::max(off.distance.greatest, off.back.greatest) <= distance &&
                       std::max(left.distance.greatest, left.back.greatest) <= distance &&
                       few.surface.simplices.size() <= 2000;
    return report.closed() && report.manifold() && keeps ? 0 : 1;
}
