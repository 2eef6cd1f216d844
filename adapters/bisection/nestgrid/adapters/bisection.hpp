// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Implicit bisection hierarchies over regular samples: Maubach's bisection of the Kuhn simplices
// of blocks of 2^m cells, triangles over an image, tetrahedra over a volume (paper, section 9).
// Nothing is stored; the samples stay where they are.
//
// Invariants:
//   - an element is its corners on the lattice of samples, in Maubach's order, and its tag;
//   - neighbouring blocks are mirror images, so the diagonal of every cell of the lattice with
//     step s points from the corner whose coordinates are multiples of 2s: the whole hierarchy is
//     a function of the lattice alone, and every node is created on one level only;
//   - dimensions that are no multiple of 2^m are padded to the next one. Samples are continued
//     constantly; elements outside are masked, those across the boundary of the domain never stop.
// Consequences: leaves cover the domain exactly. Padding costs preroll memory for the padded
// lattice, and, where a surface meets the padded part of the boundary, elements refined down to
// the samples in a skin of about two cells along that curve; elsewhere nothing.
#pragma once

#include <bit>

#include <nestgrid/adapters/lattice.hpp>
#include <nestgrid/detail/erase.hpp>
#include <nestgrid/detail/known_bisection.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// The grid: dim is 2 (triangles) or 3 (tetrahedra).
template <int dim>
class LatticeBisection : public Lattice<dim> {
    using Lattice<dim>::size_;
    using Lattice<dim>::bits_;
    using Lattice<dim>::cells_;
    using Lattice<dim>::padded_cells_;
    using Lattice<dim>::blocks_;
    using Lattice<dim>::block_total_;
    using Lattice<dim>::node_stride_;
    using Lattice<dim>::levels_;
    using Lattice<dim>::padded_;
    using Lattice<dim>::handedness_;
    static constexpr std::size_t corners_ = static_cast<std::size_t>(dim) + 1;

public:
    using typename Lattice<dim>::Place;
    using Lattice<dim>::at;
    using Lattice<dim>::node;
    using Lattice<dim>::position;

    using Node = Place;
    struct Element {
        std::array<Place, corners_> corner;
        std::uint8_t tag;
    };

    static constexpr int dimension = dim;
    static constexpr int max_corners = dim + 1;
    static constexpr int max_new_nodes = 1;
    static constexpr int max_children = 2;

    /// \throw InvalidInput as the Lattice
    explicit LatticeBisection(const LatticeGeometry<dim>& geometry);

    std::size_t coarse_count() const { return block_total_ * permutations_; }
    CoarseElement<Element> coarse(std::size_t i) const;

    const Rule* split(const Element& e) const { return is_unit(e) ? nullptr : rules_[e.tag]; }

    void children(const Element& e, std::span<Element> out) const {
        const Place z = middle(e);
        for (std::size_t c = 0; c < max_children; ++c) {
            const KnownBisection::Half& half = bisections[bisection(e)].child[c];
            for (std::size_t i = 0; i < corners_; ++i) {
                out[c].corner[i] = half.corner[i] == 4 ? z : e.corner[half.corner[i]];
            }
            out[c].tag = static_cast<std::uint8_t>(half.bisection + 1);
        }
    }

    // Optional operations.
    static constexpr auto bisections = maubach_bisections<dim>();
    static constexpr std::size_t patch_height = dim;  // then the lattice step is half
    std::size_t bisection(const Element& e) const { return e.tag - 1U; }
    std::array<Node, corners_> nodes(const Element& e) const { return e.corner; }
    NESTGRID_INLINE Element element(std::size_t number,
                                    const std::array<Node, corners_>& nodes) const {
        return {nodes, static_cast<std::uint8_t>(number + 1)};
    }
    NESTGRID_INLINE const Rule& rule(std::size_t number) const { return *rules_[number + 1]; }
    NESTGRID_INLINE bool halved(Node a, Node b) const { return ((a ^ b) & unit_) == 0; }
    // Nodes may be packs of nodes, too.
    template <class Nodes>
    NESTGRID_INLINE Nodes middle(const Nodes& a, const Nodes& b) const {
        return (a + b) >> 1;
    }
    NESTGRID_INLINE NodeKey key(Node n) const { return node(n); }
    template <class Keys>
    NESTGRID_INLINE Keys middle_key(const Keys& a, const Keys& b) const {
        return (a + b) >> 1;
    }
    using Lattice<dim>::whole;
    NESTGRID_INLINE bool whole(const std::array<Place, corners_>& nodes) const {
        bool none = true;
        for (const Place p : nodes) none = none && !this->beyond(p);
        return none;
    }

