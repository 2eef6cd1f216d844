// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the implicit hierarchies over regular samples share: places of the lattice, blocks of 2^m
// cells, padding, and the samples as a field.
//
// Dimensions that are no multiple of 2^m are padded to the next one. Samples are continued
// constantly; elements outside are masked, those across the boundary of the domain never stop.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <nestgrid/detail/pack.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/optional.hpp>

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

/// Places, nodes and samples of a padded lattice.
template <int dim>
class Lattice {
    static_assert(dim == 2 || dim == 3);

public:
    /// Lattice coordinates, 21 bits each, x lowest: halving a sum of two halves all of them.
    using Place = std::uint64_t;

    /// \throw InvalidInput for fewer than 2 or more than 2^20 samples along a direction, for a
    ///        spacing or direction that is not finite or flat, for blocks below 0 or beyond 20, and
    ///        for more nodes than std::ptrdiff_t counts, on machines of 32 bits
    explicit Lattice(const LatticeGeometry<dim>& geometry);

    std::size_t node_count() const { return node_total_; }
    NESTGRID_INLINE std::uint32_t at(Place p, std::size_t d) const {
        return static_cast<std::uint32_t>(p >> (bits_ * d)) & ((1U << bits_) - 1U);
    }
    NESTGRID_INLINE NodeKey node(Place p) const {
        std::size_t index = 0;
        for (std::size_t d = 0; d < size_; ++d) index += at(p, d) * node_stride_[d];
        return static_cast<NodeKey>(index);
    }
    /// Index of the sample at a place of the lattice; padding continues the last samples.
    NESTGRID_INLINE std::size_t sample(Place p) const {
        if (!padded_) return static_cast<std::size_t>(node(p));
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
    NESTGRID_INLINE Point position(Place p) const {
        if (aligned_) {
            if constexpr (dim == 2) {
                return {along_[0][at(p, 0)], along_[1][at(p, 1)], geometry_.origin[2]};
            } else {
                return {along_[0][at(p, 0)], along_[1][at(p, 1)], along_[2][at(p, 2)]};
            }
        }
        Point x = geometry_.origin;
        for (std::size_t d = 0; d < size_; ++d) {
            const double step = geometry_.spacing[d] * at(p, d);
            for (std::size_t r = 0; r < 3; ++r) x[r] += geometry_.direction[r][d] * step;
        }
        return x;
    }
    /// function(positions), where positions(Pack<Place, count>) are the same of several at once, to
    /// the last bit (where products and sums are not fused).
    template <std::size_t count, class Function>
    NESTGRID_INLINE void with_packed_positions(Function&& function) const {
        using Numbers = Pack<double, count>;
        using Places = Pack<Place, count>;
        const PackedPoint<count> origin = packed_point<count>(geometry_.origin);
        const PackedPoint<count> spacing = packed_point<count>(geometry_.spacing);
        const auto step = [&](const Places& p, auto d) NESTGRID_INLINE_LAMBDA -> Numbers {
            constexpr Place coordinate = (Place{1} << bits_) - 1;
            const auto from = d == 0 ? p : p >> static_cast<int>(bits_ * d);
            return spacing[d] * to_double(d + 1 == size_ ? from : from & Places::all(coordinate));
        };
        if (aligned_) {
            function([&](const Places& p) NESTGRID_INLINE_LAMBDA {
                PackedPoint<count> x = origin;
                unrolled<size_>([&](auto d) NESTGRID_INLINE_LAMBDA { x[d] = x[d] + step(p, d); });
                return x;
            });
        } else {
            const auto& row = geometry_.direction;
            const std::array<PackedPoint<count>, 3> direction{packed_point<count>(row[0]),
                                                              packed_point<count>(row[1]),
                                                              packed_point<count>(row[2])};
            function([&](const Places& p) NESTGRID_INLINE_LAMBDA {
                PackedPoint<count> x = origin;
                unrolled<size_>([&](auto d) NESTGRID_INLINE_LAMBDA {
                    const Numbers along = step(p, d);
                    for (std::size_t r = 0; r < 3; ++r) x[r] = x[r] + direction[r][d] * along;
                });
                return x;
            });
        }
    }
    /// Corner k, in tensor order, of the cube with edges of 2^level cells.
    static Place corner_of_box(Place low, unsigned level, std::size_t k) {
        for (std::size_t d = 0; d < size_; ++d) low += Place{k >> d & 1U} << (bits_ * d + level);
        return low;
    }
    /// Positions of all corners of that cube, with the bits of position().
    void positions_of_box(Place low, unsigned level, std::span<Point> out) const {
        constexpr std::size_t corners = std::size_t{1} << size_;
        if (!aligned_) {
            for (std::size_t k = 0; k < corners; ++k)
                out[k] = position(corner_of_box(low, level, k));
            return;
        }
        std::array<std::array<double, 2>, 3> along{{{}, {}, {geometry_.origin[2], 0}}};
        for (std::size_t d = 0; d < size_; ++d) {
            along[d] = {along_[d][at(low, d)], along_[d][at(low, d) + (1U << level)]};
        }
        for (std::size_t k = 0; k < corners; ++k) {
            out[k] = {along[0][k & 1U], along[1][k >> 1U & 1U], along[2][k >> 2U & 1U]};
        }
    }
    Point node_position(NodeKey node) const { return position(place(node)); }
    const LatticeGeometry<dim>& geometry() const { return geometry_; }
    std::size_t sample_count() const { return sample_stride_[size_ - 1] * samples(size_ - 1); }
    std::size_t samples(std::size_t d) const { return cells_[d] + 1U; }
    std::size_t sample_stride(std::size_t d) const { return sample_stride_[d]; }
    int block_levels() const { return levels_; }
    /// Whether nothing is padded: then nodes and samples are the same.
    bool whole() const { return !padded_; }

protected:
    static constexpr std::size_t size_ = static_cast<std::size_t>(dim);
    static constexpr unsigned bits_ = 21;  // of a coordinate: 20 used, one for sums

    /// Whether a place lies beyond the domain, in the padding.
    bool beyond(Place p) const {
        for (std::size_t d = 0; d < size_; ++d) {
            if (at(p, d) > cells_[d]) return true;
        }
        return false;
    }

    // lattice_rows.hpp
    struct PlaneOfNodes;
    template <class Function>
    void for_each_row(const PlaneOfNodes& of, Function&& function) const;
    std::size_t centres_around(const std::array<std::uint32_t, 3>& x, std::uint32_t step,
                               std::ptrdiff_t* to) const;
    std::ptrdiff_t key_step(std::size_t d, std::uint32_t steps) const {
        return static_cast<std::ptrdiff_t>(node_stride_[d] * steps);
    }
    std::size_t node_at(const std::array<std::uint32_t, 3>& x) const {
        std::size_t node = 0;
        for (std::size_t d = 0; d < size_; ++d) node += x[d] * node_stride_[d];
        return node;
    }

    LatticeGeometry<dim> geometry_;
    std::array<std::uint32_t, size_> cells_{};  // of the domain
    std::array<std::uint32_t, size_> padded_cells_{};
    std::array<std::size_t, size_> blocks_{};
    std::array<std::size_t, size_> node_stride_{};    // in the padded lattice
    std::array<std::size_t, size_> sample_stride_{};  // in the samples
    std::size_t block_total_ = 0;
    std::size_t node_total_ = 0;
    int levels_ = 0;
    bool padded_ = false;
    bool aligned_ = false;                          // the axes are those of space, and
    std::array<std::vector<double>, size_> along_;  // these the coordinates along them
    std::int8_t handedness_ = 1;

private:
    void choose_blocks();
};

template <int dim>
Lattice<dim>::Lattice(const LatticeGeometry<dim>& geometry) : geometry_{geometry} {
    std::size_t stride = 1;
    for (std::size_t d = 0; d < size_; ++d) {
        if (geometry.samples[d] < 2 || geometry.samples[d] > 1 << 20) {
            throw InvalidInput("a lattice needs 2 to 2^20 samples along each direction, not " +
                               std::to_string(geometry.samples[d]));
        }
        cells_[d] = static_cast<std::uint32_t>(geometry.samples[d] - 1);
        sample_stride_[d] = stride;
        stride *= cells_[d] + std::size_t{1};
    }
    std::array<Point, 3> axis{{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}}};
    for (std::size_t d = 0; d < size_; ++d) {
        for (std::size_t r = 0; r < 3; ++r) {
            axis[d][r] = geometry.direction[r][d] * geometry.spacing[d];
        }
    }
    const double volume = dot(axis[0], cross(axis[1], axis[2]));
    const double area = norm(cross(axis[0], axis[1]));
    if (!std::isfinite(volume) || (dim == 3 ? volume : area) == 0 ||
        !std::isfinite(norm(geometry.origin))) {
        throw InvalidInput("spacing, direction or origin of the lattice is flat or not finite");
    }
    handedness_ = static_cast<std::int8_t>(volume < 0 ? -1 : 1);
    aligned_ = geometry.direction == LatticeGeometry<dim>{}.direction;
    choose_blocks();
    node_total_ = block_total_ = 1;
    for (std::size_t d = 0; d < size_; ++d) {
        blocks_[d] = padded_cells_[d] >> static_cast<unsigned>(levels_);
        block_total_ *= blocks_[d];
        node_stride_[d] = node_total_;
        node_total_ *= padded_cells_[d] + std::size_t{1};
        padded_ = padded_ || padded_cells_[d] != cells_[d];
        for (std::uint32_t i = 0; aligned_ && i <= padded_cells_[d]; ++i) {
            along_[d].push_back(geometry.origin[d] + geometry.spacing[d] * i);
        }
    }
}

