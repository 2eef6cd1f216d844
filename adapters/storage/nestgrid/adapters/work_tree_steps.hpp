// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of WorkTree. Included at the end of work_tree.hpp.
#pragma once

namespace nestgrid {

template <int corners>
void WorkTree<corners>::describe(std::uint32_t node, const NodeRecipe& recipe,
                                 const Stencil& stencil, const Local& local) {
    state_[node] |= known_;
    if (recipe.kind == NodeRecipe::Kind::edge) {
        parents[node] = {local[recipe.of[0]], local[recipe.of[1]], no_node, no_node};
    } else if (recipe.kind == NodeRecipe::Kind::face) {
        for (std::size_t i = 0; i < 4; ++i) parents[node][i] = local[recipe.of[i]];
    }
    Point x{0, 0, 0};
    for (std::size_t i = 0; i < stencil.count; ++i) {
        x = x + stencil.weight[i] * position[local[stencil.parent[i]]];
    }
    position[node] = x;
}

template <int corners>
std::uint32_t WorkTree<corners>::free_node() {
    while (next_free_ < state_.size() && (state_[next_free_] & known_) != 0) ++next_free_;
    if (next_free_ == state_.size()) {
        if (next_free_ >= 0x7FFFFFFFU) throw GridError("more than 2^31 nodes");
        add_nodes(state_.size() + 1);
    }
    created.push_back(next_free_);
    return next_free_++;
}

template <int corners>
std::uint32_t WorkTree<corners>::refine(std::uint32_t leaf, std::uint16_t rule_number) {
    Local local;
    const Element e = elements[leaf];
    std::copy(e.corner.begin(), e.corner.end(), local.begin());
    const StoredRule& stored = table.rule(rule_number);
    if (verify && !stored.temporary) throw GridError("the grid is not closed");
    const Rule& r = *stored.rule;
    const auto first = static_cast<std::size_t>(r.corner_count());
    for (std::size_t k = 0; k < stored.nodes.size(); ++k) {
        const std::uint64_t name = key(stored.nodes[k], local);
        const auto [node, is_new] = by_key_.insert(name, no_node);
        if (is_new) {
            const std::uint32_t number = free_node();
            *node = number;
            describe(number, stored.nodes[k], r.new_nodes[k], local);
            const Stencil& s = r.new_nodes[k];
            for (std::size_t i = 0; i < s.count; ++i) created_parent.push_back(local[s.parent[i]]);
            created_first.push_back(static_cast<std::uint32_t>(created_parent.size()));
        }
        local[first + k] = *node;
    }
    return attach(leaf, rule_number, local);
}

template <int corners>
std::uint32_t WorkTree<corners>::attach(std::uint32_t leaf, std::uint16_t rule_number,
                                        const Local& local) {
    const StoredRule& stored = table.rule(rule_number);
    const Rule& r = *stored.rule;
    const auto first = static_cast<std::size_t>(r.corner_count());
    const auto child = static_cast<std::uint32_t>(elements.size());
    if (elements.size() + r.children.size() >= no_node ||
        new_nodes.size() + stored.nodes.size() >= no_node) {
        throw GridError("more than 2^32 elements at once");
    }
    Element& e = elements[leaf];
    e.rule = rule_number;
    e.child = child;
    e.nodes = static_cast<std::uint32_t>(new_nodes.size());
    Element next;
    next.level = static_cast<std::uint8_t>(e.level + 1);
    if (next.level == 0xFF) throw GridError("more than 254 levels");
    for (std::size_t k = 0; k < stored.nodes.size(); ++k) {
        new_nodes.push_back(local[first + k]);
        if (noting_ && !stored.temporary) activate(local[first + k]);
    }
    for (const Child& c : r.children) {
        next.shape = c.shape;
        for (std::size_t i = 0; i < topology(c.shape).corners; ++i) {
            next.corner[i] = local[c.corner[i]];
        }
        elements.push_back(next);
    }
    return child;
}

template <int corners>
void WorkTree<corners>::remember(const Element& e, std::uint16_t rule_number,
                                 std::span<const std::uint32_t> nodes) {
    Local local;
    std::copy(e.corner.begin(), e.corner.end(), local.begin());
    const StoredRule& stored = table.rule(rule_number);
    const auto first = static_cast<std::size_t>(stored.rule->corner_count());
    std::copy(nodes.begin(), nodes.end(), local.begin() + static_cast<std::ptrdiff_t>(first));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const bool known = (state_[nodes[k]] & known_) != 0;
        if (known && !verify) continue;
        const auto [same, is_new] = by_key_.insert(key(stored.nodes[k], local), nodes[k]);
        if (verify && (*same != nodes[k] || is_new == known)) {
            throw GridError("node " + std::to_string(nodes[k]) + " is at two places");
        }
        if (!known) describe(nodes[k], stored.nodes[k], stored.rule->new_nodes[k], local);
    }
}

