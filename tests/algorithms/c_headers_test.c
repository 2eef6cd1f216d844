/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Compiled as C99: what C codes include is C. A call of before options existed still compiles.
 */
#include <nestgrid/algorithms/discontinuous.h>
#include <nestgrid/algorithms/isolines.h>
#include <nestgrid/algorithms/isosurface.h>
#include <nestgrid/algorithms/options.h>
#include <nestgrid/algorithms/probe.h>
#include <nestgrid/algorithms/ranks.h>
#include <nestgrid/algorithms/slice.h>
#include <nestgrid/algorithms/surface_measures.h>
#include <nestgrid/nestgrid.h>

int main(void) {
    char message[100] = "";
    nestgrid_surface surface;
    const int code = nestgrid_isosurface(NULL, NULL, 0.5, 0.0, &surface, message, sizeof message);
    nestgrid_surface_free(&surface);
    return code == 1 && message[0] == 'a' ? 0 : 1;
}
