// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A forest of p8est on one process, refined, and one closed surface of it: what p4est_ranks.cpp
// does on many. A test counts the lines that are new there (docs/distributed.md).
#include <cstdio>
#include <cstdlib>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "p4est_wave.hpp"

using namespace p4est_wave;

namespace {

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
