/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Slices of grids of dimension 3 for C and Fortran codes. Vertices carry all components of the
 * field and of options->attributes; the error_bound is that of component 0. Without threshold,
 * error and budget the slice has all of the data, and needs no walk before.
 */
#ifndef NESTGRID_ALGORITHMS_SLICE_H
#define NESTGRID_ALGORITHMS_SLICE_H

#include <nestgrid/algorithms/isosurface.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A continuous function of position, whose zero is the slice. Functions return 0, or another
 * number where they fail. `size` is sizeof the struct as its author compiled it. */
typedef struct nestgrid_level_function {
    size_t size;
    const void* self; /* handed to every function */
    /* finite within the domain */
    int (*value)(const void* self, const double x[3], double* out);
    /* Optional: a bound of |value(x) - value(centre)| for all x within `radius` of the centre.
     * Without it all elements are searched. */
    int (*variation)(const void* self, const double centre[3], double radius, double* out);
    int affine; /* not 0: the function is affine */
} nestgrid_level_function;

/** The slice along the plane through a point, across a normal of any length but 0. Triangles are
 * oriented against the normal. Free the result with nestgrid_surface_free. */
int nestgrid_slice(const nestgrid_grid* grid, const nestgrid_field* field, const double through[3],
                   const double normal[3], const nestgrid_options* options, nestgrid_surface* out,
                   char* message, size_t message_size);

/** The slice along the zero of a function, oriented to where it is negative. */
int nestgrid_slice_along(const nestgrid_grid* grid, const nestgrid_field* field,
                         const nestgrid_level_function* function, const nestgrid_options* options,
                         nestgrid_surface* out, char* message, size_t message_size);

/** The boundary of a domain in space, oriented outwards: a closed surface, coloured as a slice. */
int nestgrid_boundary_surface(const nestgrid_grid* grid, const nestgrid_field* field,
                              const nestgrid_options* options, nestgrid_surface* out, char* message,
                              size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
