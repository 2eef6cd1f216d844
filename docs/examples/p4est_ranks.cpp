// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A forest that p8est distributes over MPI, refined and repartitioned, and one closed surface of
// it: docs/distributed.md goes through it. Each rank draws its piece where the leaves are, and
// writes it into its part of one file; and into one of its own, where a list of these is asked for.
//     p4est_ranks [surface.vtp [surface.pvtp]]
#include <cstdio>
#include <cstdlib>

#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "p4est_wave.hpp"

using namespace p4est_wave;

namespace {

void draw(p8est_t* forest, const char* path, const char* list) {
    // [ranks]
    MpiRanks ranks(MPI_COMM_WORLD);
    const P4estGrid<3> mine(forest);                  // what this rank has
    const Distributed grid(mine, ranks);              // anew when the forest has changed
    const DistributedField field(grid, Wave{&mine});  // anew when the values have changed
    const HierarchicalIndicator indicator(grid, field);
    const auto piece = isosurface(grid, field, 0.0, under(indicator, 0.02), {.cap = true});
    // [ranks]
    // [file]
    const JoinedPiece joined = join_pieces(piece, grid);
    write_vtp(ranks, piece, joined, path);
    // [file]
    // [measures]
    const SurfaceMeasures whole = measure_pieces(piece, joined, grid).total;
    // [measures]
    if (list != nullptr) write_pvtp(ranks, piece, joined, list);
    if (ranks.rank() != 0) return;
    std::printf("%d ranks, %llu triangles, %llu open edges, ", ranks.size(),
                static_cast<unsigned long long>(joined.simplices),
                static_cast<unsigned long long>(joined.open));
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
        p8est_partition(forest, 0, nullptr);
    }
    draw(forest, argc > 1 ? argv[1] : "surface.vtp", argc > 2 ? argv[2] : nullptr);
    p8est_destroy(forest);
    p8est_connectivity_destroy(cube);
    MPI_Finalize();
}
