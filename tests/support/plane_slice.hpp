// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// The slice by dot(normal, x) = offset.
template <class Grid, class Field>
Surface<3> plane_slice(const Grid& grid, const Field& field, const Point& normal, double offset,
                       const Criterion& criterion, const Bounds& bounds) {
    const Plane plane(offset / dot(normal, normal) * normal, normal);
    return slice(grid, field, plane, under(criterion, bounds), {.verify = true}).surface;
}

}  // namespace nestgrid_test
