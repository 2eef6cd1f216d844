// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "p4est_octree.hpp"

#include <chrono>
#include <cmath>

#include <p8est_bits.h>
#include <p8est_extended.h>
#include <p8est_ghost.h>
#include <p8est_lnodes.h>

namespace {

int wanted_levels = 0;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

int at_sphere(p8est_t*, p4est_topidx_t, p8est_quadrant_t* q) {
    if (q->level >= wanted_levels) return 0;
    const double unit = 1.0 / P8EST_ROOT_LEN;
    const double half = 0.5 * P8EST_QUADRANT_LEN(q->level) * unit;
    const double x = q->x * unit + half - 0.5;
    const double y = q->y * unit + half - 0.5;
    const double z = q->z * unit + half - 0.5;
    return std::abs(std::sqrt(x * x + y * y + z * z) - 0.35) < half * std::sqrt(3.0) ? 1 : 0;
}

}  // namespace

P4estFigures refine_p4est_at_sphere(int levels) {
    int initialized = 0;
    MPI_Initialized(&initialized);
    if (initialized == 0) {
        MPI_Init(nullptr, nullptr);
        sc_init(MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_SILENT);
        p4est_init(nullptr, SC_LP_SILENT);
    }
    P4estFigures result;
    p8est_connectivity_t* cube = p8est_connectivity_new_unitcube();
    p8est_t* forest = p8est_new(MPI_COMM_WORLD, cube, 0, nullptr, nullptr);
    wanted_levels = levels;
    for (int level = 0; level < levels; ++level) {
        const double start = now();
        p8est_refine(forest, 0, at_sphere, nullptr);
        p8est_balance(forest, P8EST_CONNECT_EDGE, nullptr);
        result.seconds = now() - start;
    }
    result.leaves = static_cast<std::size_t>(forest->local_num_quadrants);
    result.forest_bytes = static_cast<double>(p8est_memory_used(forest));
    const double start = now();
    p8est_balance(forest, P8EST_CONNECT_FULL, nullptr);  // which lnodes demand
    p8est_ghost_t* ghost = p8est_ghost_new(forest, P8EST_CONNECT_FULL);
    p8est_lnodes_t* nodes = p8est_lnodes_new(forest, ghost, 1);
    result.node_seconds = now() - start;
    // Node numbers and a code of hanging corners per element.
    result.node_bytes = static_cast<double>(nodes->num_local_elements) *
                        (nodes->vnodes * static_cast<double>(sizeof(p4est_locidx_t)) +
                         static_cast<double>(sizeof(p8est_lnodes_code_t))) *
                        static_cast<double>(result.leaves) /
                        static_cast<double>(nodes->num_local_elements);
    p8est_lnodes_destroy(nodes);
    p8est_ghost_destroy(ghost);
    p8est_destroy(forest);
    p8est_connectivity_destroy(cube);
    return result;
}
