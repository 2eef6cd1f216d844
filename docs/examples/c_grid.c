/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * A grid in plain C: a square cut into triangles, each refined into four as long as the circle
 * passes close by, so that hanging nodes occur. An element stores its corners and its level;
 * nothing else exists in memory.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <nestgrid/algorithms/isosurface.h>

enum { LEVELS = 7 };

typedef struct {
    float x[3][2]; /* multiples of 2^-LEVELS: exact */
    int level;
} triangle;

static const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
static const int coarse_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};

/* Refinement into four, the new nodes 3, 4, 5 being the midpoints of the edges 01, 12, 20. */
static const nestgrid_stencil midpoints[3] = {
    {2, {0, 1}, {0.5, 0.5}, 0}, {2, {1, 2}, {0.5, 0.5}, 0}, {2, {2, 0}, {0.5, 0.5}, 0}};
static const nestgrid_child quarters[4] = {{NESTGRID_TRIANGLE, {0, 3, 5}, 1},
                                           {NESTGRID_TRIANGLE, {3, 1, 4}, 1},
                                           {NESTGRID_TRIANGLE, {5, 4, 2}, 1},
                                           {NESTGRID_TRIANGLE, {3, 4, 5}, 1}};
static const nestgrid_rule red = {"red", NESTGRID_TRIANGLE, 3, midpoints, 4, quarters};

static triangle load(const nestgrid_element* e) {
    triangle t;
    memcpy(&t, e, sizeof t);
    return t;
}

static void all_nodes(const triangle* t, float x[6][2]) {
    memcpy(x, t->x, sizeof t->x);
    for (int n = 0; n < 3; ++n) {
        for (int d = 0; d < 2; ++d) x[3 + n][d] = (x[n][d] + x[(n + 1) % 3][d]) / 2;
    }
}

static double circle(const float x[2]) { return hypot(x[0] - 0.4, x[1] - 0.55); }

static int coarse_count(const void* self, size_t* count) {
    (void)self;
    *count = 2;
    return 0;
}

static int coarse(const void* self, void* context, size_t i, nestgrid_coarse* out) {
    triangle t = {{{0, 0}, {0, 0}, {0, 0}}, 0};
    (void)self;
    (void)context;
    memset(out, 0, sizeof *out);
    for (int k = 0; k < 3; ++k) {
        const int node = coarse_triangles[i][k];
        for (int d = 0; d < 2; ++d) out->corners[k][d] = t.x[k][d] = square[node][d];
        out->ids[k] = (uint64_t)node;
    }
    memcpy(&out->element, &t, sizeof t);
    out->shape = NESTGRID_TRIANGLE;
    out->orientation = 1;
    return 0;
}

static int split(const void* self, void* context, const nestgrid_element* e, int* rule) {
    const triangle t = load(e);
    const float centre[2] = {(t.x[0][0] + t.x[1][0] + t.x[2][0]) / 3,
                             (t.x[0][1] + t.x[1][1] + t.x[2][1]) / 3};
    (void)self;
    (void)context;
    *rule = t.level < LEVELS && fabs(circle(centre) - 0.3) < ldexp(1.5, -t.level) ? 0 : -1;
    return 0;
}

static int children(const void* self, void* context, const nestgrid_element* e, size_t count,
                    nestgrid_element* out) {
    const triangle t = load(e);
    float x[6][2];
    (void)self;
    (void)context;
    all_nodes(&t, x);
    for (size_t c = 0; c < count; ++c) {
        triangle child;
        for (int k = 0; k < 3; ++k) memcpy(child.x[k], x[quarters[c].corner[k]], sizeof x[0]);
        child.level = t.level + 1;
        memset(&out[c], 0, sizeof out[c]);
        memcpy(&out[c], &child, sizeof child);
    }
    return 0;
}

static int coarse_values(const void* self, void* context, size_t i, size_t count, void* out,
                         uint64_t* missing) {
    (void)self;
    (void)context;
    for (size_t k = 0; k < count; ++k) {
        ((double*)out)[k] = circle(square[coarse_triangles[i][k]]);
    }
    *missing = 0;
    return 0;
}

static int new_values(const void* self, void* context, const nestgrid_element* e, uint64_t which,
                      size_t count, void* out, uint64_t* missing) {
    const triangle t = load(e);
    float x[6][2];
    (void)self;
    (void)context;
    all_nodes(&t, x);
    for (size_t n = 0; n < count; ++n) {
        if (which >> n & 1) ((double*)out)[n] = circle(x[3 + n]);
    }
    *missing = 0;
    return 0;
}

int main(void) {
    char message[300] = "";
    nestgrid_grid grid = {.size = sizeof grid, .dimension = 2, .rule_count = 1, .rules = &red};
    nestgrid_field field = {.size = sizeof field, .value_type = NESTGRID_DOUBLE, .components = 1};
    grid.coarse_count = coarse_count;
    grid.coarse = coarse;
    grid.split = split;
    grid.children = children;
    field.coarse_values = coarse_values;
    field.new_values = new_values;

    if (nestgrid_check_grid(&grid, &field, message, sizeof message) != 0) {
        fprintf(stderr, "the grid is wrong: %s\n", message);
        return 1;
    }
    nestgrid_options options = {.size = sizeof options, .error = 1e-4, .threads = 2};
    nestgrid_surface line;
    if (nestgrid_isosurface_with(&grid, &field, 0.3, &options, &line, message, sizeof message)) {
        fprintf(stderr, "no isoline: %s\n", message);
        return 1;
    }
    double length = 0;
    for (size_t s = 0; s < line.simplex_count; ++s) {
        const double* a = line.vertices + 3 * line.simplices[2 * s];
        const double* b = line.vertices + 3 * line.simplices[2 * s + 1];
        length += hypot(b[0] - a[0], b[1] - a[1]);
    }
    printf("%zu segments, length %.6f, exact %.6f\n", line.simplex_count, length,
           2 * 3.14159265358979 * 0.3);
    const int good = fabs(length - 2 * 3.14159265358979 * 0.3) < 1e-3;
    nestgrid_surface_free(&line);
    return good ? 0 : 1;
}
