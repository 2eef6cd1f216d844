// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Implicit quadtrees and octrees over regular samples: nothing is stored, the samples stay where
// they are. An element is its lowest corner on the lattice and its size.
#pragma once

#include <nestgrid/adapters/lattice.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// The grid: dim is 2 (quadrilaterals) or 3 (hexahedra).
template <int dim>
class LatticeOctree : public Lattice<dim> {
    using Lattice<dim>::size_;
    using Lattice<dim>::bits_;
    using Lattice<dim>::cells_;
    using Lattice<dim>::blocks_;
    using Lattice<dim>::block_total_;
    using Lattice<dim>::levels_;
    using Lattice<dim>::padded_;
    using Lattice<dim>::handedness_;

public:
    using typename Lattice<dim>::Place;
    using Lattice<dim>::at;
    using Lattice<dim>::node;
    using Lattice<dim>::position;

    struct Element {
        Place low;
        std::uint8_t level;  ///< 2^level cells along each direction
    };

    static constexpr int dimension = dim;
    static constexpr int max_corners = 1 << dim;
    static constexpr int max_new_nodes = dim == 2 ? 5 : 19;
    static constexpr int max_children = 1 << dim;
    static constexpr Shape only_shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;

    /// \throw InvalidInput as the Lattice
    explicit LatticeOctree(const LatticeGeometry<dim>& geometry)
        : Lattice<dim>(geometry),
          rule_{&dyadic_rule(dim == 2 ? Shape::quadrilateral : Shape::hexahedron)} {
        const std::vector<Point> nodes = reference_nodes(*rule_);
        for (std::size_t k = 0; k < max_new_nodes; ++k) {
            for (std::size_t d = 0; d < size_; ++d) {
                const double halves = 2 * nodes[max_corners + k][d];
                half_steps_[k] |= static_cast<Place>(halves) << (bits_ * d);
            }
            half_key_steps_[k] = node(half_steps_[k]);
        }
        for (std::size_t k = 0; k < max_corners; ++k) key_steps_[k] = node(corner_place({0, 0}, k));
    }

    std::size_t coarse_count() const { return block_total_; }
    CoarseElement<Element> coarse(std::size_t i) const {
        CoarseElement<Element> c;
        c.shape = rule_->parent;
        c.orientation = handedness_;
        c.element.level = static_cast<std::uint8_t>(levels_);
        c.element.low = 0;
        for (std::size_t d = 0; d < size_; ++d) {
            c.element.low |= Place{i % blocks_[d]} << (bits_ * d + c.element.level);
            i /= blocks_[d];
        }
        for (std::size_t k = 0; k < max_corners; ++k) {
            c.corners[k] = position(corner_place(c.element, k));
            c.ids[k] = static_cast<std::uint64_t>(node(corner_place(c.element, k)));
        }
        return c;
    }
    const Rule* split(const Element& e) const { return e.level == 0 ? nullptr : rule_; }
    void children(const Element& e, std::span<Element> out) const {
        const auto level = static_cast<std::uint8_t>(e.level - 1);
        for (std::size_t k = 0; k < max_children; ++k) {
            out[k] = {corner_place({e.low, level}, k), level};
        }
    }

    // Optional operations.
    bool conforming() const { return true; }
    // Numbers of nodes are linear in their places.
    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        const NodeKey low = node(e.low);
        for (std::size_t k = 0; k < max_corners; ++k) out[k] = low + (key_steps_[k] << e.level);
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const {
        const NodeKey low = node(e.low);
        for (std::size_t k = 0; k < max_new_nodes; ++k) {
            out[k] = low + (half_key_steps_[k] << (e.level - 1U));
        }
    }
    void corner_positions(const Element& e, std::span<Point> out) const {
        this->positions_of_box(e.low, e.level, out);
    }
    bool masked(const Element& e) const {
        for (std::size_t d = 0; padded_ && d < size_; ++d) {
            if (at(e.low, d) >= cells_[d]) return true;
        }
        return false;
    }
    /// New nodes between corners of which one lies beyond the domain.
    NodeMask outside(const Element& e) const {
        NodeMask mask = 0;
        if (!padded_ || !this->beyond(corner_place(e, max_corners - 1))) return mask;
        for (std::size_t k = 0; k < max_new_nodes; ++k) {
            const Stencil& s = rule_->new_nodes[k];
            for (std::size_t i = 0; i < s.count; ++i) {
                if (this->beyond(corner_place(e, s.parent[i]))) mask |= NodeMask{1} << k;
            }
        }
        return mask;
    }
    /// Faces 2d and 2d + 1 are the lower and the upper one in direction d. All of them for an
    /// element across the boundary.
    unsigned boundary_faces(const Element& e) const {
        const Place high = corner_place(e, max_corners - 1);
        if (padded_ && this->beyond(high)) return (1U << 2 * size_) - 1U;
        unsigned faces = 0;
        for (std::size_t d = 0; d < size_; ++d) {
            faces |= unsigned{at(e.low, d) == 0} << 2 * d;
            faces |= unsigned{at(high, d) == cells_[d]} << (2 * d + 1);
        }
        return faces;
    }

