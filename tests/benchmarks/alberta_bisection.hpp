// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

struct AlbertaFigures {
    std::size_t leaves = 0;
    double seconds = 0;  ///< of the last bisection with its closure
};

/// Kuhn's six tetrahedra of the unit cube, bisected at the same sphere as refine_at_sphere().
AlbertaFigures refine_alberta_at_sphere(int levels);
