// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fields that are kept as differences from their interpolants, and decoded on the way down (paper,
// sections 4.4 and 7).
//
// A new node keeps the difference between its value and the weighted mean of its parents, which is
// small where the data are smooth. Differences are those of ordered integers, so that every value
// comes back bit for bit, or those of multiples of a step; there the parents are decoded ones, so
// that errors of levels do not add up. Differences lie in blocks of 64 nodes, each with as many
// bits as its largest one takes.
// Consequences: a value is decoded from the corners of the element that makes the node, which are
// exact wherever a saturated criterion lets the walk descend; nothing is unpacked that the walk
// does not reach. Criteria that are not saturated are refused.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nestgrid/detail/erase.hpp>

namespace nestgrid {

/// How values are kept.
struct CompressionOptions {
    /// 0: values are kept bit for bit. Else they become multiples of the step, off by at most half
    /// of it and the rounding of their type: exactly the values where these are multiples already.
    double step = 0;
};

/// Compressed values as they lie in a file.
struct PackedValues {
    double step = 0;                   ///< of CompressionOptions
    std::vector<std::uint32_t> block;  ///< in `words`: where each block begins; the end
    std::vector<std::uint64_t> words;  ///< block k has block[k + 1] - block[k] bits a code

    friend bool operator==(const PackedValues&, const PackedValues&) = default;
};

/// The values at all nodes of a hierarchy with dense keys.
template <class Real>
class CompressedValues {
public:
    /// Walks the whole hierarchy. Takes as much memory as the values while it is made.
    /// \throw InvalidInput where keys are not dense, the step is negative or not a number, or a
    ///        value has no place among its multiples
    explicit CompressedValues(const Hierarchy<Real>& hierarchy,
                              const CompressionOptions& options = {});
    /// Takes what packed() of other values returned. Whatever its words are, decoding is defined.
    /// \param count values: that of nodes times that of components
    /// \throw InvalidInput where the step or the blocks are not those of so many values
    CompressedValues(std::size_t count, std::size_t components, PackedValues packed);

    const PackedValues& packed() const { return packed_; }
    /// Values: nodes times components.
    std::size_t size() const { return size_; }
    int components() const { return static_cast<int>(components_); }
    std::size_t memory_bytes() const;

    /// Decodes the values at nodes of the coarse grid.
    void decode_coarse(std::span<const NodeKey> nodes, std::span<Real> out) const;
    /// Decodes the values at new nodes of a split.
    /// \param which the nodes that are wanted; others have the mean of their parents
    /// \param corners values at the corners
    void decode(const Rule& rule, NodeMask which, std::span<const NodeKey> nodes,
                std::span<const Real> corners, std::span<Real> out) const;
    /// Sets the values at all new nodes of a split.
    /// \param hanging the nodes that hang, which have the mean of their parents
    void decode_split(const Rule& rule, NodeMask hanging, std::span<const NodeKey> nodes,
                      std::span<const Real> corners, std::span<Real> out) const;

private:
    class Encoder;

    std::uint64_t code(std::size_t at) const;
    void pack(const std::vector<std::uint64_t>& codes);

    std::size_t components_;
    std::size_t size_;
    PackedValues packed_;
};

/// Compressed values as a field. Grid and values must outlive it.
template <class Grid, class Real>
class CompressedField {
public:
    using value_type = Real;
    using Element = ElementOf<Grid>;

    /// \throw InvalidInput where the values are of another number of nodes than the grid has
    CompressedField(const Grid& grid, const CompressedValues<Real>& values)
        : grid_{&grid}, values_{&values}, made_for_{grid} {
        const auto components = static_cast<std::size_t>(values.components());
        if (values.size() == grid.node_count() * components) return;
        throw InvalidInput("the compressed values are those of " +
                           std::to_string(values.size() / components) +
                           " nodes, but the grid has " + std::to_string(grid.node_count()));
    }

    /// \throw GridError where the grid has changed since the field was made
    NodeMask coarse_values(std::size_t i, std::span<Real> out, Context<Grid>& context) const {
        made_for_.require_same(*grid_, "the field");
        std::array<NodeKey, max_corners> nodes;
        const auto coarse = detail::call_coarse(*grid_, context, i);
        const auto corners = std::span(nodes).first(topology(coarse.shape).corners);
        detail::call_corner_keys(*grid_, context, coarse.element, corners);
        values_->decode_coarse(corners, out);
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<const Real> corners,
                        std::span<Real> out, Context<Grid>& context) const {
        const Rule& rule = *detail::call_split(*grid_, context, e);
        std::array<NodeKey, max_new_nodes> nodes;
        const auto made = std::span(nodes).first(rule.new_nodes.size());
        detail::call_new_keys(*grid_, context, e, made);
        values_->decode(rule, which, made, corners, out);
        return 0;
    }

private:
    const Grid* grid_;
    const CompressedValues<Real>* values_;
    detail::MadeFor made_for_;
};

}  // namespace nestgrid
