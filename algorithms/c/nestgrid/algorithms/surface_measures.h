/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Areas, volumes, integrals and fluxes of triangle surfaces and of their connected parts; of pieces
 * that ranks have drawn, those of the whole. They are exact for the triangles and for functions
 * that are linear on them. Codes, messages and results are as in isosurface.h. */
#ifndef NESTGRID_ALGORITHMS_SURFACE_MEASURES_H
#define NESTGRID_ALGORITHMS_SURFACE_MEASURES_H

#include <nestgrid/algorithms/isosurface.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Of a connected part of a surface, or of the whole. */
typedef struct nestgrid_measures {
    uint64_t triangles;
    double area;
    double area_vector[3]; /* 0 for a closed surface */
    /* Enclosed, positive around U >= C, negative around a cavity; means nothing where it is not
     * closed. */
    double volume;
    double flux;             /* out of U >= C; 0 where none was asked for */
    const double* integrals; /* of each attribute */
    int closed;              /* no edge belongs to one triangle only */
} nestgrid_measures;

/** The caller sets `size` to sizeof the struct, and no more of it is written. */
typedef struct nestgrid_surface_measures {
    size_t size;
    void* owner;
    nestgrid_measures whole;
    size_t component_count;
    /* In the order of their first triangles; with ranks in that of nestgrid_join. */
    const nestgrid_measures* components;
    const uint32_t* component_of; /* per triangle of the surface, or of the piece */
} nestgrid_surface_measures;

/** Measures a surface in space. Of a piece that was drawn with `ranks` all ranks call it, as
 * nestgrid_join, and get the same: the bits that one process gets.
 * \param flux_from the first of three attributes, a vector whose flux is asked for; -1 for none */
int nestgrid_measure_surface(const nestgrid_surface* surface, int flux_from,
                             nestgrid_surface_measures* out, char* message, size_t message_size);

/** Frees what nestgrid_measure_surface has returned. */
void nestgrid_surface_measures_free(nestgrid_surface_measures* measures);

#ifdef __cplusplus
}
#endif

#endif
