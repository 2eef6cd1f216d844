// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "explored_field.hpp"

#include <limits>

#include <nestgrid/shape.hpp>

namespace nestgrid::view {

template <class Real>
std::array<Point, 2> box_of(const Hierarchy<Real>& hierarchy) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<Point, 2> box{Point{infinity, infinity, infinity},
                             Point{-infinity, -infinity, -infinity}};
    const std::unique_ptr<Task> task = hierarchy.open();
    Coarse coarse;
    Family family;
    for (std::size_t i = 0; i < hierarchy.coarse_count(); ++i) {
        hierarchy.coarse(task.get(), i, coarse, family);
        const auto corners = std::size_t{topology(coarse.shape).corners};
        for (std::size_t k = 0; k < corners; ++k) {
            for (std::size_t d = 0; d < 3; ++d) {
                box[0][d] = std::min(box[0][d], coarse.corners[k][d]);
                box[1][d] = std::max(box[1][d], coarse.corners[k][d]);
            }
        }
    }
    return box;
}
template std::array<Point, 2> box_of(const Hierarchy<float>&);
template std::array<Point, 2> box_of(const Hierarchy<double>&);

}  // namespace nestgrid::view
