// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The kinds of splits of a grid that knows its stars (StarRow): one split of a kind stands for all.
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

/// Walks a hierarchy down to one split of each kind, and keeps diameters and distances of these.
/// Two splits are of one kind where a translation maps one to the other.
template <class Real>
class SplitKinds final : private Visitor<Real> {
public:
    explicit SplitKinds(const Hierarchy<Real>& hierarchy)
        : walk_(hierarchy, {.values = false, .keys = true, .positions = true}) {
        walk_.run(*this);
    }
    SplitKinds(const SplitKinds&) = delete;
    SplitKinds& operator=(const SplitKinds&) = delete;

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
    static auto found(const Map& map, const typename Map::key_type& key) {
        const auto at = map.find(key);
        if (at != map.end()) return at->second;
        throw GridError("a star row of the grid has a node that no split makes");
    }

    bool sees_hidden() const override { return true; }
    /// Goes down where a split is of a new kind.
    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        if (split.rule == nullptr) return {Visit::skip};
        SplitKeys of_split;
        SplitPositions positions;
        const Rule& rule = *split.rule;
        const std::size_t corners = view.corner_count();
        const auto keys = walk_.split_keys(view, split, of_split);
        KeyOffsets kind;
        for (const NodeKey key : keys) kind.push_back(key_offset(keys[0], key));
        if (!kinds_.insert(std::move(kind)).second) return {Visit::skip};
        const auto x = walk_.split_positions(view, split, positions);
        const double of_element = diameter_of(x.first(corners));
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const NodeKey made = keys[corners + n];
            double& greatest = diameter_[parents(rule.new_nodes[n], keys, made)];
            greatest = std::max(greatest, of_element);
            for (std::size_t k = 0; k < corners; ++k) {
                const float distance = rule.inside == no_new_node
                                           ? float_above(norm(x[corners + n] - x[k]))
                                           : reach_of(rule, x);
                float& reach = reach_[key_offset(keys[k], made)];
                reach = std::max(reach, distance);
            }
        }
        return {Visit::descend};
    }
    void extract(const ElementView<Real>&) override {}

    static KeyOffsets parents(const Stencil& stencil, std::span<const NodeKey> keys, NodeKey made) {
        KeyOffsets offsets;
        for (std::size_t i = 0; i < stencil.count; ++i) {
            offsets.push_back(key_offset(made, keys[stencil.parent[i]]));
        }
        std::ranges::sort(offsets);
        return offsets;
    }

    Walk<Real> walk_;
    std::set<KeyOffsets> kinds_;             // offsets of all nodes of a split from its first one
    std::map<KeyOffsets, double> diameter_;  // by the offsets of parents from their node
    std::map<KeyOffset, float> reach_;       // by the offset of a new node from a corner
};

}  // namespace nestgrid::engine
