// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the adapter of Dune knows of YaspGrid: the order in which one process has its elements.
#pragma once

#include <nestgrid/adapters/dune_rules.hpp>

namespace Dune {
template <int dim, class Coordinates>
class YaspGrid;
}

namespace nestgrid {

/// What DuneGrid knows of Dune's structured grids.
template <int dim, class Coordinates>
struct DuneTraits<Dune::YaspGrid<dim, Coordinates>>
    : DuneDefaults<Dune::YaspGrid<dim, Coordinates>> {
    using DuneType = Dune::YaspGrid<dim, Coordinates>;
    using Element = typename DuneType::template Codim<0>::Entity;

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
