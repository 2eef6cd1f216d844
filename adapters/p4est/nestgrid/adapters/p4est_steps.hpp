// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is asked of a forest before anything is read from it; included by p4est.hpp.
#pragma once

#include <nestgrid/adapters/p4est.hpp>

namespace nestgrid {

template <int dim, class Map>
const typename P4estTypes<dim>::Connectivity& P4estGrid<dim, Map>::checked(const Forest* forest) {
    if (forest == nullptr) throw InvalidInput("there is no forest");
    if (forest->local_num_quadrants != forest->global_num_quadrants) {
        throw InvalidInput("the forest is distributed: process " + std::to_string(forest->mpirank) +
                           " has " + std::to_string(forest->local_num_quadrants) + " of its " +
                           std::to_string(forest->global_num_quadrants) +
                           " leaves; gather it on one process (p4est_partition) first");
    }
    if (!curved && forest->connectivity->vertices == nullptr) {
        throw InvalidInput(
            "the connectivity of the forest has no vertices; give a map of its trees");
    }
    return *forest->connectivity;
}

/// One node, one place, and trees that are not flat.
template <int dim, class Map>
void P4estGrid<dim, Map>::check_place(std::size_t t) {
    const CoarseElement<Element> c = coarse(t);
    const std::span<const Point> x(c.corners.data(), max_corners);
    double size = 0;
    for (const Point& corner : x) size = std::max(size, norm(corner - x[0]));
    for (unsigned k = 0; k < max_corners; ++k) {
        const Point own = corner_position(Trees::corner(t, k));
        if (!(norm(own - x[k]) <= 1e-9 * size)) {
            throw InvalidInput("corner " + std::to_string(k) + " of tree " + std::to_string(t) +
                               " is at another place than in tree " +
                               std::to_string(c.ids[k] / max_corners) +
                               ": the forest is periodic, or needs a map of its trees");
        }
    }
    const Point volume = measure_vector(c.shape, x);
    if (!(norm(volume) > 1e-14 * std::pow(size, dim))) {
        throw InvalidInput("tree " + std::to_string(t) + " is flat");
    }
    if (volume[2] < 0) orientation_[t] = -1;
}

/// Surfaces in space consistently, from the first tree of each connected part on, as far as they
/// can be oriented; trees with a volume, and in the plane, keep their sign.
template <int dim, class Map>
void P4estGrid<dim, Map>::orient() {
    if constexpr (dim == 2) {
        const auto& c = *forest_->connectivity;
        std::vector<bool> done(coarse_count(), false);
        std::vector<std::size_t> queue;
        for (std::size_t seed = 0; seed < coarse_count(); ++seed) {
            if (!done[seed]) queue.push_back(seed);
            done[seed] = true;
            while (!queue.empty()) {
                const std::size_t t = queue.back();
                queue.pop_back();
                for (std::size_t f = 0; f < 4; ++f) {
                    const auto other = static_cast<std::size_t>(c.tree_to_tree[4 * t + f]);
                    if (done[other]) continue;
                    done[other] = true;
                    queue.push_back(other);
                    // Neighbours run through their common side in opposite senses.
                    const int across = c.tree_to_face[4 * t + f];
                    const auto& side = topology(Shape::quadrilateral).face;
                    const int begin = Types::corner_across_face(
                        side[f].corner[0], static_cast<int>(f), across % 4, across / 4);
                    const bool turned =
                        side[static_cast<std::size_t>(across % 4)].corner[0] == begin;
                    orientation_[other] =
                        static_cast<std::int8_t>(turned ? -orientation_[t] : orientation_[t]);
                }
            }
        }
    }
}

}  // namespace nestgrid
