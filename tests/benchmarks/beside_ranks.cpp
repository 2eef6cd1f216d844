// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One surface of a forest that p8est distributes over MPI, twice: drawn where the leaves are and
// written as one file, and a piece a rank; and the forest written by p8est, for VTK to contour.
// beside_ranks.py runs this under mpirun, reads the files, and compares.
//     mpirun -n 4 beside_ranks folder [deepest level]
// Prints seconds, of the slowest rank, and triangles and open edges of nestgrid's surface.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <p8est_extended.h>
#include <p8est_vtk.h>

#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "p4est_wave.hpp"

using namespace nestgrid;
using p4est_wave::place;
using p4est_wave::wave;
using p4est_wave::Wave;

namespace {

/// Refines where the wave crosses zero, on one side of the cube two levels farther.
int crosses(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    const int deepest = *static_cast<const int*>(forest->user_pointer);
    const auto half = P8EST_QUADRANT_LEN(q->level) / 2;
    const Point middle =
        place(*forest, static_cast<std::uint32_t>(tree), {q->x + half, q->y + half, q->z + half});
    const double side = middle[0] + 0.3 * middle[1];
    const int most = side < 0.4 ? deepest - 2 : side < 0.75 ? deepest - 1 : deepest;
    return q->level < most && std::abs(wave(middle)) < 14.0 / (1 << q->level) ? 1 : 0;
}

/// Calls function(), and tells on rank 0 how long the slowest rank took.
template <class Function>
void timed(const char* name, const Function& function) {
    MPI_Barrier(MPI_COMM_WORLD);
    const double begin = MPI_Wtime();
    function();
    double seconds = MPI_Wtime() - begin;
    MPI_Allreduce(MPI_IN_PLACE, &seconds, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0) std::printf("%s %.4f\n", name, seconds);
}

/// Values at the corners of all leaves, as p8est's writer takes them.
sc_array_t* corner_values(const p8est_t& forest) {
    sc_array_t* const values = sc_array_new_count(
        sizeof(double), 8 * static_cast<std::size_t>(forest.local_num_quadrants));
    std::size_t i = 0;
    for (p4est_topidx_t t = forest.first_local_tree; t <= forest.last_local_tree; ++t) {
        sc_array_t& leaves = p8est_tree_array_index(forest.trees, t)->quadrants;
        for (std::size_t l = 0; l < leaves.elem_count; ++l) {
            const p8est_quadrant_t& q = *p8est_quadrant_array_index(&leaves, l);
            const auto length = P8EST_QUADRANT_LEN(q.level);
            for (unsigned k = 0; k < 8; ++k) {
                *static_cast<double*>(sc_array_index(values, i++)) = wave(
                    place(forest, static_cast<std::uint32_t>(t),
                          {q.x + ((k & 1U) != 0 ? length : 0), q.y + ((k & 2U) != 0 ? length : 0),
                           q.z + ((k & 4U) != 0 ? length : 0)}));
            }
        }
    }
    return values;
}

void write_forest(p8est_t* forest, const std::string& path) {
    sc_array_t* const values = corner_values(*forest);
    p8est_vtk_context_t* context = p8est_vtk_context_new(forest, path.c_str());
    p8est_vtk_context_set_scale(context, 1);
    context = p8est_vtk_write_header(context);
    context = p8est_vtk_write_cell_dataf(context, 0, 0, 1, 0, 0, 0, context);
    context = p8est_vtk_write_point_dataf(context, 1, 0, "wave", values, context);
    p8est_vtk_write_footer(context);
    sc_array_destroy(values);
}

void draw(const p8est_t* forest, const std::string& folder) {
    MpiRanks ranks(MPI_COMM_WORLD);
    JoinedPiece joined;
    Isosurface<3> piece;
    timed("nestgrid_seconds", [&] {
        const P4estGrid<3> mine(forest);
        const Distributed grid(mine, ranks);
        const DistributedField field(grid, Wave{&mine});
        piece = isosurface(grid, field, 0.0);
        joined = join_pieces(piece, grid);
        write_vtp(ranks, piece, joined, folder + "/surface.vtp");
    });
    write_pvtp(ranks, piece, joined, folder + "/pieces.pvtp");
    if (ranks.rank() != 0) return;
    std::printf("ranks %d\nleaves %lld\nnestgrid_triangles %llu\nnestgrid_open_edges %llu\n",
                ranks.size(), static_cast<long long>(forest->global_num_quadrants),
                static_cast<unsigned long long>(joined.simplices),
                static_cast<unsigned long long>(joined.open));
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    sc_init(MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    const std::string folder = argc > 1 ? argv[1] : ".";
    int deepest = argc > 2 ? std::atoi(argv[2]) : 6;
    p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
    p8est_t* const forest = p8est_new_ext(MPI_COMM_WORLD, cube, 0, 2, 1, 0, nullptr, &deepest);
    for (int level = 2; level < deepest; ++level) {
        p8est_refine(forest, 0, crosses, nullptr);
        p8est_partition(forest, 0, nullptr);
    }
    draw(forest, folder);
    timed("forest_seconds", [&] { write_forest(forest, folder + "/forest"); });
    p8est_destroy(forest);
    p8est_connectivity_destroy(cube);
    MPI_Finalize();
}