    bool conforming() const { return true; }

    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        for (std::size_t i = 0; i < corners_; ++i) out[i] = node(e.corner[i]);
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const { out[0] = node(middle(e)); }

    void corner_positions(const Element& e, std::span<Point> out) const {
        for (std::size_t i = 0; i < corners_; ++i) out[i] = position(e.corner[i]);
    }

    NESTGRID_INLINE bool masked(const Element& e) const { return padded_ && lies_beyond(e); }
    bool lies_beyond(const Element& e) const {
        for (std::size_t d = 0; d < size_; ++d) {
            bool beyond = true;
            for (const Place p : e.corner) beyond = beyond && at(p, d) >= cells_[d];
            if (beyond) return true;
        }
        return false;
    }

    NESTGRID_INLINE NodeMask outside(const Element& e) const {
        return padded_ && (this->beyond(e.corner[0]) || this->beyond(e.corner[e.tag])) ? 1U : 0U;
    }

    /// Face i lies opposite to corner i. All of them for an element across the boundary.
    unsigned boundary_faces(const Element& e) const {
        // A face has at least one of any two corners.
        if (!padded_ && inner(e.corner[0]) && inner(e.corner[1])) return 0;
        unsigned faces = 0;
        for (std::size_t d = 0; d < size_; ++d) {
            if (padded_ &&
                std::ranges::any_of(e.corner, [&](Place p) { return at(p, d) > cells_[d]; })) {
                return (1U << corners_) - 1U;
            }
            for (const std::uint32_t plane : {0U, cells_[d]}) {
                if (at(e.corner[0], d) != plane && at(e.corner[1], d) != plane) continue;
                unsigned off = 0;
                for (std::size_t i = 0; i < corners_; ++i) {
                    off |= unsigned{at(e.corner[i], d) != plane} << i;
                }
                if (std::has_single_bit(off)) faces |= off;
            }
        }
        return faces;
    }

    template <class Function>
    void for_each_star_row(Function&& function) const;

    // What fields need.
    Place middle(const Element& e) const { return middle(e.corner[0], e.corner[e.tag]); }
    Place corner_place(const Element& e, std::size_t k) const { return e.corner[k]; }
    Place new_place(const Element& e, std::size_t) const { return middle(e); }

private:
    static constexpr std::size_t permutations_ = dim == 2 ? 2 : 6;
    static constexpr Place unit_ = Place{1} | Place{1} << bits_ |  // odd coordinates
                                   (dim == 3 ? Place{1} << 2 * bits_ : Place{0});

    /// Whether no edge can be halved: the refinement edge has lattice steps of 1.
    bool is_unit(const Element& e) const { return !halved(e.corner[0], e.corner[e.tag]); }
    /// Whether no coordinate is the first or the last. Subtracting 1 from each clears the bit above
    /// it, which is free, where it is 0.
    bool inner(Place p) const {
        constexpr Place above = unit_ << (bits_ - 1);
        const auto nonzero = [](Place q) { return ((q | above) - unit_) & above; };
        return (nonzero(p) & nonzero(p ^ last_)) == above;
    }
    template <class Function>
    void star_rows_of_plane(std::uint32_t step, unsigned odd, std::uint32_t plane,
                            Function& function) const;

    std::array<const Rule*, corners_> rules_{};  // by tag
    Place last_ = 0;                             // of the domain
};

/// Types of samples whose walk in patches is compiled in the library. Lattices with other samples
/// are walked one bisection at a time.
template <class Sample>
concept WalkedInPatches = std::same_as<Sample, float> || std::same_as<Sample, double> ||
    std::same_as<Sample, std::int8_t> || std::same_as<Sample, std::uint8_t> ||
    std::same_as<Sample, std::int16_t> || std::same_as<Sample, std::uint16_t> ||
    std::same_as<Sample, std::int32_t> || std::same_as<Sample, std::uint32_t> ||
    std::same_as<Sample, std::int64_t> || std::same_as<Sample, std::uint64_t>;

/// The engine walks this grid in patches.
template <int dim, WalkedInPatches Sample>
bool knows_patches(const LatticeBisection<dim>&, const LatticeField<LatticeBisection<dim>, Sample>&,
                   const HierarchyFacts&) {
    return true;
}

/// Hierarchy::bisect() of a lattice; compiled for the types above.
template <int dim, WalkedInPatches Sample>
void bisect_patches(const LatticeBisection<dim>& grid,
                    const LatticeField<LatticeBisection<dim>, Sample>& field,
                    const typename LatticeBisection<dim>::Element& e,
                    detail::PatchVisitor& visitor);

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
/// Centres of edges of a cell are covered through its faces, and all in a cell through its centre.
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
