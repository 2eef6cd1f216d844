// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

/// \throw InvalidInput where a triangle or segment names a vertex that does not exist
template <int dimension>
void require_simplices(const Surface<dimension>& surface) {
    const std::string name = dimension == 3 ? "triangle " : "segment ";
    for (std::size_t s = 0; s < surface.simplices.size(); ++s) {
        if (std::ranges::max(surface.simplices[s]) >= surface.vertices.size()) {
            throw InvalidInput(name + std::to_string(s) + " names a vertex that does not exist");
        }
    }
}

}  // namespace nestgrid::engine
