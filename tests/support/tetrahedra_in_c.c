/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * A node is its three coordinates among the samples, 21 bits each, x lowest; an element its four
 * corners and its tag.
 */
#include "tetrahedra_in_c.h"

#include <string.h>

enum { BITS = 21, TAG = 4 };
static const uint64_t odd = 1 | (uint64_t)1 << BITS | (uint64_t)1 << 2 * BITS;

static const nestgrid_stencil new_node[3] = {
    {2, {0, 1}, {0.5, 0.5}, 0}, {2, {0, 2}, {0.5, 0.5}, 0}, {2, {0, 3}, {0.5, 0.5}, 0}};
/* By tag; the new node is number 4. */
static const nestgrid_child halves[3][2] = {
    {{NESTGRID_TETRAHEDRON, {0, 4, 2, 3}, 1}, {NESTGRID_TETRAHEDRON, {1, 4, 2, 3}, -1}},
    {{NESTGRID_TETRAHEDRON, {0, 1, 4, 3}, 1}, {NESTGRID_TETRAHEDRON, {1, 2, 4, 3}, 1}},
    {{NESTGRID_TETRAHEDRON, {0, 1, 2, 4}, 1}, {NESTGRID_TETRAHEDRON, {1, 2, 3, 4}, -1}}};
static const nestgrid_rule bisections[3] = {
    {"tag 1", NESTGRID_TETRAHEDRON, 1, &new_node[0], 2, halves[0]},
    {"tag 2", NESTGRID_TETRAHEDRON, 1, &new_node[1], 2, halves[1]},
    {"tag 3", NESTGRID_TETRAHEDRON, 1, &new_node[2], 2, halves[2]}};

static uint64_t at(uint64_t node, int d) { return node >> BITS * d & (((uint64_t)1 << BITS) - 1); }

static uint64_t number(const samples_in_c* of, uint64_t node) {
    const uint64_t n = of->cells + 1;
    return at(node, 0) + n * (at(node, 1) + n * at(node, 2));
}

/* Whether the edge between two nodes is halved: where all their distances are even. */
static uint64_t between(uint64_t a, uint64_t b) {
    return ((a ^ b) & odd) != 0 ? NESTGRID_NO_NODE : (a + b) >> 1;
}
static uint64_t new_node_of(const nestgrid_element* e) {
    return between(e->word[0], e->word[e->word[TAG]]);
}

static int coarse_count(const void* self, size_t* count) {
    (void)self;
    *count = 6;
    return 0;
}

/* The i-th path along the edges of the cube, from its first to its last corner. */
static void coarse_nodes(const samples_in_c* of, size_t i, uint64_t node[4]) {
    static const int paths[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1},
                                    {2, 0, 1}, {1, 2, 0}, {2, 1, 0}};
    node[0] = 0;
    for (int k = 0; k < 3; ++k) node[k + 1] = node[k] + (of->cells << BITS * paths[i][k]);
}

static int node_positions(const void* self, size_t count, const uint64_t* nodes, double (*x)[3]) {
    (void)self;
    for (size_t i = 0; i < count; ++i) {
        for (int d = 0; d < 3; ++d) x[i][d] = (double)at(nodes[i], d);
    }
    return 0;
}

static int node_keys(const void* self, size_t count, const uint64_t* nodes, uint64_t* keys) {
    const samples_in_c* of = (const samples_in_c*)self;
    for (size_t i = 0; i < count; ++i) keys[i] = number(of, nodes[i]);
    return 0;
}

static int node_values(const void* self, size_t count, const uint64_t* nodes, const uint64_t* keys,
                       void* values) {
    const samples_in_c* of = (const samples_in_c*)self;
    (void)nodes;
    for (size_t i = 0; i < count; ++i) ((float*)values)[i] = of->samples[keys[i]];
    return 0;
}

/* Central differences of samples, one-sided at the boundary. */
static int node_gradients(const void* self, size_t count, const uint64_t* nodes,
                          double (*out)[3]) {
    const samples_in_c* of = (const samples_in_c*)self;
    for (size_t i = 0; i < count; ++i) {
        for (int d = 0; d < 3; ++d) {
            const uint64_t up = at(nodes[i], d) < of->cells ? 1 : 0;
            const uint64_t down = at(nodes[i], d) > 0 ? 1 : 0;
            const uint64_t above = number(of, nodes[i] + (up << BITS * d));
            const uint64_t below = number(of, nodes[i] - (down << BITS * d));
            const double rise = (double)of->samples[above] - (double)of->samples[below];
            out[i][d] = up + down == 2 ? 0.5 * rise : rise;
        }
    }
    return 0;
}

