// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bounds of a search at full resolution, where no preroll is needed (paper, section 4.4).
//
// Invariant: on every divided element, U of component 0 stays within the values at the corners +-
// the bound, which is the least such number, rounded up to bfloat16.
// Consequences: fewer elements are entered than by the sums of offsets that a preroll keeps; one
// walk makes all bounds, and keeps nothing else meanwhile. With Exact as the criterion a level set
// has the same triangles as after a preroll, but where an offset is exactly 0: there a threshold
// of 0 lets elements stop, and Exact does not.
// Memory: 2 bytes a node where node keys are dense, and 32 to 64 bytes for each divided element
// where they are not, or where a split makes several nodes and none inside.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid {

/// How far data leave the range of the corners of each divided element: bounds for Exact.
class SplitBounds final : public Bounds {
public:
    /// Walks the whole hierarchy; component 0 of the field counts.
    ///
    /// \throw InvalidInput where a value is not a number, infinite, or beyond a quarter of the
    ///        range of its type; where the grid is distributed
    explicit SplitBounds(const Hierarchy<float>& hierarchy,
                         const Executor& executor = SequentialExecutor{});
    explicit SplitBounds(const Hierarchy<double>& hierarchy,
                         const Executor& executor = SequentialExecutor{});
    template <class Grid, class Field>
        requires(!detail::AnyHierarchy<Grid>)
    SplitBounds(const Grid& grid, const Field& field,
                const Executor& executor = SequentialExecutor{})
        : SplitBounds(erase(grid, field), executor) {}

    /// Infinite: nothing is known of nodes at which some criterion holds.
    double offset_bound(NodeKey) const override { return std::numeric_limits<double>::infinity(); }
    double bound(const Rule& rule, std::span<const NodeKey> nodes) const override;
    const HangingNodes* hanging() const override { return hanging_.empty() ? nullptr : &hanging_; }
    bool made_for(std::uint64_t epoch) const override { return epoch == epoch_; }
    double least() const override { return facts_.least; }
    double greatest() const override { return facts_.greatest; }
    int finest_level() const override { return facts_.all_divided ? facts_.finest_level : -1; }

    std::size_t memory_bytes() const;

private:
    template <class Real>
    void prepare(const Hierarchy<Real>& hierarchy, const Executor& executor);
    std::uint16_t& place_of(NodeKey name, bool is_node);

    // Bounds of divided elements, by the new node that names them if keys are dense, or by a name.
    std::unique_ptr<std::uint16_t[]> dense_;
    KeyTable<NodeKey, std::uint16_t> sparse_;
    std::size_t node_count_ = 0;
    HangingNodes hanging_;
    detail::PrerollFacts facts_;
    std::uint64_t epoch_ = 0;
};

namespace detail {

/// Whether SplitBounds are made faster than the preroll of a hierarchy, and are offered.
bool are_split_bounds_worth_while(const HierarchyFacts& facts);

}  // namespace detail

}  // namespace nestgrid
