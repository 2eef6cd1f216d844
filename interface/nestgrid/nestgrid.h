/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * The interface as a table of C functions, for C and Fortran codes: what grid.hpp and
 * optional.hpp ask of a C++ class, with the same names and meaning. docs/examples/c_grid.c is a
 * complete grid.
 *
 * All functions are reentrant and return 0, or another number where they fail; nothing is thrown
 * through them. last_error says why in a sentence. `context` is what make_context returned for the
 * task that calls, NULL without it. Optional functions may be NULL. `out` has `count` places: as
 * many as the element has corners, or its rule new nodes or children. `size` is sizeof the table as
 * its author compiled it, so that tables can grow: what lies beyond it counts as NULL or 0.
 */
#ifndef NESTGRID_H
#define NESTGRID_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NESTGRID_SEGMENT = 1,
    NESTGRID_TRIANGLE,
    NESTGRID_QUADRILATERAL,
    NESTGRID_TETRAHEDRON,
    NESTGRID_PYRAMID,
    NESTGRID_PRISM,
    NESTGRID_HEXAHEDRON
};

enum { NESTGRID_FLOAT = 0, NESTGRID_DOUBLE = 1 };

/** No node, where the number of one is expected. */
#define NESTGRID_NO_NODE UINT64_MAX

/** An element is a value of its author's choice, copied bytewise. */
typedef struct nestgrid_element {
    uint64_t word[6];
} nestgrid_element;

/** A coarse element: its shape, corners and their ids. */
typedef struct nestgrid_coarse {
    nestgrid_element element;
    int shape;
    double corners[8][3];
    uint64_t ids[8];
    int orientation; /* -1 where the corners are numbered as in a mirror, else 1 */
} nestgrid_coarse;

/** A new node: the weighted mean of nodes of the rule, corners of the parent first. */
typedef struct nestgrid_stencil {
    int count;
    int parent[8];
    double weight[8];
    int number; /* tells apart stencils of equal parents and equal order of weights */
} nestgrid_stencil;

/** A child of a rule. */
typedef struct nestgrid_child {
    int shape;
    int corner[8]; /* nodes of the rule: corners of the parent, then new nodes */
    int orientation;
} nestgrid_child;

/** How an element is refined: its new nodes and its children. */
typedef struct nestgrid_rule {
    const char* name;
    int shape; /* of the parent */
    int new_node_count;
    const nestgrid_stencil* new_nodes;
    int child_count;
    const nestgrid_child* children;
} nestgrid_rule;