    template <class Function>
    void for_each_star_row(Function&& function) const;

    // What fields need.
    Place corner_place(const Element& e, std::size_t k) const {
        return this->corner_of_box(e.low, e.level, k);
    }
    Place new_place(const Element& e, std::size_t k) const {
        return e.low + (half_steps_[k] << (e.level - 1U));
    }

private:
    template <class Function>
    void star_rows_of_plane(std::uint32_t step, unsigned odd, std::uint32_t plane,
                            Function& function) const;
    template <class Function>
    void gather_cells_of_plane(std::uint32_t step, std::uint32_t plane, Function& function) const;

    const Rule* rule_;
    std::array<Place, static_cast<std::size_t>(max_new_nodes)> half_steps_{};
    std::array<NodeKey, static_cast<std::size_t>(max_new_nodes)> half_key_steps_{};
    std::array<NodeKey, static_cast<std::size_t>(max_corners)> key_steps_{};
};

/// Around a node lie the centres of finer cells, half a step away in every direction.
template <int dim>
template <class Function>
void LatticeOctree<dim>::star_rows_of_plane(std::uint32_t step, unsigned odd, std::uint32_t plane,
                                            Function& function) const {
    const typename Lattice<dim>::PlaneOfNodes nodes{step, odd, plane, 2};
    std::array<std::ptrdiff_t, static_cast<std::size_t>(max_corners)> parents{};  // in tensor order
    std::size_t parent_count = odd == 0 ? 0 : 1;
    for (std::size_t d = 0; d < size_; ++d) {
        if (!nodes.is_odd(d)) continue;
        for (std::size_t i = 0; i < parent_count; ++i) {
            parents[parent_count + i] = parents[i] + this->key_step(d, step);
            parents[i] -= this->key_step(d, step);
        }
        parent_count *= 2;
    }
    this->for_each_row(nodes, [&](const std::array<std::uint32_t, 3>& x, std::size_t stride,
                                  std::size_t count, std::size_t outside) {
        std::array<std::ptrdiff_t, static_cast<std::size_t>(max_corners)> finer;
        const std::size_t found = this->centres_around(x, step, finer.data());
        function(StarRow{.first = this->node_at(x),
                         .stride = stride,
                         .count = count,
                         .parents = std::span(parents).first(parent_count),
                         .finer = std::span(finer).first(found),
                         .outside = outside});
    });
}

/// Cells of two steps.
/// \param plane of their centres
template <int dim>
template <class Function>
void LatticeOctree<dim>::gather_cells_of_plane(std::uint32_t step, std::uint32_t plane,
                                               Function& function) const {
    constexpr unsigned all_odd = (1U << size_) - 1;
    std::array<std::ptrdiff_t, static_cast<std::size_t>(max_new_nodes)> made;
    for (std::size_t k = 0; k < made.size(); ++k) {
        const NodeKey from_centre = half_key_steps_[k] - half_key_steps_[rule_->inside];
        made[k] = static_cast<std::ptrdiff_t>(from_centre) * static_cast<std::ptrdiff_t>(step);
    }
    this->for_each_row({step, all_odd, plane, 2},
                       [&](const std::array<std::uint32_t, 3>& x, std::size_t stride,
                           std::size_t count, std::size_t) {
                           function(StarRow{.first = this->node_at(x),
                                            .stride = stride,
                                            .count = count,
                                            .parents = {},
                                            .finer = made,
                                            .gathers = true});
                       });
}

template <int dim>
template <class Function>
void LatticeOctree<dim>::for_each_star_row(Function&& function) const {
    const std::uint32_t last = this->padded_cells_[size_ - 1];
    std::uint32_t step = 1;
    for (int level = 0; level < levels_; ++level, step *= 2) {
        for (std::uint32_t plane = 0; plane <= last; plane += step) {
            for (unsigned odd = 1; odd < 1U << size_; ++odd) {
                star_rows_of_plane(step, odd, plane, function);
            }
            if (plane >= 2 * step) gather_cells_of_plane(step, plane - step, function);
        }
    }
    for (std::uint32_t plane = 0; plane <= last; plane += step) {
        star_rows_of_plane(step, 0, plane, function);
    }
}

}  // namespace nestgrid
