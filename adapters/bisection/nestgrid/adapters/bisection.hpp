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
    // Of a Pack, too.
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
template <int dim, WalkedInPatches Sample, class Real>
void bisect_patches(const LatticeBisection<dim>& grid,
                    const LatticeField<LatticeBisection<dim>, Sample>& field, NoContext& context,
                    const typename LatticeBisection<dim>::Element& e, const Real* values, int level,
                    int orientation, detail::ErasedBisectionVisitor<dim, Real>& visitor);
/// Hierarchy::bisect_means() of a lattice, likewise.
template <WalkedInPatches Sample>
void bisect_patches_of_means(const LatticeBisection<3>& grid,
                             const LatticeField<LatticeBisection<3>, Sample>& field,
                             const LatticeBisection<3>::Element& e, const double* values,
                             double tolerance, int level, int orientation,
                             detail::ErasedBisectionVisitor<3, double>& visitor);

}  // namespace nestgrid

#include <nestgrid/adapters/bisection_steps.hpp>
