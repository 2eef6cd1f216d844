/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * nestgrid.h is C11, without extensions and without a warning, and what C codes rely on holds.
 */
#include <nestgrid/nestgrid.h>

_Static_assert(offsetof(nestgrid_grid, size) == 0, "the size comes first");
_Static_assert(offsetof(nestgrid_field, size) == 0, "the size comes first");
_Static_assert(sizeof(nestgrid_element) == 48, "an element has 48 bytes");

static int count_one(const void* self, size_t* count) {
    (void)self;
    *count = 1;
    return 0;
}

int main(void) {
    /* What is not named is absent. */
    const nestgrid_grid grid = {.size = sizeof grid, .dimension = 2, .coarse_count = count_one};
    const nestgrid_field field = {.size = sizeof field, .value_type = NESTGRID_DOUBLE};
    size_t count = 0;
    const int code = grid.coarse_count(grid.self, &count);
    const int absent = grid.corner_keys == NULL && grid.last_error == NULL &&
                       grid.conforming == 0 && field.corner_gradients == NULL;
    return code == 0 && count == 1 && absent ? 0 : 1;
}
