// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A hierarchy unpacked, for the time of one adaptation.
//
// Invariants:
//   - a node is known by the two nodes it lies between, a face's centre by the midpoints of two of
//     its edges: exact keys, no coordinates, no adjacency;
//   - a node is active while some refined element makes it; an edge is split while its midpoint
//     is active.
// Consequence: closures ask for the state of an edge by its two ends, and elements that share it
// agree without knowing each other.
#pragma once

#include <limits>

#include <nestgrid/adapters/edge_changes.hpp>
#include <nestgrid/adapters/pattern.hpp>
#include <nestgrid/detail/key_table.hpp>

namespace nestgrid {

/// What a marker wants with a leaf.
enum class Mark : std::int8_t {
    coarsen = -1,  ///< carried out where all leaves of a family agree and the closure permits
    keep = 0,
    refine = 1,           ///< by the full rule of its shape; one bisection
    refine_horizontally,  ///< prisms: four
    refine_vertically,    ///< prisms: two
};

inline constexpr std::uint32_t no_node = 0xFFFFFFFFU;

/// The tree of a bisection while it is refined.
template <int corners>
class WorkTree {
public:
    struct Element {
        std::array<std::uint32_t, static_cast<std::size_t>(corners)> corner{};
        std::uint32_t child = 0;  ///< first one
        std::uint32_t nodes = 0;  ///< of its new nodes in `new_nodes`
        std::uint16_t rule = 0;   ///< 0 for a leaf
        Shape shape = Shape::point;
        std::uint8_t level = 0;
        Mark mark = Mark::keep;
        bool alive = true;
    };

    explicit WorkTree(PatternTable& patterns) : table{patterns} {}

    PatternTable& table;
    std::vector<Element> elements;         // the coarse ones first
    std::vector<std::uint32_t> new_nodes;  // of refined elements
    std::vector<Point> position;           // of nodes, as all below
    std::vector<std::array<std::uint32_t, 4>> parents;
    std::vector<std::uint32_t> created;           // in order
    std::vector<std::uint32_t> created_first{0};  // place of each one's parents in
    std::vector<std::uint32_t> created_parent;

    const Rule& rule(const Element& e) const { return *table.rule(e.rule).rule; }
    std::span<const std::uint32_t> nodes(const Element& e) const {
        return {new_nodes.data() + e.nodes, table.rule(e.rule).nodes.size()};
    }
    bool is_leaf(const Element& e) const { return e.alive && e.rule == 0; }

    void add_nodes(std::size_t count) {
        position.resize(count);
        parents.resize(count, {no_node, no_node, no_node, no_node});
        state_.resize(count, 0);
        changes_.set_node_count(count);
    }

    /// Makes room for about as many nodes and elements.
    void reserve(std::size_t node_count, std::size_t element_count) {
        by_key_.reserve(node_count);
        elements.reserve(element_count);
        new_nodes.reserve(element_count);
    }
    void add_coarse_node(std::uint32_t node, const Point& x) {
        position[node] = x;
        state_[node] |= known_;
    }

    /// The active node in the middle of an edge, or no_node.
    std::uint32_t midpoint(std::uint32_t a, std::uint32_t b) const {
        if ((state_[a] & state_[b] & end_) == 0) return no_node;
        return active(by_key_.find(pair(a, b)));
    }
    /// The active node in the middle of a face, from the midpoints of its edges.
    std::uint32_t centre(const std::array<std::uint32_t, 4>& midpoints) const {
        return active(by_key_.find(face_key(midpoints)));
    }
    /// Whether a node was made as the centre of a face, not as the midpoint of an edge.
    bool is_centre(std::uint32_t node) const { return parents[node][2] != no_node; }
    bool half_split(std::uint32_t midpoint) const { return (state_[midpoint] & half_) != 0; }

    /// Refines a leaf; makes the nodes that are not there. Its children are leaves.
    /// \return the first child
    /// \throw GridError for more than 2^31 nodes or 254 levels
    std::uint32_t refine(std::uint32_t leaf, std::uint16_t rule_number);

