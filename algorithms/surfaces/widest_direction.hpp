// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The direction that agrees best with some directions.
#pragma once

#include <span>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

/// A direction, and the least cosine of its angles with some others.
struct Agreement {
    Point direction;
    double cosine;
};

/// The least cosine of a direction with some others.
double least_cosine(const Point& direction, std::span<const Point> others);

/// The direction whose least cosine with some others is greatest: the axis of the least circular
/// cone around them. Where no half-space holds all of them the cosine is not above 0, and the
/// direction says nothing.
/// \param others at least one, of unit length
Agreement widest_direction(std::span<const Point> others);

}  // namespace nestgrid::engine