template <int dim>
void Lattice<dim>::choose_blocks() {
    const auto padding = [&](int levels) {
        const std::uint32_t block = 1U << static_cast<unsigned>(levels);
        double growth = 1;
        for (std::size_t d = 0; d < size_; ++d) {
            padded_cells_[d] = (cells_[d] + block - 1) / block * block;
            growth *= (padded_cells_[d] + 1.0) / (cells_[d] + 1.0);
        }
        return growth;
    };
    if (geometry_.block_levels > 19) {
        throw InvalidInput("blocks of more than 2^19 cells along each direction");
    }
    levels_ = geometry_.block_levels;
    if (levels_ < 0) {
        const std::uint32_t longest = *std::max_element(cells_.begin(), cells_.end());
        levels_ = static_cast<int>(std::bit_width(longest - 1U));
        const int least = std::min(levels_, 4);
        while (levels_ > least && padding(levels_) > 1.25) --levels_;
    }
    padding(levels_);
    std::uint64_t nodes = 1;
    for (const std::uint32_t cells : padded_cells_) {
        if (cells >= 1U << 20U) throw InvalidInput("the padded lattice has 2^20 cells or more");
        nodes *= cells + 1U;
    }
    if (nodes > static_cast<std::uint64_t>(std::numeric_limits<std::ptrdiff_t>::max())) {
        throw InvalidInput("the padded lattice has " + std::to_string(nodes) +
                           " nodes, more than this machine can number");
    }
}

}  // namespace nestgrid

#include <nestgrid/adapters/lattice_field.hpp>
#include <nestgrid/adapters/lattice_rows.hpp>
