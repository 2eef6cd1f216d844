// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Some random cases are few in a usual run, and many where the environment has NESTGRID_LONG_TESTS.
#pragma once

#include <cstdlib>

namespace nestgrid_test {

inline bool is_long_run() { return std::getenv("NESTGRID_LONG_TESTS") != nullptr; }

/// How many cases a law is tried on.
inline int cases(int usual, int long_run) { return is_long_run() ? long_run : usual; }

}  // namespace nestgrid_test
