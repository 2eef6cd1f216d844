// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Decides where elements stop whose data jump from one to the next.
//
// Every leaf has values of its own at its corners. An element that is split has, at each of its
// corners, the value of the leaf below it in that corner, and interpolates between them. It stops
// where the leaves below it deviate from that by the threshold at most: one number decides for each
// element, none for a node.
//
// The number is exact, not a sum over levels: on leaves that divide the element as its
// interpolation does, and on which data are linear in every direction, the difference is greatest
// at a corner of a leaf. So a threshold is an error that is kept, and reached somewhere.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <nestgrid/algorithms/discontinuous_data.hpp>

namespace nestgrid {

/// How far component 0 at the corners of leaves deviates, below each split element, from the values
/// interpolated between the corners of that element.
/// Memory: 8 bytes for each split element, and 64 more while they are measured.
class ElementDeviations {
public:
    /// A split element, in the order of a depth-first traversal. Those that are hidden wholly are
    /// left out, and so are those whose split makes no node.
    struct Entry {
        float deviation;        ///< rounded up; infinity where elements below are hidden or masked
        std::uint32_t subtree;  ///< how many entries are those of the element and of all below it
    };

    /// Walks the whole hierarchy twice, and asks twice for the values of every leaf.
    /// \throw InvalidInput where a value is not a finite number
    explicit ElementDeviations(const DiscontinuousData& data);

    std::span<const Entry> entries() const { return entries_; }
    std::uint64_t epoch() const { return epoch_; }
    double least() const { return least_; }        ///< of component 0 at all corners of leaves
    double greatest() const { return greatest_; }  ///< of component 0 at all corners of leaves
    std::size_t memory_bytes() const { return entries_.capacity() * sizeof(Entry); }

private:
    std::vector<Entry> entries_;
    std::uint64_t epoch_;
    double least_ = std::numeric_limits<double>::infinity();
    double greatest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace nestgrid
