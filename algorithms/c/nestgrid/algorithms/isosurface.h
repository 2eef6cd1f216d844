/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Isosurfaces, height fields and check_grid for C and Fortran codes; link nestgrid::c.
 *
 * All functions here and in the headers beside return 0, or another number and a sentence in
 * `message`, which has room for message_size characters and may be NULL; the result is then empty.
 */
#ifndef NESTGRID_ALGORITHMS_ISOSURFACE_H
#define NESTGRID_ALGORITHMS_ISOSURFACE_H

#include <nestgrid/algorithms/options.h>
#include <nestgrid/nestgrid.h>

#ifdef __cplusplus
extern "C" {
#endif

/** An indexed surface: triangles on grids of dimension 3, segments on those of dimension 2. What
 * more is known of it, nestgrid_details tells: this struct has no size and cannot grow. */
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

/** What else is known of a surface. Pointers are NULL where options did not ask for what they point
 * to, and are valid as long as the surface. The caller sets `size` to sizeof the struct, and no
 * more of it is written. */
typedef struct nestgrid_surface_details {
    size_t size;
    const double* normals; /* 3 per vertex, of unit length */
    size_t attribute_count;
    const double* attributes; /* attribute_count per vertex */
    size_t element_count;
    const nestgrid_element* elements; /* the grid's own */
    const uint8_t* shapes;            /* one per element: NESTGRID_TRIANGLE ... */
    const uint16_t* levels;           /* one per element; 0 on the coarse grid */
    const uint32_t* element_of;       /* one per simplex, an index into elements from 0 */
    /* 3 per corner of a simplex: its place in the reference element (shape.hpp). Not a number for
     * the few that fill a gap in a face. */
    const double* reference;
    size_t boundary_count;
    const uint32_t* boundary; /* `dimension` - 1 vertices per edge (point) on the boundary */
    double threshold;         /* that was kept, in units of the indicator */
    /* NESTGRID_CUT: the error that was kept, there and back. Infinity with other indicators. */
    double surface_error;
    int cancelled;           /* 1 where progress ended it: the surface is a part */
    const char* budget_text; /* why there are fewer than max_triangles, a sentence or "" */
    /* On curved leaves no point of the surface is farther from its true place, in units of length;
     * of a height field, in the plane. 0 where leaves are straight. */
    double position_bound;
} nestgrid_surface_details;

/** The isosurface of a field of one component under the hierarchical indicator with the given
 * threshold, in units of the data. Free the result with nestgrid_surface_free. */
int nestgrid_isosurface(const nestgrid_grid* grid, const nestgrid_field* field, double isovalue,
                        double threshold, nestgrid_surface* out, char* message,
                        size_t message_size);

/** The isosurface of component 0 of a field. Vertices carry the other components and those of
 * options->attributes. */
int nestgrid_isosurface_with(const nestgrid_grid* grid, const nestgrid_field* field,
                             double isovalue, const nestgrid_options* options,
                             nestgrid_surface* out, char* message, size_t message_size);

/** Several isosurfaces of component 0 of a field in one walk: out[i], of `count`, is that of
 * isovalues[i]. Collapses, distances that are kept and a number of triangles do not go with it.
 * Free each of them; where this fails, all are empty. */
int nestgrid_isosurfaces(const nestgrid_grid* grid, const nestgrid_field* field, size_t count,
                         const double* isovalues, const nestgrid_options* options,
                         nestgrid_surface* out, char* message, size_t message_size);

/** The surface around low <= U < high inside the domain, for component 0 of a field: both
 * level sets, oriented away from the band, open on the boundary of the domain. Neither caps nor a
 * number of triangles go with it. */
int nestgrid_isoband(const nestgrid_grid* grid, const nestgrid_field* field, double low,
                     double high, const nestgrid_options* options, nestgrid_surface* out,
                     char* message, size_t message_size);

/** The graph of component 0 of a field on a grid of dimension 2, lifted along z by `scale` times
 * the component: triangles, whatever the dimension. `scale` 0 gives the plane itself. Vertices
 * carry all components. On the graph the data differ from what is drawn by error_bound at most. */
int nestgrid_height_field(const nestgrid_grid* grid, const nestgrid_field* field, double scale,
                          const nestgrid_options* options, nestgrid_surface* out, char* message,
                          size_t message_size);

/** A number that is measured all over a surface; 0 where that is empty. */
typedef struct nestgrid_measure_of {
    double greatest;
    double mean; /* over the area */
    double rms;
} nestgrid_measure_of;

/** How far an isosurface is from the data and from the isosurface of all data, which is drawn for
 * it. The caller sets `size` to sizeof the struct, and no more of it is written. */
typedef struct nestgrid_measured {
    size_t size;
    nestgrid_measure_of value;    /* |U - isovalue| on the surface, in units of the data */
    nestgrid_measure_of distance; /* from it to the surface of all data, in units of length */
    nestgrid_measure_of back;     /* from the surface of all data to it */
    double reach;                 /* no point of the surfaces is farther from those measured */
    uint64_t points;              /* that were measured */
} nestgrid_measured;

/** Measures an isosurface in space of component 0 of this field. Options say how many threads work,
 * and lend their prerolls.
 * \param points about how many, on each surface; 0 stands for 200,000 */
int nestgrid_measure(const nestgrid_grid* grid, const nestgrid_field* field,
                     const nestgrid_surface* surface, double isovalue, uint64_t points,
                     const nestgrid_options* options, nestgrid_measured* out, char* message,
                     size_t message_size);

/** Tells what else is known of a surface that one of these functions has returned. */
int nestgrid_details(const nestgrid_surface* surface, nestgrid_surface_details* out, char* message,
                     size_t message_size);

/** A piece that was drawn with `ranks` as a part of the whole surface. Totals are the same on all
 * ranks. The caller sets `size` to sizeof the struct, and no more of it is written. */
typedef struct nestgrid_joined {
    size_t size;
    void* owner;
    /* Per vertex of the piece: its number in the whole, and the rank that owns it, the least that
     * has it. Vertices of one owner follow each other, owners in the order of ranks. */
    const uint64_t* numbers;
    const int* owners;
    uint64_t vertices;   /* of the whole */
    uint64_t simplices;  /* of the whole */
    uint64_t components; /* connected parts of the whole */
    uint64_t open;       /* edges of one triangle alone, but for those on the boundary */
} nestgrid_joined;

/** Numbers the vertices of the pieces of a surface. All ranks call it, while the surface, the
 * self of `ranks` and the grid are as they were. Free the result with nestgrid_joined_free. */
int nestgrid_join(const nestgrid_surface* piece, nestgrid_joined* out, char* message,
                  size_t message_size);

/** Frees what nestgrid_join has returned. */
void nestgrid_joined_free(nestgrid_joined* joined);

/** Frees what nestgrid_isosurface, nestgrid_slice and others have returned. */
void nestgrid_surface_free(nestgrid_surface* surface);

/** Walks the hierarchy: 0 where it keeps the contract, else another number and the first violation
 * as a sentence in `message`. */
int nestgrid_check_grid(const nestgrid_grid* grid, const nestgrid_field* field, char* message,
                        size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
