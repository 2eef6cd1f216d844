// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What p4est_serial.cpp and p4est_ranks.cpp draw: a wave on a forest of p8est that is refined where
// the wave crosses zero.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include <p8est_extended.h>

#include <nestgrid/adapters/p4est.hpp>

namespace p4est_wave {

using namespace nestgrid;

/// Waves around a point of the cube.
inline double wave(const Point& x) { return std::sin(14 * norm(x - Point{0.5, 0.4, 0.45})); }

inline Point place(const p8est_t& forest, std::uint32_t tree,
                   const std::array<std::int32_t, 3>& at) {
    Point x;
    p8est_qcoord_to_vertex(forest.connectivity, static_cast<p4est_topidx_t>(tree), at[0], at[1],
                           at[2], x.data());
    return x;
}

/// Refines where the wave crosses zero.
inline int crosses(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    const auto half = P8EST_QUADRANT_LEN(q->level) / 2;
    const Point middle =
        place(*forest, static_cast<std::uint32_t>(tree), {q->x + half, q->y + half, q->z + half});
    return std::abs(wave(middle)) < 10.0 / (1 << q->level) ? 1 : 0;
}

// [field]
/// What a solver has: a value at every corner of its own leaves, and none of other ranks, if any.
struct Wave {
    using value_type = double;
    using Element = P4estGrid<3>::Element;

    NodeMask coarse_values(std::size_t tree, std::span<double> out) const {
        NodeMask missing = 0;
        for (unsigned k = 0; k < 8; ++k) missing |= put(grid->coarse(tree).element, k, k, out);
        return missing;
    }
    NodeMask new_values(const Element& e, NodeMask, std::span<double> out) const {
        std::array<Element, 8> children;
        grid->children(e, children);
        NodeMask missing = 0;
        for (std::size_t n = 0; n < out.size(); ++n) {
            const auto [child, corner] = grid->split(e)->new_corner[n];
            missing |= put(children[child], corner, n, out);
        }
        return missing;
    }
    /// Puts the value at a corner into out[n], or returns bit n.
    NodeMask put(const Element& e, unsigned k, std::size_t n, std::span<double> out) const {
        if (grid->corner_leaf(e, k) == grid->no_leaf) return NodeMask{1} << n;
        const auto length = P8EST_QUADRANT_LEN(e.level);
        std::array<std::int32_t, 3> at = e.anchor;
        for (unsigned d = 0; d < 3; ++d) at[d] += (k >> d & 1U) != 0 ? length : 0;
        out[n] = wave(place(grid->forest(), e.tree, at));
        return 0;
    }
    const P4estGrid<3>* grid;
};
// [field]

}  // namespace p4est_wave
