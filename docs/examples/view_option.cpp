// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <string_view>

#include "solver_page.hpp"

bool take_view_option(int& argc, char** argv) {
    char** const end = std::remove(argv + 1, argv + argc, std::string_view("--view"));
    const bool found = end != argv + argc;
    argc = static_cast<int>(end - argv);
    return found;
}

void wait_for_enter() {
    std::printf("The last surface stays in the page until Enter.\n");
    std::fflush(stdout);
    std::getchar();
}
