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

#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <type_traits>

#include <nestgrid/error.hpp>
#include <nestgrid/operations.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// Where the samples of a lattice lie: origin + direction * (spacing * index).
template <int dim>
struct LatticeGeometry {
    std::array<int, static_cast<std::size_t>(dim)> samples{};  ///< per direction, x fastest, >= 2
    Point spacing{1, 1, 1};                                    ///< not zero
    Point origin{0, 0, 0};
    /// Rows of the direction matrix; its columns are the axes of the lattice in space.
    std::array<Point, 3> direction{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    /// log2 of the cells of a block along each direction; negative: chosen so that blocks are as
    /// large as possible while padding adds at most a quarter to the lattice.
    int block_levels = -1;
};

/// The grid: dim is 2 (triangles) or 3 (tetrahedra).
template <int dim>
class LatticeBisection {
    static_assert(dim == 2 || dim == 3);
    static constexpr std::size_t size_ = static_cast<std::size_t>(dim);
    static constexpr std::size_t corners_ = size_ + 1;
    static constexpr unsigned bits_ = 21;  // of a coordinate: 20 used, one for sums

public:
    /// Lattice coordinates, 21 bits each, x lowest: halving a sum of two halves all of them.
    using Place = std::uint64_t;

    struct Element {
        std::array<Place, corners_> corner;
        std::uint8_t tag;
    };

    static constexpr int dimension = dim;
    static constexpr int max_corners = dim + 1;
    static constexpr int max_new_nodes = 1;
    static constexpr int max_children = 2;

    /// \throw InvalidInput for fewer than 2 or more than 2^20 samples along a direction, for a
    ///        spacing or direction that is not finite or flat, and for blocks below 0 or beyond 20
    explicit LatticeBisection(const LatticeGeometry<dim>& geometry);

    std::size_t coarse_count() const { return block_total_ * permutations_; }
    CoarseElement<Element> coarse(std::size_t i) const;

    const Rule* split(const Element& e) const { return is_unit(e) ? nullptr : rules_[e.tag]; }

    void children(const Element& e, std::span<Element> out) const {
        const Place z = middle(e);
        out[0] = e;
        out[0].corner[e.tag] = z;
        out[1] = e;
        for (std::size_t i = 0; i < e.tag; ++i) out[1].corner[i] = e.corner[i + 1];
        out[1].corner[e.tag] = z;
        out[0].tag = out[1].tag = static_cast<std::uint8_t>(e.tag == 1 ? dim : e.tag - 1);
    }

    // Optional operations.
    std::size_t node_count() const { return node_total_; }
    bool conforming() const { return true; }

    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        for (std::size_t i = 0; i < corners_; ++i) out[i] = node(e.corner[i]);
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const { out[0] = node(middle(e)); }

    void corner_positions(const Element& e, std::span<Point> out) const {
        for (std::size_t i = 0; i < corners_; ++i) out[i] = position(e.corner[i]);
    }

    bool masked(const Element& e) const {
        if (!padded_) return false;
        for (std::size_t d = 0; d < size_; ++d) {
            bool beyond = true;
            for (const Place p : e.corner) beyond = beyond && at(p, d) >= cells_[d];
            if (beyond) return true;
        }
        return false;
    }

    NodeMask outside(const Element& e) const {
        return padded_ && crosses(e.corner[0], e.corner[e.tag]) ? 1U : 0U;
    }

    /// Face i lies opposite to corner i. All of them for an element across the boundary.
    unsigned boundary_faces(const Element& e) const {
        unsigned faces = 0;
        for (std::size_t d = 0; d < size_; ++d) {
            for (const Place p : e.corner) {
                if (padded_ && at(p, d) > cells_[d]) return (1U << corners_) - 1U;
            }
            for (const std::uint32_t plane : {0U, cells_[d]}) {
                unsigned off = 0;
                for (std::size_t i = 0; i < corners_; ++i) {
                    off |= unsigned{at(e.corner[i], d) != plane} << i;
                }
                if (std::has_single_bit(off)) faces |= off;
            }
        }
        return faces;
    }

    /// Every node created below the coarse grid, fine to coarse, each once.
    template <class Function>
    void for_each_star(Function&& function) const;

