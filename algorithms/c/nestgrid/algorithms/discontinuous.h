/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Data that jump between elements, for C and Fortran codes: finite volumes, discontinuous Galerkin
 * methods, data in cells. Every element is drawn alone, with its own values, and no two share a
 * vertex.
 *
 * Of the options `threshold` and `error` say the same: elements stop where component 0 deviates by
 * this at most from the data of all leaves below them. `max_triangles` finds the least of them.
 * `threads`, `progress` and `elements` are as for other surfaces, the rest is refused. All threads
 * ask for values of leaves. Codes, messages and results are as in isosurface.h.
 */
#ifndef NESTGRID_ALGORITHMS_DISCONTINUOUS_H
#define NESTGRID_ALGORITHMS_DISCONTINUOUS_H

#include <nestgrid/algorithms/slice.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The values of each leaf at its own corners. `size` is sizeof the struct as its author compiled
 * it. */
typedef struct nestgrid_leaf_data {
    size_t size;
    const void* self; /* handed to every function */
    int components;   /* at least 1 */
    /* Component c at corner k of a leaf, k below `corners`, goes to out[k * components + c].
     * Returns 0, or another number where it fails. */
    int (*leaf_values)(const void* self, const nestgrid_element* leaf, size_t corners, double* out);
} nestgrid_leaf_data;

/** The elements of a grid of dimension 2, lifted along z by scale times component 0; the scale 0
 * gives a shading. Vertices carry all components. Free the result with nestgrid_surface_free. */
int nestgrid_discontinuous_height_field(const nestgrid_grid* grid, const nestgrid_leaf_data* data,
                                        double scale, const nestgrid_options* options,
                                        nestgrid_surface* out, char* message, size_t message_size);

/** The slice of a grid of dimension 3 along a plane, as nestgrid_slice. */
int nestgrid_discontinuous_slice(const nestgrid_grid* grid, const nestgrid_leaf_data* data,
                                 const double through[3], const double normal[3],
                                 const nestgrid_options* options, nestgrid_surface* out,
                                 char* message, size_t message_size);

/** The slice of a grid of dimension 3 along the zero of a function, as nestgrid_slice_along. */
int nestgrid_discontinuous_slice_along(const nestgrid_grid* grid, const nestgrid_leaf_data* data,
                                       const nestgrid_level_function* function,
                                       const nestgrid_options* options, nestgrid_surface* out,
                                       char* message, size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
