// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices by the number of their edge in the subtrees that a walk of blocks is in
// (subtree_nodes.hpp): a table without keys, which asks nothing that a processor had to predict.
//
// Invariant: an entry says where in the lists its edge is; none_, which is greater, that it is not.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <nestgrid/inlining.hpp>

namespace nestgrid::engine {

class SubtreeVertices {
public:
    using Number = std::uint32_t;

    /// Forgets all edges.
    /// \param numbers what those of the edges to come are below
    void begin_again(std::size_t numbers) {
        for (std::size_t i = 0; i < count_; ++i) entry_[edge_[i]] = none_;
        count_ = 0;
        if (entry_.size() < numbers) entry_.resize(numbers, none_);
    }
    std::size_t memory_bytes() const {
        return (entry_.capacity() + edge_.capacity() + number_.capacity()) * sizeof(Number);
    }

    /// Looks edges up, and puts those that are new into the list.
    /// \param count of them
    /// \param number_of  of edge i; 0 is never found
    /// \param found where they are in the list
    /// \param fresh those that are new; there is room for one more than `count`
    /// \return how many
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
    /// The numbers of those that were new, to be set.
    std::span<Number> new_numbers() { return std::span(number_).subspan(first_, count_ - first_); }
    /// What was found becomes the number of a vertex.
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

    std::vector<Number> entry_;   // by the number of an edge
    std::vector<Number> edge_;    // by where it is in the list
    std::vector<Number> number_;  // likewise, of its vertex
    std::size_t count_ = 0;       // in the lists
    std::size_t first_ = 0;       // of those that find() put there
    std::size_t end_ = 0;         // of those that may be found again
};

}  // namespace nestgrid::engine