    // What fields need.
    Place middle(const Element& e) const { return (e.corner[0] + e.corner[e.tag]) >> 1U; }
    std::uint32_t at(Place p, std::size_t d) const {
        return static_cast<std::uint32_t>(p >> (bits_ * d)) & ((1U << bits_) - 1U);
    }
    NodeKey node(Place p) const {
        std::size_t index = 0;
        for (std::size_t d = 0; d < size_; ++d) index += at(p, d) * node_stride_[d];
        return static_cast<NodeKey>(index);
    }
    /// Index of the sample at a place of the lattice; padding continues the last samples.
    std::size_t sample(Place p) const {
        std::size_t index = 0;
        for (std::size_t d = 0; d < size_; ++d) {
            index += std::min(at(p, d), cells_[d]) * sample_stride_[d];
        }
        return index;
    }
    Place place(NodeKey node) const {
        auto rest = static_cast<std::size_t>(node);
        Place p = 0;
        for (std::size_t d = size_; d-- > 0;) {
            p |= Place{rest / node_stride_[d]} << (bits_ * d);
            rest %= node_stride_[d];
        }
        return p;
    }
    Point position(Place p) const {
        Point x = geometry_.origin;
        for (std::size_t d = 0; d < size_; ++d) {
            const double step = geometry_.spacing[d] * at(p, d);
            for (std::size_t r = 0; r < 3; ++r) x[r] += geometry_.direction[r][d] * step;
        }
        return x;
    }
    const LatticeGeometry<dim>& geometry() const { return geometry_; }
    std::size_t sample_count() const { return sample_stride_[size_ - 1] * samples(size_ - 1); }
    std::size_t samples(std::size_t d) const { return cells_[d] + 1U; }
    std::size_t sample_stride(std::size_t d) const { return sample_stride_[d]; }
    int block_levels() const { return levels_; }

private:
    static constexpr std::size_t permutations_ = dim == 2 ? 2 : 6;

    struct Move {
        std::size_t offset = 0;
        unsigned up = 0;  ///< directions, one bit each
        unsigned down = 0;
    };

    /// Whether no edge can be halved: the refinement edge has lattice steps of 1.
    bool is_unit(const Element& e) const {
        const Place sum = e.corner[0] ^ e.corner[e.tag];
        constexpr Place ones = dim == 2 ? (Place{1} | Place{1} << bits_)
                                        : (Place{1} | Place{1} << bits_ | Place{1} << 2 * bits_);
        return (sum & ones) != 0;
    }
    /// Whether the segment from a to b leaves the domain.
    bool crosses(Place a, Place b) const {
        for (std::size_t d = 0; d < size_; ++d) {
            if (std::max(at(a, d), at(b, d)) > cells_[d]) return true;
        }
        return false;
    }
    void choose_blocks();
    std::vector<Move> star_moves(std::uint32_t step, unsigned odd) const;
    template <class Function>
    void stars_of_step(std::uint32_t step, unsigned odd, Function& function) const;

    LatticeGeometry<dim> geometry_;
    std::array<std::uint32_t, size_> cells_{};  // of the domain
    std::array<std::uint32_t, size_> padded_cells_{};
    std::array<std::size_t, size_> blocks_{};
    std::array<std::size_t, size_> node_stride_{};    // in the padded lattice
    std::array<std::size_t, size_> sample_stride_{};  // in the samples
    std::array<const Rule*, corners_> rules_{};       // by tag
    std::size_t block_total_ = 0;
    std::size_t node_total_ = 0;
    int levels_ = 0;
    bool padded_ = false;
    std::int8_t handedness_ = 1;
};

/// Samples of any arithmetic type, borrowed, x fastest. Values are float for types that float holds
/// exactly (float, and integers of at most 16 bits), double for all others.
template <int dim, class Sample>
class LatticeField {
public:
    using value_type = std::conditional_t<std::is_same_v<Sample, float> ||
                                              (std::is_integral_v<Sample> && sizeof(Sample) <= 2),
                                          float, double>;
    using Grid = LatticeBisection<dim>;
    using Element = typename Grid::Element;

    /// \throw InvalidInput where the number of samples is not that of the lattice
    LatticeField(const Grid& grid, std::span<const Sample> samples)
        : grid_{&grid}, samples_{samples} {
        if (samples.size() != grid.sample_count()) {
            throw InvalidInput("the field has " + std::to_string(samples.size()) +
                               " samples, but the lattice " + std::to_string(grid.sample_count()));
        }
    }

    NodeMask coarse_values(std::size_t i, std::span<value_type> out) const {
        const Element e = grid_->coarse(i).element;
        for (std::size_t k = 0; k < e.corner.size(); ++k) out[k] = at(e.corner[k]);
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask, std::span<value_type> out) const {
        out[0] = at(grid_->middle(e));
        return 0;
    }
    value_type value(NodeKey node) const { return at(grid_->place(node)); }

    /// Central differences of the samples, one-sided at the boundary.
    void corner_gradients(const Element& e, std::span<Point> out) const {
        for (std::size_t k = 0; k < e.corner.size(); ++k) out[k] = gradient(e.corner[k]);
    }

private:
    value_type at(typename Grid::Place p) const {
        return static_cast<value_type>(samples_[grid_->sample(p)]);
    }
    Point gradient(typename Grid::Place p) const;

    const Grid* grid_;
    std::span<const Sample> samples_;
};

template <class Sample, int dim>
LatticeField(const LatticeBisection<dim>&, std::span<const Sample>) -> LatticeField<dim, Sample>;

}  // namespace nestgrid

#include <nestgrid/adapters/bisection_steps.hpp>
