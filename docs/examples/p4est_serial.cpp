// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A forest of p8est on one process, refined, and one closed surface of it: what p4est_ranks.cpp
// does on many. A test counts the lines that are new there (docs/distributed.md).
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <p8est_extended.h>

#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

using namespace nestgrid;

namespace {

/// Waves around a point of the cube.
double wave(const Point& x) { return std::sin(14 * norm(x - Point{0.5, 0.4, 0.45})); }

Point place(const p8est_t& forest, std::uint32_t tree, const std::array<std::int32_t, 3>& at) {
    Point x;
    p8est_qcoord_to_vertex(forest.connectivity, static_cast<p4est_topidx_t>(tree), at[0], at[1],
                           at[2], x.data());
    return x;
}

/// Refines where the wave crosses zero.
int crosses(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    const auto half = P8EST_QUADRANT_LEN(q->level) / 2;
    const Point middle =
        place(*forest, static_cast<std::uint32_t>(tree), {q->x + half, q->y + half, q->z + half});
    return std::abs(wave(middle)) < 10.0 / (1 << q->level) ? 1 : 0;
}

/// What a solver has: a value at every corner of its leaves.
struct Wave {
    using value_type = double;
    using Element = P4estGrid<3>::Element;

    NodeMask coarse_values(std::size_t tree, std::span<double> out) const {
        NodeMask missing = 0;
        for (unsigned k = 0; k < 8; ++k) missing |= put(grid->coarse(tree).element, k, k, out);
        return missing;
    }
    NodeMask new_values(const Element& e, NodeMask, std::span<double> out) const {
        std::array<Element, 8> children;
        grid->children(e, children);
        NodeMask missing = 0;
        for (std::size_t n = 0; n < out.size(); ++n) {
            const auto [child, corner] = grid->split(e)->new_corner[n];
            missing |= put(children[child], corner, n, out);
        }
        return missing;
    }
    /// Puts the value at a corner into out[n]; none is missing.
    NodeMask put(const Element& e, unsigned k, std::size_t n, std::span<double> out) const {
        const auto length = P8EST_QUADRANT_LEN(e.level);
        std::array<std::int32_t, 3> at = e.anchor;
        for (unsigned d = 0; d < 3; ++d) at[d] += (k >> d & 1U) != 0 ? length : 0;
        out[n] = wave(place(grid->forest(), e.tree, at));
        return 0;
    }
    const P4estGrid<3>* grid;
};

void draw(p8est_t* forest) {
    const P4estGrid<3> grid(forest);
    const Wave field{&grid};
    const HierarchicalIndicator indicator(grid, field);
    const auto piece = isosurface(grid, field, 0.0, under(indicator, 0.02), {.cap = true});
    const SurfaceReport report = surface_report(piece.surface);
    const SurfaceMeasures whole = measure_surface(piece.surface).total;
    std::printf("%zu triangles, %zu open edges, ", report.triangles, report.open_edges);
    std::printf("|U| <= %.3f, area %.6f, volume %.6f\n", piece.error_bound, whole.area,
                whole.volume);
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    sc_init(MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    p8est_t* const forest = p8est_new_ext(MPI_COMM_WORLD, cube, 0, 2, 1, 0, nullptr, nullptr);
    for (int level = 2; level < 6; ++level) {
        p8est_refine(forest, 0, crosses, nullptr);
    }
    draw(forest);
    p8est_destroy(forest);
    p8est_connectivity_destroy(cube);
    MPI_Finalize();
}
