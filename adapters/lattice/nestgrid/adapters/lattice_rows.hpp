// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rows of nodes of a lattice. Included at the end of lattice.hpp.
#pragma once

#include <limits>

namespace nestgrid {

/// Nodes of one plane whose coordinates are odd multiples of `step` in the directions `odd`, even
/// ones in the others: centres of edges, faces or cells of the lattice with twice that step. Where
/// no direction is odd, all multiples: the nodes of the coarse grid. Rows are cut so that all nodes
/// of one have the boundary of the lattice on the same sides.
template <int dim>
struct Lattice<dim>::PlaneOfNodes {
    std::uint32_t step;
    unsigned odd;
    std::uint32_t plane;  ///< last coordinate; nothing where none of these nodes has it
    /// How many steps elements reach from a node in an even direction; where all lie beyond the
    /// domain, all are masked. In an odd one they reach one.
    std::uint32_t reach;
    std::uint32_t runs = 1;  ///< into which rows are cut by their remainder where x is odd

    bool is_odd(std::size_t d) const { return (odd >> d & 1U) != 0; }
};

/// Calls function(x, stride, count, outside) for each row: the coordinates of its first node, the
/// distance from one key to the next, how many there are, and of how many of the last ones a parent
/// lies beyond the domain.
template <int dim>
template <class Function>
void Lattice<dim>::for_each_row(const PlaneOfNodes& of, Function&& function) const {
    const std::uint32_t step = of.step;
    if (of.odd != 0 && of.is_odd(size_ - 1) != (of.plane % (2 * step) != 0)) return;
    const std::uint32_t spacing = of.odd == 0 ? step : 2 * step;
    std::array<std::uint32_t, 3> x{};
    // From the first of these coordinates on a parent lies beyond the domain, from the second one
    // all elements do.
    const bool ends = padded_ && of.odd != 0;
    const std::uint32_t never = std::numeric_limits<std::uint32_t>::max();
    std::array<std::uint32_t, size_> across;
    std::array<std::uint32_t, size_> beyond;
    for (std::size_t d = 0; d < size_; ++d) {
        const std::uint32_t parent = of.is_odd(d) ? step : 0;
        const std::uint32_t reach = of.is_odd(d) ? step : of.reach * step;
        across[d] = !ends ? never : cells_[d] + 1 - std::min(cells_[d] + 1, parent);
        beyond[d] = !ends ? never : cells_[d] + reach;
    }
    const auto line = [&] {
        bool all_across = false;
        for (std::size_t d = 1; d < size_; ++d) {
            if (x[d] >= beyond[d]) return;
            all_across = all_across || x[d] >= across[d];
        }
        const auto run = [&](std::uint32_t first, std::uint32_t end, std::uint32_t by) {
            const auto below = [&](std::uint32_t c) {
                return first < c ? std::size_t{(c - first - 1) / by} + 1 : 0;
            };
            const std::size_t count = below(std::min(end, beyond[0]));
            const std::size_t inside = all_across ? 0 : below(std::min(end, across[0]));
            x[0] = first;
            if (count > 0) function(x, node_stride_[0] * by, count, count - inside);
        };
        const std::uint32_t last = padded_cells_[0];
        if (of.is_odd(0)) {
            for (std::uint32_t i = 0; i < of.runs; ++i) {
                run((2 * i + 1) * step, last, 2 * of.runs * step);
            }
        } else {
            run(0, 1, spacing);
            run(spacing, last, spacing);
            run(last, last + 1, spacing);
        }
    };
    x[size_ - 1] = of.plane;
    if constexpr (dim == 2) {
        line();
    } else {
        for (x[1] = of.is_odd(1) ? step : 0U; x[1] <= padded_cells_[1]; x[1] += spacing) line();
    }
}

/// The nodes half a step away from x in every direction, as distances in key.
/// \return how many, at `to`; none where steps cannot be halved
template <int dim>
std::size_t Lattice<dim>::centres_around(const std::array<std::uint32_t, 3>& x, std::uint32_t step,
                                         std::ptrdiff_t* to) const {
    std::size_t found = 0;
    for (unsigned up = 0; step > 1 && up < 1U << size_; ++up) {
        std::ptrdiff_t offset = 0;
        bool within = true;
        for (std::size_t d = 0; d < size_; ++d) {
            const bool upwards = (up >> d & 1U) != 0;
            offset += (upwards ? 1 : -1) * key_step(d, step / 2);
            within = within && x[d] != (upwards ? padded_cells_[d] : 0U);
        }
        if (within) to[found++] = offset;
    }
    return found;
}

}  // namespace nestgrid
