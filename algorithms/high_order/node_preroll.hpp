// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How RealNodes are made: leaves are read (node_preroll.cpp), then what they say is handed from
// node to node (real_nodes.cpp).
#pragma once

#include <algorithm>

#include <high_order/real_nodes.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>

namespace nestgrid::engine {

/// Fills the table. Numbers of nodes are those of RealNodes::nodes_.
///
/// Leaves are read in chunks, several at a time. A chunk is complete when all leaves are read that
/// own a record on one of its leaves, or around a corner of one; then its leaves are looked at.
/// Its polynomials are there until the last chunk that needs them is complete.
class RealNodes::Preroll {
public:
    Preroll(RealNodes& nodes, const LeafFunction& function, const BaseWalk& walk,
            LeafSummary& summary, const Executor& executor);

    void run();

private:
    static constexpr std::size_t chunk_size = 256;
    static constexpr std::uint32_t no_leaf = 0xFFFFFFFFU;

    /// A node on a part of a record: its numbers are read while the polynomial of the owner, a
    /// leaf, is in memory.
    struct OnOwner {
        std::uint32_t node;
        OnRecord part;
    };
    struct LeafFacts {
        double beta;
        double flatness;  // the greatest beta of the leaf and its parts
        double least;     // of the leaf and its records
        double greatest;
        float jump;  // from records
        double corner_jump = 0;
    };
    struct Range {
        double least;
        double greatest;
    };
    /// Leaves that follow one another in the walk.
    struct Chunk {
        WayToLeaf first;
        std::size_t begin = 0;  // number of the first leaf
        std::size_t first_split = 0;
        std::size_t complete = 0;          // the last chunk that it needs
        std::size_t needed = 0;            // the last chunk that is complete only then
        std::vector<OnOwner> hanging;      // nodes on records of its leaves
        std::vector<OnOwner> halved;       // parts of them that nodes halve
        std::unique_ptr<NetStore> nets{};  // while they are needed
        std::vector<Range> ranges;         // of components
        int greatest_degree = 1;
    };

    /// Sums of few terms are this much larger at most than they are computed.
    static constexpr double rounding = 1 + 1e-12;
    static void raise(float& number, double to) {
        number = std::max(number, nestgrid::detail::float_above(to * rounding));
    }

    RealNode& node(std::uint32_t number) { return nodes_->nodes_[number]; }
    double value(std::uint32_t number, std::size_t c) const {
        return nodes_->values_[number * components_ + c];
    }
    std::uint32_t number_of(NodeKey key);
    void add_leaf(Task* task, std::span<const BaseElement> way);
    void add_split(std::span<const BaseElement> way);
    std::size_t chunk_of(std::uint32_t leaf) const { return leaf / chunk_size; }
    std::size_t size_of(const Chunk& chunk) const {
        return std::min(chunk_size, leaves_.size() - chunk.begin);
    }

    /// What find_in() has seen in a chunk, in the order of the walk.
    struct Seen {
        std::vector<std::size_t> owners;
        std::vector<OnOwner> hanging;
        std::vector<OnOwner> halved;
    };

    // Reading leaves (node_preroll.cpp).
    void find_records();
    Seen find_in(const Chunk& chunk) const;
    static void find_halved(RecordSearch& search, std::span<const BaseElement> way,
                            const Split& split, Seen& seen);
    void read_all();
    void read(Chunk& chunk);
    void give_corners(std::uint32_t leaf);
    double corner_value(const LeafPolynomial& of, std::size_t corner, std::size_t c) const {
        return records_.net(of, c)[net_corner(of.degree, of.factors(), corner)];
    }
    void take_ranges(const Chunk& chunk);
    void look_at(const Chunk& chunk);
    void look_at(RecordSearch& search, std::span<const BaseElement> way, std::uint32_t leaf);
    // What nodes are told (real_nodes.cpp).
    void put_offsets(const Split& split);
    void seed(std::size_t leaf);
    void sweep();
    static std::span<const std::uint32_t> made_by(const Split& split) {
        return std::span(split.node)
            .subspan(static_cast<std::size_t>(split.rule->corner_count()),
                     split.rule->new_nodes.size());
    }
    void add_own_part(const Split& split);
    void put_stop(const Split& split);
    void raise_corners(const Split& split);

    RealNodes* nodes_;
    const LeafFunction* function_;
    const BaseWalk* walk_;
    LeafSummary* summary_;
    const Executor* executor_;
    LeafRecords records_;
    std::size_t components_;
    std::size_t drawn_;
    std::vector<std::uint32_t> first_;  // the first leaf that has a node
    std::vector<Chunk> chunks_;
    std::vector<LeafFacts> facts_;
    std::vector<LeafNodes> leaves_;
    std::vector<Split> splits_;      // coarse to fine
    std::vector<double> deviation_;  // how far P_S U may be from U at a node that hangs
    std::vector<bool> done_;
};

}  // namespace nestgrid::engine
