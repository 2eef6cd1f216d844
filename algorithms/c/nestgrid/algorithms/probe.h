/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Values at points for C and Fortran codes. All points of one call descend through the hierarchy in
 * one walk: ask for many at once.
 */
#ifndef NESTGRID_ALGORITHMS_PROBE_H
#define NESTGRID_ALGORITHMS_PROBE_H

#include <nestgrid/algorithms/options.h>

#ifdef __cplusplus
extern "C" {
#endif

/** No element, where the index of one is expected: the point lies outside the grid. */
#define NESTGRID_NO_ELEMENT UINT32_MAX

/** Values at points, in the order of the points. The caller sets `size` to sizeof the struct, and
 * no more of it is written. */
typedef struct nestgrid_probed {
    size_t size;
    void* owner;
    size_t point_count;
    size_t found; /* how many of them lie in the grid */
    size_t component_count;
    const double* values;       /* component_count per point; not a number outside the grid */
    const int* levels;          /* of the element around each point; -1 outside the grid */
    const uint32_t* element_of; /* that element, an index into elements from 0 */
    const double* reference;    /* 3 per point: its place in the reference element (shape.hpp) */
    size_t element_count;
    const nestgrid_element* elements; /* the grid's own */
    const uint8_t* shapes;            /* one per element: NESTGRID_TRIANGLE ... */
} nestgrid_probed;

/** All components of a field, and of options->attributes, at points. Of the options threshold,
 * error, indicator and attributes count; without threshold and error the values are those of the
 * data, and need no walk before. Free the result with nestgrid_probed_free.
 * \param points 3 coordinates per point, `count` points */
int nestgrid_probe(const nestgrid_grid* grid, const nestgrid_field* field, const double* points,
                   size_t count, const nestgrid_options* options, nestgrid_probed* out,
                   char* message, size_t message_size);

/** Frees what nestgrid_probe has returned. */
void nestgrid_probed_free(nestgrid_probed* probed);

#ifdef __cplusplus
}
#endif

#endif
