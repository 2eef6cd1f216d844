/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Data of higher degree in plain C: 3 x 3 squares, each with a polynomial of degree 4 of its own,
 * which the table of the field evaluates. The isoline is drawn within an error of the polynomials.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <nestgrid/algorithms/isosurface.h>

enum { CELLS = 3, DEGREE = 4 };

/* A cell is its number. The field is (x^2 + y^2)^2, of degree 4 in each direction. */
static int number_of(const nestgrid_element* e) {
    int cell;
    memcpy(&cell, e, sizeof cell);
    return cell;
}

static double place(int index) { return -1 + 2.0 * index / CELLS; }

static double field_at(double x, double y) { return (x * x + y * y) * (x * x + y * y); }

static int coarse_count(const void* self, size_t* count) {
    (void)self;
    *count = CELLS * CELLS;
    return 0;
}

static int coarse(const void* self, void* context, size_t i, nestgrid_coarse* out) {
    const int cell = (int)i;
    (void)self;
    (void)context;
    memset(out, 0, sizeof *out);
    memcpy(&out->element, &cell, sizeof cell);
    out->shape = NESTGRID_QUADRILATERAL;
    out->orientation = 1;
    for (int k = 0; k < 4; ++k) {
        const int x = cell % CELLS + k % 2, y = cell / CELLS + k / 2;
        out->corners[k][0] = place(x);
        out->corners[k][1] = place(y);
        out->ids[k] = (uint64_t)(x + (CELLS + 1) * y);
    }
    return 0;
}

static int split(const void* self, void* context, const nestgrid_element* e, int* rule) {
    (void)self;
    (void)context;
    (void)e;
    *rule = -1; /* no cell is divided: all are leaves */
    return 0;
}

static int children(const void* self, void* context, const nestgrid_element* e, size_t count,
                    nestgrid_element* out) {
    (void)self;
    (void)context;
    (void)e;
    (void)count;
    (void)out;
    return 1;
}

static int coarse_values(const void* self, void* context, size_t i, size_t count, void* out,
                         uint64_t* missing) {
    (void)self;
    (void)context;
    for (size_t k = 0; k < count; ++k) {
        const int x = (int)i % CELLS + (int)k % 2, y = (int)i / CELLS + (int)k / 2;
        ((double*)out)[k] = field_at(place(x), place(y));
    }
    *missing = 0;
    return 0;
}

static int new_values(const void* self, void* context, const nestgrid_element* e, uint64_t which,
                      size_t count, void* out, uint64_t* missing) {
    (void)self;
    (void)context;
    (void)e;
    (void)count;
    (void)out;
    *missing = which;
    return 0;
}

/* [c_high_order] */
static int degree(const void* self, void* context, const nestgrid_element* leaf, int* out) {
    (void)self;
    (void)context;
    (void)leaf;
    *out = DEGREE;
    return 0;
}

static int evaluate(const void* self, void* context, const nestgrid_element* leaf, size_t count,
                    const double (*reference)[3], void* out) {
    const int cell = number_of(leaf);
    (void)self;
    (void)context;
    for (size_t i = 0; i < count; ++i) {
        const double* at = reference[i]; /* from 0 to 1 in each direction */
        ((double*)out)[i] = field_at(place(cell % CELLS) + at[0] * 2 / CELLS,
                                     place(cell / CELLS) + at[1] * 2 / CELLS);
    }
    return 0;
}
/* [c_high_order] */

int main(void) {
    const double radius = 0.8;
    const double isovalue = pow(radius, 4);
    char message[300] = "";
    nestgrid_grid grid = {.size = sizeof grid, .dimension = 2};
    nestgrid_field field = {.size = sizeof field, .value_type = NESTGRID_DOUBLE, .components = 1};
    grid.coarse_count = coarse_count;
    grid.coarse = coarse;
    grid.split = split;
    grid.children = children;
    field.coarse_values = coarse_values;
    field.new_values = new_values;
    field.degree = degree;
    field.evaluate = evaluate;

    if (nestgrid_check_grid(&grid, &field, message, sizeof message) != 0) {
        fprintf(stderr, "the grid is wrong: %s\n", message);
        return 1;
    }
    for (double error = 1e-1; error > 1e-5; error /= 10) {
        nestgrid_options options = {.size = sizeof options, .error = error, .threads = 1};
        nestgrid_surface line;
        if (nestgrid_isosurface_with(&grid, &field, isovalue, &options, &line, message,
                                     sizeof message)) {
            fprintf(stderr, "no isoline: %s\n", message);
            return 1;
        }
        double off = 0; /* from the circle */
        for (size_t v = 0; v < line.vertex_count; ++v) {
            const double* x = line.vertices + 3 * v;
            off = fmax(off, fabs(hypot(x[0], x[1]) - radius));
        }
        printf("error %.0e: %3zu segments, bound %.1e, %.1e from the circle\n", error,
               line.simplex_count, line.error_bound, off);
        /* The field grows by 4 r^3 per unit of length there. */
        const int good =
            line.error_bound <= error * (1 + 1e-6) && off <= 1.5 * error / (4 * pow(radius, 3));
        nestgrid_surface_free(&line);
        if (!good) return 1;
    }
    return 0;
}