    /// Unpacking: refines a leaf with nodes that are known.
    std::uint32_t restore(std::uint32_t leaf, std::uint16_t rule_number,
                          std::span<const std::uint32_t> nodes);
    /// Unpacking: the nodes of a temporary refinement, which is not restored.
    void remember(const Element& e, std::uint16_t rule_number,
                  std::span<const std::uint32_t> nodes);

    /// Undoes the refinement of an element whose children are leaves.
    void coarsen(Element& e) {
        const std::size_t n = rule(e).children.size();
        for (std::size_t k = 0; k < n; ++k) elements[e.child + k].alive = false;
        e.rule = 0;
    }

    /// Finds out which nodes are active; afterwards refine() keeps that up to date.
    void activate();

    /// Refines leaves by closure(element), a rule or 0, until it says 0 for all of them. Looks only
    /// at leaves that are new since activate(), at those in `open`, and at edges that have changed.
    template <class Closure>
    void close(Closure&& closure);

    std::vector<std::uint32_t> open;  ///< leaves that close() must look at
    bool verify = false;              ///< throw where nodes do not fit or close() would refine

private:
    static constexpr std::uint8_t active_ = 1, half_ = 2, known_ = 4;
    static constexpr std::uint8_t end_ = 8;  // of a split edge

    static std::uint64_t pair(std::uint32_t a, std::uint32_t b) { return detail::edge_name(a, b); }
    static std::uint64_t face_key(const std::array<std::uint32_t, 4>& m) {
        return std::min(pair(m[0], m[1]), pair(m[2], m[3]));
    }
    std::uint32_t active(const std::uint32_t* node) const {
        return node != nullptr && (state_[*node] & active_) != 0 ? *node : no_node;
    }
    using Local = std::array<std::uint32_t, max_corners + max_new_nodes>;

    std::uint64_t key(const NodeRecipe& recipe, const Local& local) const {
        const auto at = [&](std::size_t i) { return local[recipe.of[i]]; };
        if (recipe.kind == NodeRecipe::Kind::edge) return pair(at(0), at(1));
        if (recipe.kind == NodeRecipe::Kind::face) return face_key({at(0), at(1), at(2), at(3)});
        return pair(at(0), at(1)) | std::uint64_t{1} << 63U;
    }
    void describe(std::uint32_t node, const NodeRecipe& recipe, const Stencil& stencil,
                  const Local& local);
    std::uint32_t free_node();
    std::uint32_t attach(std::uint32_t leaf, std::uint16_t rule_number, const Local& local);
    void activate(std::uint32_t node);
    template <class Closure>
    void close_open(Closure& closure);

    KeyTable<std::uint64_t, std::uint32_t> by_key_;
    std::vector<std::uint8_t> state_;
    std::uint32_t next_free_ = 0;
    detail::EdgeChanges changes_;
};

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
        if (changes_.has_begun() && !stored.temporary) activate(local[first + k]);
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
    state_[ends[0]] |= end_;
    state_[ends[1]] |= end_;
    changes_.note(ends[0], ends[1]);
    for (const std::size_t side : {0U, 1U}) {
        const std::uint32_t end = ends[side];
        const std::uint32_t other = ends[1 - side];
        const auto& above = parents[end];
        if (above[0] == no_node) continue;
        if (above[2] != no_node) {  // from the centre of a face: its edges
            for (const std::uint32_t m : above) {
                if (parents[m][1] != no_node) changes_.note(parents[m][0], parents[m][1]);
            }
            continue;
        }
        changes_.note(above[0], above[1]);
        if (above[0] == other || above[1] == other) state_[end] |= half_;
    }
}

template <int corners>
void WorkTree<corners>::activate() {
    for (const Element& e : elements) {
        if (!e.alive || e.rule == 0 || table.rule(e.rule).temporary) continue;
        for (const std::uint32_t node : nodes(e)) activate(node);
    }
    changes_.begin();
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
    while (changes_.begin_sweep()) {
        const auto count = static_cast<std::uint32_t>(elements.size());
        for (std::uint32_t leaf = 0; leaf < count; ++leaf) {
            const Element& e = elements[leaf];
            if (!is_leaf(e) || !changes_.any_of(e.shape, e.corner)) continue;
            open.push_back(leaf);
            close_open(closure);
        }
    }
}

}  // namespace nestgrid
