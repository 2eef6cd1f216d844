// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The kinds of splits of a grid that knows its stars (StarRow): one split of a kind stands for all.
// Two splits are of one kind where a translation maps one to the other.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <indicators/diameter.hpp>
#include <indicators/spread.hpp>
#include <nestgrid/error.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

using KeyOffset = std::ptrdiff_t;  // from one dense key to another
using KeyOffsets = std::vector<KeyOffset>;

inline KeyOffset key_offset(NodeKey from, NodeKey to) {
    return static_cast<KeyOffset>(to) - static_cast<KeyOffset>(from);
}

/// Walks down where splits are of a new kind.
template <class Real, class Function>
class SplitKindVisitor final : public Visitor<Real> {
public:
    SplitKindVisitor(const Walk<Real>& walk, const Function& function)
        : walk_{&walk}, function_{&function} {}

    bool sees_hidden() const override { return true; }
    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        if (split.rule == nullptr) return {Visit::skip};
        SplitKeys of_split;
        const auto keys = walk_->split_keys(view, split, of_split);
        KeyOffsets kind;
        for (const NodeKey key : keys) kind.push_back(key_offset(keys[0], key));
        if (!kinds_.insert(std::move(kind)).second) return {Visit::skip};
        (*function_)(view, split, keys);
        return {Visit::descend};
    }
    void extract(const ElementView<Real>&) override {}

private:
    const Walk<Real>* walk_;
    const Function* function_;
    std::set<KeyOffsets> kinds_;  // offsets of all nodes of a split from its first one
};

/// Calls function(view, split, keys of the corners and new nodes) for one split of each kind.
/// \param walk must carry keys
template <class Real, class Function>
void for_each_split_kind(const Walk<Real>& walk, const Function& function) {
    SplitKindVisitor<Real, Function> visitor(walk, function);
    walk.run(visitor);
}

/// The diameters and distances of one split of each kind.
class SplitKinds {
public:
    template <class Real>
    explicit SplitKinds(const Hierarchy<Real>& hierarchy) {
        const Walk<Real> walk(hierarchy, {.values = false, .keys = true, .positions = true});
        for_each_split_kind(walk, [&](const ElementView<Real>& view, const Split& split,
                                      std::span<const NodeKey> keys) {
            SplitPositions positions;
            add(*split.rule, keys, walk.split_positions(view, split, positions));
        });
    }

    /// The greatest diameter of the elements that make a node with these parents; 0 for a node of
    /// the coarse grid.
    /// \param parents offsets from the node
    /// \throw GridError where no split makes such a node
    double diameter(std::span<const KeyOffset> parents) const {
        KeyOffsets sorted(parents.begin(), parents.end());
        std::ranges::sort(sorted);
        return sorted.empty() ? 0 : found(diameter_, sorted);
    }
    /// The distance over which a corner takes numbers from a new node at this offset from it: the
    /// greatest of the split where that node stands for all new ones (Rule::inside).
    /// \throw GridError where no split has such a pair
    float reach(KeyOffset made) const { return found(reach_, made); }

private:
    template <class Map>
    static typename Map::mapped_type found(const Map& map, const typename Map::key_type& key) {
        const auto at = map.find(key);
        if (at != map.end()) return at->second;
        throw GridError("a star row of the grid has a node that no split makes");
    }

    /// \param keys of the corners and, behind them, of the new nodes
    /// \param x their positions
    void add(const Rule& rule, std::span<const NodeKey> keys, std::span<const Point> x) {
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        const double of_element = diameter_of(x.first(corners));
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const NodeKey made = keys[corners + n];
            double& greatest = diameter_[parents(rule.new_nodes[n], keys, made)];
            greatest = std::max(greatest, of_element);
            for (std::size_t k = 0; k < corners; ++k) {
                const float distance = rule.inside == no_new_node
                                           ? detail::float_above(norm(x[corners + n] - x[k]))
                                           : reach_of(rule, x);
                float& reach = reach_[key_offset(keys[k], made)];
                reach = std::max(reach, distance);
            }
        }
    }

    static KeyOffsets parents(const Stencil& stencil, std::span<const NodeKey> keys, NodeKey made) {
        KeyOffsets offsets;
        for (std::size_t i = 0; i < stencil.count; ++i) {
            offsets.push_back(key_offset(made, keys[stencil.parent[i]]));
        }
        std::ranges::sort(offsets);
        return offsets;
    }

    std::map<KeyOffsets, double> diameter_;  // by the offsets of parents from their node
    std::map<KeyOffset, float> reach_;       // by the offset of a new node from a corner
};

}  // namespace nestgrid::engine
