// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the walk of one rank over the whole grid would meet an element, as ranks tell each other.
#pragma once

#include <string>

#include <ranks/shared_nodes.hpp>
#include <walk/element_view.hpp>

namespace nestgrid::engine {

/// The place of the coarse element and the way down from it: earlier elements have lesser strings.
using WalkPlace = std::string;

/// The place of a coarse element.
/// \param coarse its number among those of all ranks
inline WalkPlace place_in_walk(std::uint64_t coarse) {
    WalkPlace place;
    for (unsigned shift = 64; shift > 0; shift -= 8) {
        place += static_cast<char>(coarse >> (shift - 8U) & 0xFFU);
    }
    return place;
}

template <class Real>
WalkPlace walk_place_of(const ElementView<Real>& view, const SharedNodes& shared) {
    if (view.father == nullptr) return place_in_walk(shared.coarse_place(view.coarse));
    return walk_place_of(*view.father, shared) + static_cast<char>(view.child);
}

}  // namespace nestgrid::engine
