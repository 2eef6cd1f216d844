// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a grid may offer beside what it must (operations.hpp), by name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace nestgrid {

/// Nodes first, first + stride, ... of a grid with dense keys, each a plain mean of its parents and
/// with finer nodes around it, at the same distances in key from each. A maximum over those and, of
/// each of them, over its own, is one over all nodes that are made in elements with this corner.
struct StarRow {
    std::size_t first = 0;
    std::size_t stride = 1;
    std::size_t count = 0;
    /// None on the coarse grid, 2, 4 around a face in tensor order, or 8.
    std::span<const std::ptrdiff_t> parents;
    std::span<const std::ptrdiff_t> finer;  ///< nodes of earlier rows
    std::size_t outside = 0;  ///< of the last ones: how many are as the operation `outside` says
    /// Nodes inside elements (Rule::inside) that were in earlier rows; `finer` are now all new
    /// nodes of such an element, and these stand for all of them from here on.
    bool gathers = false;
};

enum class Feature : unsigned {
    own_keys = 1,
    dense_keys = 2,
    own_positions = 4,
    new_positions = 8,
    constrained = 16,
    masked = 32,
    outside = 64,
    boundary_faces = 128,
    gradients = 256,
    hidden = 512,
};
inline constexpr Feature last_feature = Feature::hidden;

enum class Hidden : std::uint8_t { not_at_all, partly, wholly };

}  // namespace nestgrid
