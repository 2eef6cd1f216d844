// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of solutions of deal.II, p4est and Dune's UGGrid, and isolines on them, beside VTK's
// cutters and contour on the leaves as an unstructured grid: edges at which the colours jump, open
// ends of isolines, time and memory. Each solver runs in a process of its own. Prints one "name
// value" line per figure; --quick takes small grids.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "solver_slices.hpp"

namespace {

/// \return whether it ended well
bool run_apart(void (*measure)(bool), bool quick) {
    const pid_t child = fork();
    if (child == 0) {
        try {
            measure(quick);
            std::exit(0);
        } catch (const std::exception& error) {
            std::fprintf(stderr, "bench_solver_slices: %s\n", error.what());
            std::exit(1);
        }
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status == 0;
}

}  // namespace

int main(int argc, char** argv) {
    setenv("VTK_SMP_MAX_THREADS", "1", 1);  // read when VTK first looks for threads
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    bool well = true;
#ifdef NESTGRID_WITH_DEALII
    well = run_apart(slices_dealii, quick) && well;
#endif
#ifdef NESTGRID_WITH_P4EST
    well = run_apart(slices_p4est, quick) && well;
#endif
#ifdef NESTGRID_WITH_DUNE
    well = run_apart(slices_dune, quick) && well;
#endif
    return well ? 0 : 1;
}