template <int corners>
std::uint32_t WorkTree<corners>::restore(std::uint32_t leaf, std::uint16_t rule_number,
                                         std::span<const std::uint32_t> nodes) {
    remember(elements[leaf], rule_number, nodes);
    Local local;
    std::copy(elements[leaf].corner.begin(), elements[leaf].corner.end(), local.begin());
    std::copy(nodes.begin(), nodes.end(),
              local.begin() + table.rule(rule_number).rule->corner_count());
    return attach(leaf, rule_number, local);
}

template <int corners>
void WorkTree<corners>::activate(std::uint32_t node) {
    if ((state_[node] & active_) != 0) return;
    state_[node] |= active_;
    const auto& ends = parents[node];
    if (ends[0] == no_node || ends[2] != no_node) return;  // no midpoint of an edge
    const auto note = [&](std::uint32_t a, std::uint32_t b) {
        if (noting_) note_change(a, b);
    };
    state_[ends[0]] |= end_;
    state_[ends[1]] |= end_;
    note(ends[0], ends[1]);
    for (const std::size_t side : {0U, 1U}) {
        const std::uint32_t end = ends[side];
        const std::uint32_t other = ends[1 - side];
        const auto& above = parents[end];
        if (above[0] == no_node) continue;
        if (above[2] != no_node) {  // from the centre of a face: its edges
            for (const std::uint32_t m : above) {
                if (parents[m][1] != no_node) note(parents[m][0], parents[m][1]);
            }
            continue;
        }
        note(above[0], above[1]);
        if (above[0] == other || above[1] == other) state_[end] |= half_;
    }
}

template <int corners>
void WorkTree<corners>::activate() {
    for (const Element& e : elements) {
        if (!e.alive || e.rule == 0 || table.rule(e.rule).temporary) continue;
        for (const std::uint32_t node : nodes(e)) activate(node);
    }
    noting_ = true;
}

template <int corners>
bool WorkTree<corners>::changed(const Element& e) const {
    const Topology& t = topology(e.shape);
    int touched = 0;
    for (std::size_t i = 0; i < t.corners; ++i) touched += touched_[e.corner[i]] >= sweep_ ? 1 : 0;
    if (touched < 2) return false;
    for (std::size_t i = 0; i < t.edges; ++i) {
        const std::uint32_t a = e.corner[t.edge[i][0]];
        const std::uint32_t b = e.corner[t.edge[i][1]];
        if (touched_[a] >= sweep_ && touched_[b] >= sweep_ &&
            changed_.find(pair(a, b)) != nullptr) {
            return true;
        }
    }
    return false;
}

template <int corners>
template <class Closure>
void WorkTree<corners>::close_open(Closure& closure) {
    while (!open.empty()) {
        const std::uint32_t e = open.back();
        open.pop_back();
        if (!is_leaf(elements[e])) continue;
        const std::uint16_t rule_number = closure(elements[e]);
        if (rule_number == 0) continue;
        const std::uint32_t child = refine(e, rule_number);
        for (std::size_t k = 0; k < rule(elements[e]).children.size(); ++k) {
            open.push_back(child + static_cast<std::uint32_t>(k));
        }
    }
}

template <int corners>
template <class Closure>
void WorkTree<corners>::close(Closure&& closure) {
    close_open(closure);
    while (changing_.size() > 0) {
        changed_ = std::exchange(changing_, {});
        ++sweep_;
        const auto count = static_cast<std::uint32_t>(elements.size());
        for (std::uint32_t leaf = 0; leaf < count; ++leaf) {
            if (!is_leaf(elements[leaf]) || !changed(elements[leaf])) continue;
            open.push_back(leaf);
            close_open(closure);
        }
    }
    changed_ = {};
}

}  // namespace nestgrid
