/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * How finely the algorithms draw for C and Fortran codes, what is kept, and on how many threads.
 */
#ifndef NESTGRID_ALGORITHMS_OPTIONS_H
#define NESTGRID_ALGORITHMS_OPTIONS_H

#include <nestgrid/algorithms/ranks.h>
#include <nestgrid/nestgrid.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What the threshold is compared with, at every node; docs/indicators.md tells them apart. */
enum {
    NESTGRID_OFFSET = 0, /* |U - mean of the parents|, in units of the data */
    NESTGRID_DEVIATION,  /* |U - P_S U| on elements, in units of the data */
    NESTGRID_NUMERICAL,  /* jumps of the gradient, in units of the data */
    NESTGRID_WAVELET,    /* coefficients of wavelets, in units of the data */
    NESTGRID_VISUAL,     /* differences of unit normals, 0 to 2 */
    NESTGRID_GEOMETRY,   /* |x - mean of the parents|, in units of length; of curved grids */
    NESTGRID_CUT,        /* the error of level sets, in units of the data; of these alone */
    NESTGRID_SLOPE,      /* their distance, estimated, in units of length; of these alone */
    NESTGRID_NORM        /* the Euclidean norm of the offsets of all components */
};

/** As many threads as the machine runs at a time. */
#define NESTGRID_ALL_THREADS (-1)

/** Indicators that are kept from one call to the next, by all calls that have them among their
 * options: further isosurfaces, slices or probes then need no walk over all of the grid before.
 * They belong to one grid and one field, told apart by `self`, whose values do not change
 * meanwhile. */
typedef struct nestgrid_prerolls nestgrid_prerolls;

/** A lens: elements have the size `finest` inside a domain at most, and may grow away from it. */
typedef struct nestgrid_lens {
    size_t size; /* sizeof the struct */
    void* self;
    /* Writes the distance of a point (3 numbers) from the domain, 0 inside it, and returns 0; or
     * another number where it fails. Called by several threads where several are asked for. */
    int (*distance)(void* self, const double* point, double* distance);
    double finest;   /* in units of length; 0 draws all there is */
    double coarsest; /* size far from the domain; 0: any */
    double slope;    /* by which sizes may grow with the distance; 0: 0.5 */
} nestgrid_lens;

/** A part of space in which another threshold holds. */
typedef struct nestgrid_region {
    size_t size; /* sizeof the struct */
    void* self;
    /* As of a lens: the region is where the distance is not positive. */
    int (*distance)(void* self, const double* point, double* distance);
    double threshold; /* inside, at least 0, in units of the indicator */
} nestgrid_region;

/** The options of all algorithms. A member that is 0 or NULL has its default, and so have all of
 * them where NULL is given in the place of the options. `size` is sizeof the struct as the caller
 * compiled it, so that it can grow. */
typedef struct nestgrid_options {
    size_t size;
    /* At least 0, in units of the indicator: what is smaller is projected away. */
    double threshold;
    /* Above 0, in units of the data, in the place of threshold and indicator: the data differ from
     * what is drawn by at most this. On level sets NESTGRID_CUT keeps it where all elements are
     * simplices; else NESTGRID_DEVIATION does. */
    double error;
    /* The most triangles (segments), in the place of a threshold: the least threshold that keeps
     * within it is found. Not for several isolines, nor for probes. */
    uint64_t max_triangles;
    int indicator; /* NESTGRID_OFFSET ... */
    /* 0: the calling thread alone. Else how many threads run at a time, or NESTGRID_ALL_THREADS;
     * functions of the tables are then called by several threads at once. Results do not depend on
     * it. */
    int threads;
    int normals;     /* not 0: normals of level sets */
    int cap;         /* not 0: isosurfaces are closed on the boundary, around U >= isovalue */
    int at_nodes;    /* not 0: vertices of isosurfaces lie at nodes in the place of slivers */
    int finest_cuts; /* not 0: edges are cut where the finest data pass through the level */
    int elements;    /* not 0: the element that each triangle comes from is kept */
    int reference;   /* not 0: so is the place in it of each corner of the triangle */
    /* Further fields on the grid: their components are attributes of vertices, or values at
     * points, behind those of the field. They are kept in its value_type. */
    const nestgrid_field* const* attributes;
    size_t attribute_count; /* of these fields */
    /* Called now and then with the numbers of elements so far, by one thread at a time; another
     * number than 0 ends the drawing, whose result is then a part. */
    int (*progress)(void* progress_data, uint64_t visited, uint64_t extracted);
    void* progress_data;
    nestgrid_prerolls* prerolls; /* that are used and added to; of isovalues the last are kept */
    /* Not 0: edges are taken away as long as the error, or what the threshold says, is kept; or
     * down to max_triangles with the least error. For isosurfaces in space, slices by planes and
     * height fields. */
    int collapse;
    /* Not 0: the threshold, of NESTGRID_SLOPE, is a distance that an isosurface in space and that
     * of all data keep there and back. */
    int keep_distance;
    /* At least 1; 0 stands for 1. Nodes move from their mean to their value between the threshold
     * and this many times it, so that surfaces change without jumps. */
    double blend;
    const nestgrid_lens* lens;
    /* How far a slice along a curved function that is collapsed may be from that of all data, in
     * units of length; 0: it keeps its place. */
    double slice_distance;
    const nestgrid_region* region;
    /* Above 0, in units of the data: triangles of slices are split until their colours follow the
     * data within this. */
    double colour_tolerance;
    /* The ranks of a grid that tells its `presence`: all call the same functions in the same order,
     * with the same options, and each gets its piece (docs/distributed.md). With prerolls, what
     * ranks share is kept, too: make other prerolls where the grid or its values have changed. */
    const nestgrid_ranks* ranks;
    /* Above 0, in units of length, beside an error: points of curved leaves are at most this far
     * from where they are drawn. 0: the same share of the diameter of the domain as the error is
     * of the range of the data. Refused where leaves are straight. */
    double position_error;
} nestgrid_options;

/** Makes empty prerolls. Returns 0, or another number and a sentence, as isosurface.h says. Free
 * them with nestgrid_prerolls_free. */
int nestgrid_prerolls_make(nestgrid_prerolls** out, char* message, size_t message_size);

/** Frees prerolls; NULL is allowed. */
void nestgrid_prerolls_free(nestgrid_prerolls* prerolls);

#ifdef __cplusplus
}
#endif

#endif
