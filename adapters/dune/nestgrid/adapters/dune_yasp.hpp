// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the adapter of Dune knows of YaspGrid: the order in which one process has its elements,
// and where its nodes lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <nestgrid/adapters/dune_rules.hpp>

namespace Dune {
template <int dim, class Coordinates>
class YaspGrid;
template <class Number, int dim>
class TensorProductCoordinates;
}  // namespace Dune

namespace nestgrid {

/// What DuneGrid knows of Dune's structured grids.
template <int dim, class Coordinates>
struct DuneTraits<Dune::YaspGrid<dim, Coordinates>>
    : DuneDefaults<Dune::YaspGrid<dim, Coordinates>> {
    using DuneType = Dune::YaspGrid<dim, Coordinates>;
    using Element = typename DuneType::template Codim<0>::Entity;

    /// Dune multiplies by a width that each process, and each level, divides from another length,
    /// so that its last bits differ; here it is a fraction of the whole grid.
    static Point corner(const DuneType& grid, const Element& e, int corner) {
        using Given = Dune::TensorProductCoordinates<typename DuneType::ctype, dim>;
        if constexpr (std::is_same_v<Coordinates, Given>) {
            return DuneDefaults<DuneType>::corner(grid, e, corner);
        } else {
            Point point{0, 0, 0};
            for (int d = 0; d < dim; ++d) {
                const int node = e.impl().transformingsubiterator().coord(d) + (corner >> d & 1);
                const double part = static_cast<double>(node) / grid.levelSize(e.level(), d);
                point[static_cast<std::size_t>(d)] =
                    grid.begin(0)->coords.coordinate(d, 0) + part * grid.domainSize()[d];
            }
            return point;
        }
    }
    static std::uint64_t coarse_place(const DuneType& grid, const Element& e) {
        std::uint64_t place = 0;
        for (int d = dim; d-- > 0;) {
            const auto along = e.impl().transformingsubiterator().coord(d);
            place = place * static_cast<std::uint64_t>(grid.levelSize(0, d)) +
                    static_cast<std::uint64_t>(along);
        }
        return place;
    }
};

}  // namespace nestgrid
