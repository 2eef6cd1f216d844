/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Isolines for C and Fortran codes, joined to lines: of grids of dimension 2, and on slices,
 * isosurfaces and height fields.
 */
#ifndef NESTGRID_ALGORITHMS_ISOLINES_H
#define NESTGRID_ALGORITHMS_ISOLINES_H

#include <nestgrid/algorithms/isosurface.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Lines through numbered vertices. Line i passes the vertices points[first[i]] to
 * points[first[i + 1] - 1], and a ring ends with the vertex it begins with. The function is higher
 * on its left. The caller sets `size` to sizeof the struct, and no more of it is written. */
typedef struct nestgrid_lines {
    size_t size;
    void* owner;
    size_t vertex_count;
    const double* vertices; /* 3 per vertex */
    size_t attribute_count;
    const double* attributes; /* attribute_count per vertex */
    size_t line_count;
    const size_t* first;    /* line_count + 1, into points, from 0 */
    const uint32_t* points; /* vertices, from 0 */
    const double* values;   /* of the function, one per line */
    /* On every line the data differ from its value by at most error_bound, and by range_bound
     * whatever is drawn; 0 on surfaces, whose own bounds count there. */
    double error_bound;
    double range_bound;
    uint64_t visited;   /* elements that passed the test of interest */
    uint64_t extracted; /* elements that contribute, once for each value */
    int cancelled;      /* 1 where progress ended it: the lines are a part */
    /* On curved leaves, as of nestgrid_surface_details; 0 on surfaces. */
    double position_bound;
} nestgrid_lines;

/** The isolines of component 0 of a field on a grid of dimension 2. Vertices carry the other
 * components and those of options->attributes. Free the result with nestgrid_lines_free.
 * \param values of the isolines, `count` of them */
int nestgrid_isolines(const nestgrid_grid* grid, const nestgrid_field* field, const double* values,
                      size_t count, const nestgrid_options* options, nestgrid_lines* out,
                      char* message, size_t message_size);

/** The lines on a surface of triangles on which one attribute of its vertices has given values.
 * Vertices carry all attributes.
 * \param attribute from 0 */
int nestgrid_surface_isolines(const nestgrid_surface* surface, size_t attribute,
                              const double* values, size_t count, nestgrid_lines* out,
                              char* message, size_t message_size);

/** Frees what the functions above have returned. */
void nestgrid_lines_free(nestgrid_lines* lines);

#ifdef __cplusplus
}
#endif

#endif
