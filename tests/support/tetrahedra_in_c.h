/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * A grid and a field as a C code writes them: Maubach's bisections of the six Kuhn tetrahedra of a
 * cube of samples, the same as LatticeBisection<3>. Their bisections are told.
 */
#ifndef TETRAHEDRA_IN_C_H
#define TETRAHEDRA_IN_C_H

#include <nestgrid/nestgrid.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint64_t cells;       /* along each direction, a power of two below 2^20 */
    const float* samples; /* (cells + 1)^3, x fastest */
} samples_in_c;

/* The tables of samples, which are borrowed. */
nestgrid_grid tetrahedra_in_c(const samples_in_c* of);
nestgrid_field samples_field_in_c(const samples_in_c* of);

#ifdef __cplusplus
}
#endif

#endif
