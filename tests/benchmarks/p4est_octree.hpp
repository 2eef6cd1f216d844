// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

struct P4estFigures {
    std::size_t leaves = 0;
    double forest_bytes = 0;  ///< quadrants of the sorted leaf arrays
    double node_bytes = 0;    ///< lnodes
    double seconds = 0;       ///< of the last refinement with its balance
    double node_seconds = 0;  ///< of its nodes and which of them hang
};

/// A forest of one tree over the unit cube, refined at the same sphere as refine_at_sphere(),
/// balanced across edges and faces after every level.
P4estFigures refine_p4est_at_sphere(int levels);