/** The questions to a grid. */
typedef struct nestgrid_grid {
    size_t size;
    const void* self; /* handed to every function */
    int dimension;    /* of the elements, 2 or 3 */

    /* All rules of the grid; checked before the first query. */
    int rule_count;
    const nestgrid_rule* rules;

    /* Required. */
    int (*coarse_count)(const void* self, size_t* count);
    int (*coarse)(const void* self, void* context, size_t i, nestgrid_coarse* out);
    /* *rule: the number of the rule that refines e, or -1 on a leaf */
    int (*split)(const void* self, void* context, const nestgrid_element* e, int* rule);
    int (*children)(const void* self, void* context, const nestgrid_element* e, size_t count,
                    nestgrid_element* out);

    /* Optional. */
    int (*corner_keys)(const void* self, void* context, const nestgrid_element* e, size_t count,
                       uint64_t* out);
    int (*new_keys)(const void* self, void* context, const nestgrid_element* e, size_t count,
                    uint64_t* out);
    size_t node_count; /* own keys lie below it; 0 where they are not dense */
    int (*corner_positions)(const void* self, void* context, const nestgrid_element* e,
                            size_t count, double (*out)[3]);
    int (*new_positions)(const void* self, void* context, const nestgrid_element* e, uint64_t which,
                         size_t count, double (*out)[3]);
    int (*constrained)(const void* self, void* context, const nestgrid_element* e, uint64_t* nodes);
    int conforming; /* not 0: no node hangs */
    int (*masked)(const void* self, void* context, const nestgrid_element* e, int* is_masked);
    /* *part: 0 where e is shown, 1 where it is hidden in part, 2 where it is hidden */
    int (*hidden)(const void* self, void* context, const nestgrid_element* e, int* part);
    int (*outside)(const void* self, void* context, const nestgrid_element* e, uint64_t* nodes);
    int (*boundary_faces)(const void* self, void* context, const nestgrid_element* e,
                          unsigned* faces);
    int (*epoch)(const void* self, uint64_t* epoch);
    void* (*make_context)(const void* self); /* NULL: it failed */
    void (*free_context)(const void* self, void* context);

    /* Optional, all of the following: what makes bisections fast, for it is asked of many nodes at
     * once (tests/support/tetrahedra_in_c.c is an example). A grid may tell them whose elements are
     * nothing but their corners, halved as Maubach (1995) does: word[k] of an element is the node
     * at its corner k, a number of the author's choice, and word[dimension + 1] its tag t, 1 to
     * dimension. Where it is split, the new node z lies between the corners 0 and t, and the
     * children, in this order, have the corners
     *     x0 ... x(t-1)  z  x(t+1) ... xn    and    x1 ... xt  z  x(t+1) ... xn
     * and the tag t - 1, or dimension after 1; the second one is mirrored where t is odd. Those of
     * the tag dimension are split dimension times over, into elements of which all are split or
     * none. corner_keys, new_keys, corner_positions and boundary_faces are there too, `conforming`
     * is not 0, and masked, hidden, outside and presence are NULL. */
    /* the node halfway between a[i] and b[i], the corners 0 and t of an element in either order, or
     * NESTGRID_NO_NODE where it is not split; out may be a */
    int (*middles)(const void* self, size_t count, const uint64_t* a, const uint64_t* b,
                   uint64_t* out);
    int (*node_keys)(const void* self, size_t count, const uint64_t* nodes, uint64_t* out);
    int (*node_positions)(const void* self, size_t count, const uint64_t* nodes, double (*out)[3]);

    /* Optional. A sentence that says why the function failed that this thread called last, with the
     * same context (NULL where that function takes none); or NULL. It stays valid until the thread
     * calls another function of the table. Callers of the library receive it as text. */
    const char* (*last_error)(const void* self, void* context);

    /* Optional, with corner_keys and new_keys: the keys of the nodes in whose middle a node hangs
     * on an edge of a leaf, or twice its own key (hanging_parents in optional.hpp). */
    int (*hanging_parents)(const void* self, uint64_t node, uint64_t out[2]);

    /* Optional, where the grid is distributed: which leaves below e this process has. *which: 0
     * for all, 1 for some and the first one, 2 for some others, 3 for none. */
    int (*presence)(const void* self, void* context, const nestgrid_element* e, int* which);

    /* Optional, both or neither; asked of leaves alone. The degree of the polynomials that are the
     * coordinates of points in a leaf, 1 to 8, and where `count` points of its reference element
     * are. */
    int (*geometry_degree)(const void* self, void* context, const nestgrid_element* leaf,
                           int* degree);
    int (*map)(const void* self, void* context, const nestgrid_element* leaf, size_t count,
               const double (*reference)[3], double (*out)[3]);
} nestgrid_grid;

/** The questions to a field. Values are float or double as value_type says; component c of node n
 * goes to out[n * components + c], n below count. *missing receives the nodes that could not be
 * given, one bit each. */
typedef struct nestgrid_field {
    size_t size;
    const void* self;
    int value_type;
    int components;
    int (*coarse_values)(const void* self, void* context, size_t i, size_t count, void* out,
                         uint64_t* missing);
    int (*new_values)(const void* self, void* context, const nestgrid_element* e, uint64_t which,
                      size_t count, void* out, uint64_t* missing);

    /* Optional. */
    int (*corner_gradients)(const void* self, void* context, const nestgrid_element* e,
                            size_t count, double (*out)[3]);

    /* Optional, with the `middles` of the grid. */
    int (*node_values)(const void* self, size_t count, const uint64_t* nodes, const uint64_t* keys,
                       void* out);

    /* Optional, as that of the grid. */
    const char* (*last_error)(const void* self, void* context);

    /* Optional, with node_values: gradients of component 0 at nodes, per unit length. They make
     * isosurfaces with normals as fast as without. Where there are corner_gradients, too, these are
     * the same. */
    int (*node_gradients)(const void* self, size_t count, const uint64_t* nodes, double (*out)[3]);

    /* Optional, both or neither; asked of leaves alone, and not where there are further fields. The
     * degree of the polynomials of a leaf, 1 to 8, and the field at `count` points of the reference
     * element: component c of point n goes to out[n * components + c]. */
    int (*degree)(const void* self, void* context, const nestgrid_element* leaf, int* degree);
    int (*evaluate)(const void* self, void* context, const nestgrid_element* leaf, size_t count,
                    const double (*reference)[3], void* out);
} nestgrid_field;

#ifdef __cplusplus
}
#endif

#endif
