// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/crossing_nodes.hpp>

#include <algorithm>
#include <bit>

#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid::engine {

namespace {

/// A hash of the parents of a stencil, by their keys, and of the order of its weights.
NodeKey parents_of(const Stencil& stencil, std::span<const NodeKey> keys) {
    std::array<NodeKey, max_corners + max_new_nodes> mixed;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        mixed[stencil.parent[i]] = detail::mix(keys[stencil.parent[i]]);
    }
    return derived_key(stencil, mixed.data());
}

/// The stencil of the middle of two nodes.
Stencil midpoint() {
    Stencil stencil = mean_of({0, 1});
    stencil.mean = Mean::midpoint;
    return stencil;
}

NodeKey parents_of(const KeyPair& pair) {
    return parents_of(midpoint(), std::array{pair.low, pair.high});
}

}  // namespace

NodeMask CrossingNodes::made_by_other_stencils(const Rule& rule,
                                               std::span<const NodeKey> keys) const {
    NodeMask mask = 0;
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        const std::uint32_t* at = find(keys[corners + n]);
        if (at == nullptr || !nodes_[*at].crosses) continue;
        const FixedNode& node = nodes_[*at];
        if (node.hangs && parents_of(rule.new_nodes[n], keys) == node.parents) continue;
        mask |= NodeMask{1} << n;
    }
    return mask;
}

bool CrossingNodes::extend(std::array<NodeKey, 2>& edge) const {
    for (std::size_t i = 0; i < 2; ++i) {
        const std::uint32_t* at = find(edge[i]);
        if (at == nullptr || !nodes_[*at].hangs || nodes_[*at].stencil.count != 2) continue;
        const std::array ends{nodes_[nodes_[*at].parent[0]].key, nodes_[nodes_[*at].parent[1]].key};
        if (ends[0] != edge[1 - i] && ends[1] != edge[1 - i]) continue;
        edge[i] = ends[0] == edge[1 - i] ? ends[1] : ends[0];
        return true;
    }
    return false;
}

template <class Real>
void CrossingSearch<Real>::add_split(const Rule& rule, std::span<const NodeKey> keys,
                                     detail::HangingProbe& probe) {
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        const Stencil& stencil = rule.new_nodes[n];
        Made made{&stencil, {}, parents_of(stencil, keys), false};
        for (std::size_t i = 0; i < stencil.count; ++i) made.parent[i] = keys[stencil.parent[i]];
        const NodeKey node = keys[corners + n];
        const auto [first, is_new] = made_.insert(node, made);
        first->has_other_stencils = first->has_other_stencils || first->parents != made.parents;
        if (!is_new) continue;
        const auto given = walk_->hierarchy().hanging_parents(node);
        if (given[0] != given[1]) probe.add_parents(node, {given[0], given[1]});
    }
}

template <class Real>
void CrossingSearch<Real>::refuse(NodeKey node, const std::string& what) const {
    const Walk<Real> walk(walk_->hierarchy(), {.values = false, .keys = true, .positions = true});
    std::string where;
    for_each_element(walk, false, [&](const ElementView<Real>& view, const Split&) {
        std::array<NodeKey, max_corners> keys;
        std::array<Point, max_corners> x;
        if (!where.empty()) return;
        walk.corners(view, keys.data(), x.data());
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            if (keys[k] != node) continue;
            where =
                " at " + text_of(x[k]) + ", below coarse element " + std::to_string(view.coarse);
        }
    });
    throw GridError("the node" + where + " " + what);
}

/// Whether elements make a node by different stencils, or by another one than its own.
template <class Real>
bool CrossingSearch<Real>::crosses(NodeKey node, const Made& made) const {
    const KeyPair* edge = probe_->parents_on_edge(node);
    if (edge != nullptr) return made.has_other_stencils || parents_of(*edge) != made.parents;
    if (made.has_other_stencils && hanging_->contains(node)) {
        refuse(node,
               "hangs, elements that divide a face in different directions make it of different "
               "parents, and the grid does not give those between which it hangs");
    }
    return made.has_other_stencils;
}

template <class Real>
std::shared_ptr<const CrossingNodes> CrossingSearch<Real>::find(const detail::HangingProbe& probe,
                                                                const HangingNodes& hanging) {
    probe_ = &probe;
    hanging_ = &hanging;
    if (probe.contradiction()) {
        refuse(*probe.contradiction(),
               "hangs on an edge between others than the parents that the grid gives it: two edges "
               "in different directions give it two values, or the grid is wrong");
    }
    found_ = std::make_shared<CrossingNodes>();
    made_.for_each([&](NodeKey node, const Made& made) {
        if (crosses(node, made)) found_->nodes_[need(node)].crosses = true;
    });
    if (found_->nodes_.empty()) return nullptr;
    need_around();
    locate();
    return found_;
}

