// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// Whether each element is an affine image of its reference element, so that its faces are plane.
template <class Grid>
bool is_affine(const Grid& grid) {
    for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
        const auto coarse = grid.coarse(i);
        if (coarse.shape != Shape::hexahedron && coarse.shape != Shape::quadrilateral) continue;
        const auto& x = coarse.corners;
        const std::size_t corners = coarse.shape == Shape::hexahedron ? 8 : 4;
        for (std::size_t k = 0; k < corners; ++k) {
            Point sum = x[0];
            for (std::size_t d = 0; d < 3; ++d) {
                if ((k >> d & 1U) != 0) sum = sum + (x[std::size_t{1} << d] - x[0]);
            }
            if (norm(sum - x[k]) > 1e-12) return false;
        }
    }
    return true;
}

}  // namespace nestgrid_test
