// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A table from edges to vertices, by the numbers that edges have within the subtrees of the current
// walk in patches (subtree_nodes.hpp). Lookups are branch-free: no key is compared.
//
// Invariant: entry_[e] is the place of edge e in the lists, or none_, which is greater than any
// place.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <nestgrid/detail/inlining.hpp>

namespace nestgrid::engine {

/// Finds the vertices on the edges of subtrees. Lists of edges and vertices hold them by place.
class SubtreeVertices {
public:
    using Number = std::uint32_t;

    /// Forgets all edges.
    /// \param numbers a bound: all edges that follow have smaller numbers
    void begin_again(std::size_t numbers) {
        for (std::size_t i = 0; i < count_; ++i) entry_[edge_[i]] = none_;
        count_ = 0;
        if (entry_.size() < numbers) entry_.resize(numbers, none_);
    }
    std::size_t memory_bytes() const {
        return (entry_.capacity() + edge_.capacity() + number_.capacity()) * sizeof(Number);
    }

    /// Looks `count` edges up, and appends those that are new to the lists.
    /// \param number_of number_of(i) is the number of edge i; an edge 0 is always new
    /// \param found the place of each edge in the lists; set
    /// \param fresh the indices of the new edges; set. It has room for count + 1
    /// \return the number of new edges
    template <class NumberOf>
    NESTGRID_INLINE std::size_t find(std::size_t count, NumberOf&& number_of, Number* found,
                                     std::uint16_t* fresh) {
        reserve(count + 1);
        Number* const entry = entry_.data();
        Number* const edge = edge_.data() + count_;
        const auto first = static_cast<Number>(count_);
        Number fresh_count = 0;
        std::uint32_t any = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t e = number_of(i);
            const Number known = entry[e];
            const Number at = std::min(known, first + fresh_count);
            entry[e] = at | (e == 0 ? none_ : 0U);
            found[i] = at;
            edge[fresh_count] = e;
            fresh[fresh_count] = static_cast<std::uint16_t>(i);
            fresh_count += known == none_ ? 1 : 0;
            any |= e;
        }
        first_ = count_;
        count_ += fresh_count;
        end_ = any != 0 ? count_ : first_;
        return fresh_count;
    }
    /// The vertex numbers of the new edges, which the caller must set before end().
    std::span<Number> new_numbers() { return std::span(number_).subspan(first_, count_ - first_); }
    /// Replaces the places that find() returned by vertex numbers.
    void end(std::span<Number> found) {
        const Number* const number = number_.data();
        for (Number& v : found) v = number[v];
        count_ = end_;
    }

private:
    void reserve(std::size_t more) {
        if (entry_.empty()) entry_.push_back(none_);
        if (number_.size() >= count_ + more) return;
        number_.resize(2 * (count_ + more));
        edge_.resize(number_.size());
    }

    static constexpr Number none_ = std::numeric_limits<Number>::max();

    std::vector<Number> entry_;   // place in the lists, by number of the edge
    std::vector<Number> edge_;    // number of the edge, by place
    std::vector<Number> number_;  // number of the vertex, by place
    std::size_t count_ = 0;       // length of the lists
    std::size_t first_ = 0;       // place of the first edge that the last find() appended
    std::size_t end_ = 0;         // end of the places that stay after end()
};

}  // namespace nestgrid::engine