/// Makes a node a fixed one, behind the parents between which it hangs.
template <class Real>
std::uint32_t CrossingSearch<Real>::need(NodeKey key) {
    const auto [number, is_new] = found_->number_.insert(key, pending);
    if (!is_new) {
        if (*number == pending) refuse(key, "is a parent of its own parents");
        return *number;
    }
    FixedNode node;
    node.key = key;
    const Made* made = made_.find(key);
    const KeyPair* edge = probe_->parents_on_edge(key);
    node.hangs = hanging_->contains(key) && made != nullptr;
    if (node.hangs) {
        node.stencil = edge != nullptr ? midpoint() : *made->stencil;
        node.parents = edge != nullptr ? parents_of(*edge) : made->parents;
        std::array<NodeKey, max_corners> parent = made->parent;
        if (edge != nullptr) parent = {edge->low, edge->high};
        for (std::uint8_t i = 0; i < node.stencil.count; ++i) {
            node.stencil.parent[i] = i;
            node.parent[i] = need(parent[i]);
        }
    }
    const auto own = static_cast<std::uint32_t>(found_->nodes_.size());
    found_->nodes_.push_back(node);
    *found_->number_.find(key) = own;
    return own;
}

/// Whether a node hangs between `end` and another node.
template <class Real>
bool CrossingSearch<Real>::hangs_beside(NodeKey node, NodeKey end) const {
    if (!hanging_->contains(node)) return false;
    if (const KeyPair* edge = probe_->parents_on_edge(node)) {
        return edge->low == end || edge->high == end;
    }
    const Made* made = made_.find(node);
    return made != nullptr && made->stencil->count == 2 &&
           (made->parent[0] == end || made->parent[1] == end);
}

/// Fixes the corners of quadrilaterals in faces of split elements that have a crossing node and are
/// parts of faces which that node, or a node beside it, halves.
template <class Real>
void CrossingSearch<Real>::need_around() {
    SplitKeys room;
    for_each_element(*walk_, true, [&](const ElementView<Real>& view, const Split& split) {
        if (split.rule == nullptr) return;
        const std::span<const NodeKey> keys = walk_->split_keys(view, split, room);
        const NodeMask crossing = found_->made_by_other_stencils(*split.rule, keys);
        if (crossing == 0) return;
        for (const Child& child : split.rule->children) {
            need_around(child, crossing, view.corner_count(), keys);
        }
    });
}

/// \param crossing new nodes of the split, one bit each
/// \param corners their number, of the element that was split
/// \param keys of its corners, then of the new nodes
template <class Real>
void CrossingSearch<Real>::need_around(const Child& child, NodeMask crossing, std::size_t corners,
                                       std::span<const NodeKey> keys) {
    const Topology& t = topology(child.shape);
    for (std::size_t f = 0; f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        if (face.corners != 4 || child.parent_face[f] == no_face) continue;
        const auto node = [&](std::size_t i) { return child.corner[face.corner[i % 4]]; };
        bool is_part = false;
        for (std::size_t i = 0; i < 4; ++i) {
            if (node(i) < corners || (crossing >> (node(i) - corners) & 1U) == 0) continue;
            for (const std::size_t beside : {i + 1, i + 3}) {
                const NodeKey end = keys[node(beside)];
                is_part =
                    is_part || hangs_beside(keys[node(i)], end) || hangs_beside(end, keys[node(i)]);
            }
        }
        for (std::size_t i = 0; is_part && i < 4; ++i) need(keys[node(i)]);
    }
}

/// Finds the positions of fixed nodes, and the elements that make those that do not hang.
template <class Real>
void CrossingSearch<Real>::locate() {
    CrossingNodes& to = *found_;
    to.elements_ = walk_->hierarchy().make_elements();
    const Walk<Real> walk(walk_->hierarchy(), {.values = false, .keys = true, .positions = true},
                          hanging_);
    std::vector<bool> is_placed(to.nodes_.size());
    std::array<NodeKey, max_corners> keys;
    std::array<Point, max_corners> x;
    for_each_element(walk, false, [&](const ElementView<Real>& view, const Split& split) {
        walk.corners(view, keys.data(), x.data());
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            const std::uint32_t* at = to.find(keys[k]);
            if (at == nullptr || is_placed[*at]) continue;
            FixedNode& node = to.nodes_[*at];
            is_placed[*at] = true;
            node.position = x[k];
            if (view.level > 0) continue;
            node.element = view.coarse;
            node.node = static_cast<std::uint8_t>(k);
        }
        if (split.rule != nullptr) locate_makers(view, split);
    });
    for (std::size_t i = 0; i < to.nodes_.size(); ++i) {
        FixedNode& node = to.nodes_[i];
        if (!is_placed[i]) throw GridError("the grid gives a parent that is no node of the grid");
        if (!node.hangs) continue;
        for (std::size_t p = 0; p < node.stencil.count; ++p) {
            x[p] = to.nodes_[node.parent[p]].position;
        }
        node.position = detail::interpolate(node.stencil, x.data());
    }
}

template <class Real>
void CrossingSearch<Real>::locate_makers(const ElementView<Real>& view, const Split& split) {
    for (std::size_t n = 0; n < split.keys.size(); ++n) {
        const std::uint32_t* at = found_->find(split.keys[n]);
        if (at == nullptr) continue;
        FixedNode& node = found_->nodes_[*at];
        if (node.hangs || node.rule != nullptr) continue;
        node.rule = split.rule;
        node.node = static_cast<std::uint8_t>(n);
        node.element = found_->elements_.size();
        found_->elements_.append(view.element());
    }
}

template class CrossingSearch<float>;
template class CrossingSearch<double>;

}  // namespace nestgrid::engine
