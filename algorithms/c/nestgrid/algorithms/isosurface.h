/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Isosurfaces and check_grid for C and Fortran codes; link nestgrid::c.
 */
#ifndef NESTGRID_ALGORITHMS_ISOSURFACE_H
#define NESTGRID_ALGORITHMS_ISOSURFACE_H

#include <nestgrid/nestgrid.h>

#ifdef __cplusplus
extern "C" {
#endif

/** An indexed surface: triangles on grids of dimension 3, segments on those of dimension 2. */
typedef struct nestgrid_surface {
    size_t vertex_count;
    const double* vertices; /* 3 per vertex */
    size_t simplex_count;
    const uint32_t* simplices; /* `dimension` vertices per simplex */
    int dimension;
    double error_bound; /* on the surface the data differ from the isovalue by at most this */
    uint64_t visited;   /* elements that passed the test of interest */
    uint64_t extracted; /* elements that contribute */
    /* What the range of the data alone promises of any surface; error_bound is never more. */
    double range_bound;
    int bound_says_nothing; /* 1 where error_bound promises no more than that */
    void* owner;
} nestgrid_surface;

/** The isosurface of a field of one component under the hierarchical indicator with the given
 * threshold, in units of the data. Returns 0, or another number and a sentence in `message`, which
 * has room for message_size characters and may be NULL; the surface is then empty. Free the result
 * with nestgrid_surface_free. */
int nestgrid_isosurface(const nestgrid_grid* grid, const nestgrid_field* field, double isovalue,
                        double threshold, nestgrid_surface* out, char* message,
                        size_t message_size);

/** Frees what nestgrid_isosurface has returned. */
void nestgrid_surface_free(nestgrid_surface* surface);

/** Walks the hierarchy: 0 where it keeps the contract, else another number and the first violation
 * as a sentence in `message`. */
int nestgrid_check_grid(const nestgrid_grid* grid, const nestgrid_field* field, char* message,
                        size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
