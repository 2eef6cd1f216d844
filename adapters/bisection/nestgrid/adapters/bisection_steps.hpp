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
    for (std::size_t d = 0; d < size_; ++d) last_ |= Place{cells_[d]} << (bits_ * d);
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

/// Nodes whose coordinates are odd multiples of `step` in the directions `odd`, even ones in the
/// others: centres of edges, faces or cells of the lattice with twice that step. Where no direction
/// is odd, all multiples: the nodes of the coarse grid. Around a node lie: centres of finer cells,
/// half a step away in every direction; where two directions are odd or three, the centres of its
/// edges or faces, a step away in one of those. Those of the edges of a cell are covered through
/// its faces', all in a cell through its centre.
/// \param plane those of them with this last coordinate, if any
template <int dim>
template <class Function>
void LatticeBisection<dim>::star_rows_of_plane(std::uint32_t step, unsigned odd,
                                               std::uint32_t plane, Function& function) const {
    const auto is_odd = [&](std::size_t d) { return (odd >> d & 1U) != 0; };
    if (odd != 0 && is_odd(size_ - 1) != (plane % (2 * step) != 0)) return;
    const auto key_step = [&](std::size_t d, std::uint32_t steps) {
        return static_cast<std::ptrdiff_t>(node_stride_[d] * steps);
    };
    const std::uint32_t spacing = odd == 0 ? step : 2 * step;
    std::array<std::uint32_t, 3> x{};
    std::array<std::ptrdiff_t, 14> finer;
    // Rows are cut so that all nodes of one have around them what there is around x: where x[0] is
    // odd by its remainder modulo four steps, and else at the first and at the last.
    const auto give_row = [&](std::uint32_t apart, std::size_t count, std::size_t outside) {
        StarRow row;
        row.stride = node_stride_[0] * apart;
        row.count = count;
        row.outside = outside;
        row.has_parents = odd != 0;
        std::size_t found = 0;
        for (unsigned up = 0; step > 1 && up < 1U << size_; ++up) {
            std::ptrdiff_t offset = 0;
            bool within = true;
            for (std::size_t d = 0; d < size_; ++d) {
                const bool upwards = (up >> d & 1U) != 0;
                offset += (upwards ? 1 : -1) * key_step(d, step / 2);
                within = within && x[d] != (upwards ? padded_cells_[d] : 0U);
            }
            if (within) finer[found++] = offset;
        }
        std::ptrdiff_t half = 0;  // from a node to the end of its refinement edge
        for (std::size_t d = 0; d < size_; ++d) {
            row.first += x[d] * node_stride_[d];
            if (!is_odd(d)) continue;
            // The diagonal starts at the multiple of four steps.
            half += (x[d] % (4 * step) == step ? 1 : -1) * key_step(d, step);
            if (std::popcount(odd) < 2) continue;
            finer[found++] = -key_step(d, step);
            finer[found++] = key_step(d, step);
        }
        row.parent = {-half, half};
        row.finer = std::span<const std::ptrdiff_t>(finer.data(), found);
        function(static_cast<const StarRow&>(row));
    };
    // Elements reach one step to each side; where all lie beyond, all are masked.
    const auto beyond_all = [&](std::size_t d, std::uint32_t c) { return c >= cells_[d] + step; };
    const auto across = [&](std::size_t d, std::uint32_t c) {
        return padded_ && c + (is_odd(d) ? step : 0U) > cells_[d];
    };
    const auto line = [&] {
        bool all_across = false;
        for (std::size_t d = 1; d < size_; ++d) {
            if (odd != 0 && beyond_all(d, x[d])) return;
            all_across = all_across || across(d, x[d]);
        }
        const std::uint32_t last = padded_cells_[0];
        const auto run = [&](std::uint32_t first, std::uint32_t end, std::uint32_t by) {
            std::size_t count = !padded_ && first < end ? (end - first - 1) / by + 1 : 0;
            std::size_t outside = 0;
            for (std::uint32_t c = first; padded_ && c < end && (odd == 0 || !beyond_all(0, c));
                 c += by) {
                ++count;
                outside += odd != 0 && (all_across || across(0, c)) ? 1U : 0U;
            }
            x[0] = first;
            if (count > 0) give_row(by, count, outside);
        };
        if (is_odd(0)) {
            run(step, last, 4 * step);
            run(3 * step, last, 4 * step);
        } else {
            run(0, 1, spacing);
            run(spacing, last, spacing);
            run(last, last + 1, spacing);
        }
    };
    x[size_ - 1] = plane;
    if constexpr (dim == 2) {
        line();
    } else {
        for (x[1] = is_odd(1) ? step : 0U; x[1] <= padded_cells_[1]; x[1] += spacing) line();
    }
}

template <int dim>
template <class Function>
void LatticeBisection<dim>::for_each_star_row(Function&& function) const {
    std::uint32_t step = 1;
    const std::uint32_t last = padded_cells_[size_ - 1];
    for (int level = 0; level < levels_; ++level, step *= 2) {
        // Nodes with more odd directions follow a plane behind: what they ask for is near in time.
        for (std::uint32_t front = 0; front <= last + (dim - 1) * step; front += step) {
            for (unsigned directions = 1; directions <= dim; ++directions) {
                const std::uint32_t behind = (directions - 1) * step;
                if (front < behind || front - behind > last) continue;
                for (unsigned odd = 1; odd < 1U << size_; ++odd) {
                    if (static_cast<unsigned>(std::popcount(odd)) != directions) continue;
                    star_rows_of_plane(step, odd, front - behind, function);
                }
            }
        }
    }
    for (std::uint32_t plane = 0; plane <= last; plane += step) {
        star_rows_of_plane(step, 0, plane, function);
    }
}

}  // namespace nestgrid
