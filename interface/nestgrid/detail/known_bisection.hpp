// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bisections as constants. Grids and the walk in patches (algorithms/patches) are made from them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace nestgrid {

/// The bisection of a simplex of at most four corners; its one new node is the midpoint of two.
struct KnownBisection {
    struct Half {
        std::array<std::uint8_t, 4> corner{};  ///< of the parent, or 4: the new node
        std::uint8_t bisection = 0;            ///< of this child
        std::int8_t orientation = 1;
    };
    std::array<std::uint8_t, 2> parent{};
    std::array<Half, 2> child{};
};

/// Maubach's bisections of triangles (dim 2) and tetrahedra; number i is that of tag i + 1.
template <int dim>
constexpr std::array<KnownBisection, static_cast<std::size_t>(dim)> maubach_bisections() {
    std::array<KnownBisection, static_cast<std::size_t>(dim)> result;
    constexpr auto size = static_cast<std::size_t>(dim);
    for (std::size_t tag = 1; tag <= size; ++tag) {
        KnownBisection& rule = result[tag - 1];
        rule.parent = {0, static_cast<std::uint8_t>(tag)};
        for (std::size_t i = 0; i <= size; ++i) {
            rule.child[0].corner[i] = static_cast<std::uint8_t>(i == tag ? 4 : i);
            rule.child[1].corner[i] = static_cast<std::uint8_t>(i == tag ? 4 : i < tag ? i + 1 : i);
        }
        for (KnownBisection::Half& half : rule.child) {
            half.bisection = static_cast<std::uint8_t>(tag == 1 ? size - 1 : tag - 2);
        }
        rule.child[1].orientation = static_cast<std::int8_t>(tag % 2 == 0 ? 1 : -1);
    }
    return result;
}

}  // namespace nestgrid
