// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether nodes of a set lie below elements of a grid that knows its stars: a sweep from fine to
// coarse over rows of nodes (StarRow) tells it of all nodes that are made around each node.
#pragma once

#include <nestgrid/detail/node_set.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid::engine {

/// The nodes at which a field has no value (NaN). Requires facts().knows_stars.
template <class Real>
NodeSet find_missing_nodes(const Hierarchy<Real>& hierarchy);

/// Memory: a byte for each node, and the set.
class NodesBelow {
public:
    /// Requires facts().knows_stars.
    template <class Real>
    NodesBelow(const Hierarchy<Real>& hierarchy, NodeSet nodes);

    const NodeSet& nodes() const { return nodes_; }
    /// Whether no node of the set is a new node of a split, or made below it.
    bool none(const Split& split) const { return (flags(split) & some_) == 0; }
    /// Whether every new node of a split, and every one made below it, is in the set.
    bool all(const Split& split) const { return (flags(split) & others_) == 0; }

private:
    static constexpr std::uint8_t some_ = 1;
    static constexpr std::uint8_t others_ = 2;

    std::uint8_t flags(const Split& split) const {
        std::uint8_t all = 0;
        for (const NodeKey key : split.keys) all |= flags_[static_cast<std::size_t>(key)];
        return all;
    }
    std::uint8_t around(std::size_t node, std::span<const std::ptrdiff_t> finer) const;
    void raise(const StarRow& row);
    void gather(const StarRow& row);

    NodeSet nodes_;
    std::vector<std::uint8_t> flags_;     // of each node and all made around it
    std::vector<std::uint8_t> gathered_;  // of nodes that stand for all new nodes of their element
};

/// Calls function(view, some) for leaves near nodes, whether one of `near` is a corner, and for the
/// largest elements without any of these at a node, or with all nodes in `whole`, which is a part
/// of `near`. The walk must carry keys.
template <class Real, class Function>
void for_each_near(const Walk<Real>& walk, const NodesBelow& near, const NodesBelow& whole,
                   const Function& function) {
    class Near final : public Visitor<Real> {
    public:
        Near(const Walk<Real>& walk, const NodesBelow& near, const NodesBelow& whole,
             const Function& function)
            : walk_{&walk}, near_{&near}, whole_{&whole}, function_{&function} {}

        bool sees_hidden() const override { return true; }
        Decision inspect(const ElementView<Real>& view, const Split& split) override {
            std::array<NodeKey, max_corners> keys;
            walk_->corners(view, keys.data(), nullptr);
            const auto corners = std::span<const NodeKey>(keys).first(view.corner_count());
            const bool some = near_->nodes().mask(corners) != 0;
            const bool all = std::ranges::all_of(
                corners, [&](NodeKey key) { return whole_->nodes().contains(key); });
            const bool ends = split.rule == nullptr || (!some && near_->none(split)) ||
                              (all && whole_->all(split));
            if (!ends) return {};
            (*function_)(view, some);
            return {Visit::skip, 0};
        }
        void extract(const ElementView<Real>&) override {}

    private:
        const Walk<Real>* walk_;
        const NodesBelow* near_;
        const NodesBelow* whole_;
        const Function* function_;
    };
    Near visitor(walk, near, whole, function);
    walk.run(visitor);
}

}  // namespace nestgrid::engine
