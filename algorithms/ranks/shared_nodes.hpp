// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The nodes that this rank has in common with others, and with which.
//
// A rank has the nodes of the elements that it visits: all but those that are wholly elsewhere.
// Invariants:
//   - each rank that has a node knows all ranks that have it; or the node is common, and all ranks
//     know it, whether they have it or not;
//   - of two ranks, each keeps their shared nodes in the same order, so that numbers travel without
//     keys.
// Consequence: a face or an edge that several ranks visit has all its corners shared on each of
// them; who they are is the intersection over the corners. Nobody needs neighbours or ghosts.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>

#include <nestgrid/detail/hanging.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <ranks/wire.hpp>

namespace nestgrid::engine {

class SharedNodes {
public:
    /// A node that this rank has.
    struct Candidate {
        NodeKey name;  ///< the same on all ranks; the key, where that is
        NodeKey key;
        std::uint64_t place;  ///< a hash of where it lies, the same on all ranks
    };

    /// \param coarse_places the place of each coarse element among those of all ranks; empty where
    ///        all ranks list the same ones
    SharedNodes(Ranks& ranks, std::uint64_t epoch, std::vector<std::uint64_t> coarse_places)
        : ranks_{&ranks}, epoch_{epoch}, coarse_places_{std::move(coarse_places)} {}

    /// Finds out which other ranks have the same nodes. Collective.
    /// \param candidates at least all nodes that others may have, each once
    /// \param most_sharers nodes that more ranks have are common
    /// \param compared whether keys and places are compared
    ///
    /// \throw GridError on all ranks where a node has two keys or two places
    void find(std::span<const Candidate> candidates, std::size_t most_sharers, bool compared);

    Ranks& ranks() const { return *ranks_; }
    /// The state of the grid for which they were found.
    std::uint64_t epoch() const { return epoch_; }
    /// A corner of the first coarse element of all ranks, the same on each.
    const Point& corner() const { return corner_; }
    void set_corner(const Point& x) { corner_ = x; }
    std::size_t count() const { return index_.size(); }
    std::size_t common_count() const { return common_.size(); }
    /// A common node, in an order that is the same on all ranks; none where it is not here.
    const NodeKey* common(std::size_t i) const { return common_here_[i] ? &common_[i] : nullptr; }
    /// Where a coarse element is among those of all ranks: they lie in the order of these.
    std::uint64_t coarse_place(std::size_t i) const {
        return coarse_places_.empty() ? i : coarse_places_[i];
    }
    bool is_shared(NodeKey node) const { return index_.find(node) != nullptr; }
    bool all_shared(std::span<const NodeKey> nodes) const {
        return std::all_of(nodes.begin(), nodes.end(), [&](NodeKey n) { return is_shared(n); });
    }

    static constexpr int all_ranks = -1;
    /// Calls write(bytes, rank) for the boxes of all other ranks that have all of these nodes, or
    /// for that to all ranks.
    template <class Write>
    void route(std::span<const NodeKey> nodes, Outbox& box, Write&& write) const;
    /// Sends what route() put into a box, and calls take(rank, reader). Collective.
    template <class Take>
    void send(Outbox& box, Take&& take) const {
        box.send(*ranks_, take);
        if (!common_.empty()) box.send_to_all(*ranks_, take);
    }
    /// The number by which this rank and another one, or all, call a node that they have.
    std::uint32_t number_with(int rank, NodeKey node) const;
    /// None where it is common and not here.
    const NodeKey* node_with(int rank, std::uint32_t number) const;
    /// Calls write(bytes, node) for each node that is not common and each other rank that has it,
    /// and take(rank, node, reader) for what others wrote. Collective.
    template <class Write, class Take>
    void tell_sharers(Write&& write, Take&& take) const;
    /// Takes maxima over the ranks that have each node. Collective.
    /// \tparam Numbers an array of unsigned numbers
    /// \param get get(node) returns this rank's numbers
    /// \param raise raise(node, numbers) returns whether it raised any
    /// \return whether some rank was told more than it knew
    template <class Numbers, class Get, class Raise>
    bool raise(Get&& get, Raise&& raise) const;

