// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of LatticeBisection, and what the library compiles of it. Included at the end of
// bisection.hpp.
#pragma once

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

/// Around a node lie: centres of finer cells, half a step away in every direction; where two
/// directions are odd or three, the centres of its edges or faces, a step away in one of those.
/// Those of the edges of a cell are covered through its faces', all in a cell through its centre.
template <int dim>
template <class Function>
void LatticeBisection<dim>::star_rows_of_plane(std::uint32_t step, unsigned odd,
                                               std::uint32_t plane, Function& function) const {
    // Elements reach one step to each side. Where x[0] is odd, parents depend on its remainder
    // modulo four steps.
    const typename Lattice<dim>::PlaneOfNodes nodes{step, odd, plane, 1, 2};
    this->for_each_row(nodes, [&](const std::array<std::uint32_t, 3>& x, std::size_t stride,
                                  std::size_t count, std::size_t outside) {
        std::array<std::ptrdiff_t, 14> finer;
        std::size_t found = this->centres_around(x, step, finer.data());
        std::ptrdiff_t half = 0;  // from a node to the end of its refinement edge
        for (std::size_t d = 0; d < size_; ++d) {
            if (!nodes.is_odd(d)) continue;
            // The diagonal starts at the multiple of four steps.
            half += (x[d] % (4 * step) == step ? 1 : -1) * this->key_step(d, step);
            if (std::popcount(odd) < 2) continue;
            finer[found++] = -this->key_step(d, step);
            finer[found++] = this->key_step(d, step);
        }
        const std::array<std::ptrdiff_t, 2> parents{-half, half};
        function(StarRow{.first = this->node_at(x),
                         .stride = stride,
                         .count = count,
                         .parents = std::span(parents).first(odd != 0 ? 2 : 0),
                         .finer = std::span(finer).first(found),
                         .outside = outside});
    });
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

// The library compiles these classes for all samples that are WalkedInPatches, so that a program
// that draws samples does not.
#define NESTGRID_COMPILED(dim, Sample)                                   \
    extern template class LatticeField<LatticeBisection<dim>, Sample>;   \
    extern template class detail::ErasedHierarchy<LatticeBisection<dim>, \
                                                  LatticeField<LatticeBisection<dim>, Sample>>;
#define NESTGRID_COMPILED_FOR_ALL_SAMPLES(dim)   \
    extern template class Lattice<dim>;          \
    extern template class LatticeBisection<dim>; \
    NESTGRID_COMPILED(dim, float)                \
    NESTGRID_COMPILED(dim, double)               \
    NESTGRID_COMPILED(dim, std::int8_t)          \
    NESTGRID_COMPILED(dim, std::uint8_t)         \
    NESTGRID_COMPILED(dim, std::int16_t)         \
    NESTGRID_COMPILED(dim, std::uint16_t)        \
    NESTGRID_COMPILED(dim, std::int32_t)         \
    NESTGRID_COMPILED(dim, std::uint32_t)        \
    NESTGRID_COMPILED(dim, std::int64_t)         \
    NESTGRID_COMPILED(dim, std::uint64_t)
NESTGRID_COMPILED_FOR_ALL_SAMPLES(2)
NESTGRID_COMPILED_FOR_ALL_SAMPLES(3)
#undef NESTGRID_COMPILED_FOR_ALL_SAMPLES
#undef NESTGRID_COMPILED

}  // namespace nestgrid
