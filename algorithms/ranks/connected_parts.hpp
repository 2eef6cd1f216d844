// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Connected parts of a surface in pieces.
#pragma once

#include <unordered_map>

#include <ranks/vertex_copies.hpp>

namespace nestgrid::engine {

/// Which parts of pieces belong together, because they have a vertex in common. The least part of
/// the least rank stands for a whole.
class ConnectedParts {
public:
    /// Collective, one exchange and one gathering of pairs of parts.
    /// \param counts whether a vertex connects parts
    /// \param part of each vertex of the piece, by its least vertex
    template <class Counts>
    ConnectedParts(Ranks& ranks, std::span<const VertexCopy> copies, Counts&& counts,
                   std::span<const std::uint32_t> part) {
        std::vector<Pair> pairs;
        tell_copies(
            ranks, copies, counts, [&](Bytes& out, std::uint32_t v) { put(out, part[v]); },
            [&](std::uint32_t v, Reader& in, int rank) {
                const auto there = in.get<std::uint32_t>();
                if (rank > ranks.rank())
                    pairs.push_back({Part{ranks.rank(), part[v]}, Part{rank, there}});
            });
        connect(ranks, pairs);
    }

    /// The least rank that has something of what a part of this rank belongs to, or null where no
    /// other rank has any.
    const int* least_rank(std::uint32_t part) const {
        const auto found = rank_.find(part);
        return found == rank_.end() ? nullptr : &found->second;
    }

    /// A part of a piece, by its least vertex there.
    struct Part {
        int rank;
        std::uint32_t number;
        auto operator<=>(const Part&) const = default;
    };
    /// A part of another rank, and the part of this rank that stands for its whole.
    struct Member {
        Part other;
        std::uint32_t whole;
    };
    std::span<const Member> of_own_wholes() const { return members_; }

private:
    using Pair = std::array<Part, 2>;

    void connect(Ranks& ranks, std::vector<Pair> pairs);

    std::unordered_map<std::uint32_t, int> rank_;  // of the parts that several ranks have
    std::vector<Member> members_;
};

}  // namespace nestgrid::engine