    /// The hanging nodes that this rank has, wherever the leaf is that they hang on.
    const HangingNodes& hanging() const { return hanging_; }
    /// Whether nodes hang on any rank.
    bool any_hangs() const { return any_hangs_; }
    /// Collective.
    void set_hanging(HangingNodes hanging);

private:
    template <class Numbers, class Get, class Raise>
    bool raise_common(Get& get, Raise& raise) const;
    void keep(NodeKey node, std::vector<int> sharers);
    void keep_common(std::vector<NodeKey> names, std::span<const Candidate> candidates);

    Ranks* ranks_;
    std::uint64_t epoch_;
    std::vector<std::uint64_t> coarse_places_;  // none: their numbers
    Point corner_{0, 0, 0};
    std::vector<NodeKey> keys_;                     // of nodes that are not common, in order
    std::vector<std::vector<int>> sharers_;         // of each: the other ranks, in order
    std::vector<std::vector<std::uint32_t>> with_;  // of each rank: the numbers of the nodes
    std::vector<NodeKey> common_;                   // in the order of their names, on all ranks
    std::vector<bool> common_here_;
    KeyTable<NodeKey, std::uint32_t> index_;  // in keys_; behind these, in common_
    HangingNodes hanging_;
    bool any_hangs_ = false;
};

template <class Write>
void SharedNodes::route(std::span<const NodeKey> nodes, Outbox& box, Write&& write) const {
    std::vector<int> with_all;
    bool any = false;
    for (const NodeKey node : nodes) {
        const std::uint32_t* const at = index_.find(node);
        if (at == nullptr) return;
        if (*at >= keys_.size()) continue;
        const std::vector<int>& sharers = sharers_[*at];
        std::vector<int> left;
        if (any) {
            std::set_intersection(with_all.begin(), with_all.end(), sharers.begin(), sharers.end(),
                                  std::back_inserter(left));
        }
        with_all = any ? std::move(left) : sharers;
        any = true;
    }
    if (!any) return write(box.to_all(), all_ranks);
    for (const int rank : with_all) write(box.to(rank), rank);
}

template <class Write, class Take>
void SharedNodes::tell_sharers(Write&& write, Take&& take) const {
    Outbox box(ranks_->size());
    for (std::size_t r = 0; r < with_.size(); ++r) {
        for (const std::uint32_t i : with_[r]) write(box.to(static_cast<int>(r)), keys_[i]);
    }
    box.send(*ranks_, [&](int rank, Reader& in) {
        for (const std::uint32_t i : with_[static_cast<std::size_t>(rank)]) {
            take(rank, keys_[i], in);
        }
    });
}

template <class Numbers, class Get, class Raise>
bool SharedNodes::raise(Get&& get, Raise&& raise) const {
    bool raised = false;
    tell_sharers([&](Bytes& out, NodeKey node) { put(out, get(node)); },
                 [&](int, NodeKey node, Reader& in) { raised |= raise(node, in.get<Numbers>()); });
    if (!common_.empty()) raised |= raise_common<Numbers>(get, raise);
    std::uint64_t any = raised ? 1 : 0;
    ranks_->reduce(std::span(&any, 1), Ranks::Reduction::max);
    return any != 0;
}

template <class Numbers, class Get, class Raise>
bool SharedNodes::raise_common(Get& get, Raise& raise) const {
    constexpr std::size_t n = std::tuple_size_v<Numbers>;
    bool raised = false;
    std::vector<std::uint64_t> all(n * common_.size(), 0);
    for (std::size_t i = 0; i < common_.size(); ++i) {
        if (!common_here_[i]) continue;
        const Numbers own = get(common_[i]);
        std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(n * i));
    }
    ranks_->reduce(all, Ranks::Reduction::max);
    for (std::size_t i = 0; i < common_.size(); ++i) {
        if (!common_here_[i]) continue;
        Numbers to;
        for (std::size_t k = 0; k < n; ++k) {
            to[k] = static_cast<typename Numbers::value_type>(all[n * i + k]);
        }
        raised |= raise(common_[i], to);
    }
    return raised;
}

}  // namespace nestgrid::engine
