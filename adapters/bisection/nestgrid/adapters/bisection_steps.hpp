// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of bisection.hpp.
#pragma once

#include <nestgrid/adapters/bisection.hpp>

namespace nestgrid {

template <int dim>
LatticeBisection<dim>::LatticeBisection(const LatticeGeometry<dim>& geometry)
    : Lattice<dim>(geometry) {
    for (int tag = 1; tag <= dim; ++tag) {
        rules_[static_cast<std::size_t>(tag)] =
            &bisection_rule(dim == 2 ? Shape::triangle : Shape::tetrahedron, tag);
    }
}

template <int dim>
auto LatticeBisection<dim>::coarse(std::size_t i) const -> CoarseElement<Element> {
    // Axes in the order in which the path from the first to the last corner takes them.
    static constexpr std::array<std::array<std::uint8_t, 3>, 6> paths{
        {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 0, 1}, {1, 2, 0}, {2, 1, 0}}};
    static constexpr std::array<std::int8_t, 6> signs{1, -1, -1, 1, 1, -1};
    const std::size_t path = i % permutations_;
    std::size_t rest = i / permutations_;
    const Place block = Place{1} << static_cast<unsigned>(levels_);
    CoarseElement<Element> result;
    result.shape = dim == 2 ? Shape::triangle : Shape::tetrahedron;
    int orientation = signs[path] * handedness_;
    Place start = 0;
    std::array<bool, size_> down{};  // in blocks of odd number the path runs backwards
    for (std::size_t d = 0; d < size_; ++d) {
        const std::size_t number = rest % blocks_[d];
        rest /= blocks_[d];
        down[d] = number % 2 == 1;
        start |= (number + (down[d] ? 1U : 0U)) * block << (bits_ * d);
        if (down[d]) orientation = -orientation;
    }
    Element& e = result.element;
    e.tag = static_cast<std::uint8_t>(dim);
    e.corner[0] = start;
    for (std::size_t k = 0; k < size_; ++k) {
        const std::size_t d = paths[path][k];
        const Place step = block << (bits_ * d);
        e.corner[k + 1] = down[d] ? e.corner[k] - step : e.corner[k] + step;
    }
    for (std::size_t k = 0; k < corners_; ++k) {
        result.corners[k] = position(e.corner[k]);
        result.ids[k] = static_cast<std::uint64_t>(node(e.corner[k]));
    }
    result.orientation = static_cast<std::int8_t>(orientation);
    return result;
}

/// Where the corners of a star lie, seen from its node: a step away in every odd direction, or in
/// at least one even direction, at the centres of what the refinement edge or face bounds.
template <int dim>
auto LatticeBisection<dim>::star_moves(std::uint32_t step, unsigned odd) const
    -> std::vector<Move> {
    std::vector<Move> moves;
    const unsigned even = ~odd & ((1U << size_) - 1U);
    const auto add = [&](unsigned directions) {
        for (unsigned up = directions;; up = (up - 1U) & directions) {
            Move move;
            for (std::size_t d = 0; d < size_; ++d) {
                if ((directions >> d & 1U) == 0) continue;
                const bool positive = (up >> d & 1U) != 0;
                (positive ? move.up : move.down) |= 1U << d;
                const std::size_t stride = node_stride_[d] * step;
                move.offset += positive ? stride : std::size_t{0} - stride;
            }
            moves.push_back(move);
            if (up == 0) break;
        }
    };
    add(odd);
    for (unsigned moved = even; moved != 0; moved = (moved - 1U) & even) add(moved);
    return moves;
}

/// Nodes whose coordinates are odd multiples of `step` in the directions `odd`, even ones in the
/// others: centres of edges, faces or cells of the lattice with twice that step.
template <int dim>
template <class Function>
void LatticeBisection<dim>::stars_of_step(std::uint32_t step, unsigned odd,
                                          Function& function) const {
    std::array<std::uint32_t, 3> first{0, 0, 0};
    std::array<std::uint32_t, 3> last{0, 0, 0};
    for (std::size_t d = 0; d < size_; ++d) {
        first[d] = (odd >> d & 1U) != 0 ? step : 0;
        last[d] = padded_cells_[d];
    }
    const std::vector<Move> moves = star_moves(step, odd);
    std::array<std::uint32_t, 3> x{};
    std::array<NodeKey, 16> corners;
    const auto visit = [&] {
        std::size_t index = 0;
        std::size_t half = 0;  // from the node to the end of the refinement edge
        unsigned at_first = 0;
        unsigned at_last = 0;
        bool across = false;
        for (std::size_t d = 0; d < size_; ++d) {
            const bool is_odd = (odd >> d & 1U) != 0;
            // Elements reach one step to each side; where all lie beyond, all are masked.
            if (x[d] >= cells_[d] + step) return;
            index += x[d] * node_stride_[d];
            across = across || x[d] + (is_odd ? step : 0U) > cells_[d];
            at_first |= unsigned{x[d] == 0} << d;
            at_last |= unsigned{x[d] == last[d]} << d;
            // The diagonal starts at the multiple of four steps.
            const std::size_t stride = node_stride_[d] * step;
            if (is_odd) half += x[d] % (4 * step) == step ? stride : std::size_t{0} - stride;
        }
        std::size_t count = 0;
        for (const Move& move : moves) {
            if (((move.up & at_last) | (move.down & at_first)) != 0) continue;
            corners[count++] = static_cast<NodeKey>(index + move.offset);
        }
        const std::array<NodeKey, 2> parents{static_cast<NodeKey>(index - half),
                                             static_cast<NodeKey>(index + half)};
        function(Star{static_cast<NodeKey>(index), parents,
                      std::span<const NodeKey>(corners.data(), count), padded_ && across});
    };
    for (x[2] = first[2]; x[2] <= last[2]; x[2] += 2 * step) {
        for (x[1] = first[1]; x[1] <= last[1]; x[1] += 2 * step) {
            for (x[0] = first[0]; x[0] <= last[0]; x[0] += 2 * step) visit();
        }
    }
}

template <int dim>
template <class Function>
void LatticeBisection<dim>::for_each_star(Function&& function) const {
    for (int level = 0; level < levels_; ++level) {
        const std::uint32_t step = 1U << static_cast<unsigned>(level);
        for (int directions = 1; directions <= dim; ++directions) {
            for (unsigned odd = 1; odd < 1U << size_; ++odd) {
                if (std::popcount(odd) == directions) stars_of_step(step, odd, function);
            }
        }
    }
}

}  // namespace nestgrid
