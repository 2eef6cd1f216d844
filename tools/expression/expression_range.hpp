// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Between which values an expression stays in a box, by interval arithmetic (Boost.Interval) over
// the operations into which muparser translates it.
#pragma once

#include <nestgrid/shape.hpp>

namespace mu {
class Parser;
}

struct ValueRange {
    double least;
    double greatest;
};

/// Bounds of an expression in the box between two corners: infinite where it has an operation of
/// which no bound is known, and where an operation may have no result. Several threads may call
/// this, also while one evaluates.
/// \param parser has evaluated the expression before
/// \param x the place at which the parser finds x, y and z
ValueRange range_in_box(const mu::Parser& parser, const nestgrid::Point& x,
                        const nestgrid::Point& low, const nestgrid::Point& high);