static int middles(const void* self, size_t count, const uint64_t* a, const uint64_t* b,
                   uint64_t* out) {
    (void)self;
    for (size_t i = 0; i < count; ++i) out[i] = between(a[i], b[i]);
    return 0;
}

static int coarse(const void* self, void* context, size_t i, nestgrid_coarse* out) {
    static const int orientation[6] = {1, -1, -1, 1, 1, -1};
    const samples_in_c* of = (const samples_in_c*)self;
    (void)context;
    memset(out, 0, sizeof *out);
    coarse_nodes(of, i, out->element.word);
    out->element.word[TAG] = 3;
    out->shape = NESTGRID_TETRAHEDRON;
    out->orientation = orientation[i];
    node_keys(self, 4, out->element.word, out->ids);
    return node_positions(self, 4, out->element.word, out->corners);
}

static int split(const void* self, void* context, const nestgrid_element* e, int* rule) {
    (void)self;
    (void)context;
    *rule = new_node_of(e) == NESTGRID_NO_NODE ? -1 : (int)e->word[TAG] - 1;
    return 0;
}

static int children(const void* self, void* context, const nestgrid_element* e, size_t count,
                    nestgrid_element* out) {
    const uint64_t tag = e->word[TAG];
    (void)self;
    (void)context;
    for (size_t c = 0; c < count; ++c) {
        memset(&out[c], 0, sizeof out[c]);
        for (int k = 0; k < 4; ++k) {
            const int from = halves[tag - 1][c].corner[k];
            out[c].word[k] = from == 4 ? new_node_of(e) : e->word[from];
        }
        out[c].word[TAG] = tag == 1 ? 3 : tag - 1;
    }
    return 0;
}

static int corner_keys(const void* self, void* context, const nestgrid_element* e, size_t count,
                       uint64_t* out) {
    (void)context;
    return node_keys(self, count, e->word, out);
}

static int new_keys(const void* self, void* context, const nestgrid_element* e, size_t count,
                    uint64_t* out) {
    const uint64_t node = new_node_of(e);
    (void)context;
    return node_keys(self, count, &node, out);
}

static int corner_positions(const void* self, void* context, const nestgrid_element* e,
                            size_t count, double (*out)[3]) {
    (void)context;
    return node_positions(self, count, e->word, out);
}

/* Face i lies opposite to corner i: in a plane that all corners but that one are in. */
static int boundary_faces(const void* self, void* context, const nestgrid_element* e,
                          unsigned* faces) {
    const samples_in_c* of = (const samples_in_c*)self;
    (void)context;
    *faces = 0;
    for (int d = 0; d < 3; ++d) {
        for (uint64_t plane = 0; plane <= of->cells; plane += of->cells) {
            int apart = 0;
            int corner = 0;
            for (int k = 0; k < 4; ++k) {
                if (at(e->word[k], d) == plane) continue;
                ++apart;
                corner = k;
            }
            if (apart == 1) *faces |= 1U << corner;
        }
    }
    return 0;
}

static int coarse_values(const void* self, void* context, size_t i, size_t count, void* out,
                         uint64_t* missing) {
    uint64_t nodes[4];
    uint64_t keys[4];
    (void)context;
    *missing = 0;
    coarse_nodes((const samples_in_c*)self, i, nodes);
    node_keys(self, 4, nodes, keys);
    return node_values(self, count, nodes, keys, out);
}

static int new_values(const void* self, void* context, const nestgrid_element* e, uint64_t which,
                      size_t count, void* out, uint64_t* missing) {
    const uint64_t node = new_node_of(e);
    uint64_t key;
    (void)context;
    *missing = 0;
    if ((which & 1) == 0) return 0;
    node_keys(self, 1, &node, &key);
    return node_values(self, count, &node, &key, out);
}

nestgrid_grid tetrahedra_in_c(const samples_in_c* of) {
    nestgrid_grid t = {.size = sizeof t, .self = of, .dimension = 3};
    const uint64_t n = of->cells + 1;
    t.rule_count = 3;
    t.rules = bisections;
    t.coarse_count = coarse_count;
    t.coarse = coarse;
    t.split = split;
    t.children = children;
    t.corner_keys = corner_keys;
    t.new_keys = new_keys;
    t.node_count = n * n * n;
    t.corner_positions = corner_positions;
    t.conforming = 1;
    t.boundary_faces = boundary_faces;
    t.middles = middles;
    t.node_keys = node_keys;
    t.node_positions = node_positions;
    return t;
}

nestgrid_field samples_field_in_c(const samples_in_c* of) {
    nestgrid_field t = {.size = sizeof t, .self = of, .value_type = NESTGRID_FLOAT};
    t.components = 1;
    t.coarse_values = coarse_values;
    t.new_values = new_values;
    t.node_values = node_values;
    t.node_gradients = node_gradients;
    return t;
}
