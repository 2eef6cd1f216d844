// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/merge_at_nodes.hpp>

#include <algorithm>
#include <numeric>

#include <surfaces/collinear_triangles.hpp>
#include <surfaces/union_find.hpp>

namespace nestgrid::engine {

namespace {

using Vertex = std::uint32_t;
using Edge = std::array<Vertex, 2>;
constexpr std::uint32_t none = ~std::uint32_t{0};

template <class Function>
void for_each_side(const std::array<Vertex, 3>& v, Function&& function) {
    function(v[0], v[1]);
    function(v[1], v[2]);
    function(v[2], v[0]);
}

class NodeMerge {
public:
    NodeMerge(Surface<3>& surface, const VerticesAtNodes& at_nodes)
        : surface_{surface}, at_nodes_{at_nodes}, classes_{surface.vertices.size()} {}

    void run() {
        find_classes();
        do {
            rename();
            remove_collapsed_fans();
            remove_collinear(
                triangles_, [&](Vertex v) { return position(v); },
                [&](Vertex v) { return bool{on_line_[v]}; });
            cancel_pairs();
        } while (join_neighbours() || separate_offenders());
        rewrite();
    }

private:
    /// The side opposite a vertex in a triangle.
    struct Side {
        Edge edge;
        std::uint32_t triangle;
    };

    NodeKey key(Vertex v) const { return at_nodes_.node[entry_[v]].key; }
    const Point& position(Vertex root) const {
        return merged_[root] ? at_nodes_.node[entry_[root]].x : surface_.vertices[root];
    }
    Vertex renamed(Vertex v) {
        const Vertex root = classes_.root(v);
        return merged_[root] ? root : v;
    }

    void find_classes();
    bool join_neighbours();
    void rename();
    bool is_collapsed(const NumberedTriangle& t) const;
    void remove_collapsed_fans();
    void cancel_pairs();
    void find_links();
    template <class Function>
    void for_each_link(Function&& function);
    bool separate_offenders();
    static bool is_one_fan(std::span<const Side> link);
    void find_boundary();
    void rewrite();

    Surface<3>& surface_;
    const VerticesAtNodes& at_nodes_;
    std::vector<std::uint32_t> entry_;  // by vertex: its place in at_nodes_, or none
    UnionFind classes_;
    std::vector<bool> merged_;   // by root: whether its class is one vertex at the node
    std::vector<bool> on_line_;  // by root: whether collinear triangles may have it
    std::vector<NumberedTriangle> triangles_;
    std::vector<Side> sides_;                // opposite the first vertex, the second, ...
    std::vector<std::uint32_t> first_side_;  // by vertex: its first one in sides_
};

/// Joins vertices at one node along the edges of the surface. The least vertex of a class
/// represents it.
void NodeMerge::find_classes() {
    const std::size_t count = surface_.vertices.size();
    entry_.assign(count, none);
    for (std::uint32_t i = 0; i < at_nodes_.vertex.size(); ++i) {
        entry_[at_nodes_.vertex[i]] = i;
    }
    for (const auto& triangle : surface_.simplices) {
        for_each_side(triangle, [&](Vertex a, Vertex b) {
            if (entry_[a] != none && entry_[b] != none && key(a) == key(b)) classes_.join(a, b);
        });
    }
    merged_.resize(count);
    for (Vertex v = 0; v < count; ++v) merged_[v] = entry_[v] != none && classes_.root(v) == v;
}

/// Joins classes at one node that have come to share a side of a triangle. \return whether there
/// were any
bool NodeMerge::join_neighbours() {
    bool any = false;
    for (const NumberedTriangle& t : triangles_) {
        for_each_side(t.v, [&](Vertex a, Vertex b) {
            const Vertex p = classes_.root(a);
            const Vertex q = classes_.root(b);
            if (p == q || !merged_[p] || !merged_[q] || key(p) != key(q)) return;
            classes_.join(p, q);
            merged_[std::max(p, q)] = false;
            any = true;
        });
    }
    return any;
}

/// Renames the vertices of all triangles, and leaves out those that repeat a vertex.
void NodeMerge::rename() {
    triangles_.clear();
    for (std::uint32_t s = 0; s < surface_.simplices.size(); ++s) {
        const auto& v = surface_.simplices[s];
        const NumberedTriangle t{{renamed(v[0]), renamed(v[1]), renamed(v[2])}, s};
        if (t.v[0] != t.v[1] && t.v[1] != t.v[2] && t.v[2] != t.v[0]) triangles_.push_back(t);
    }
}

/// Whether some, but not all vertices of a triangle are merged, and they lie on one line.
bool NodeMerge::is_collapsed(const NumberedTriangle& t) const {
    const auto& [a, b, c] = t.v;
    const int merged = merged_[a] + merged_[b] + merged_[c];
    return 0 < merged && merged < 3 && are_collinear(position(a), position(b), position(c));
}

/// Replaces each fan around a vertex that is not merged, all of whose triangles are collapsed and
/// have two merged vertices, by triangles between the vertices around it. Other vertices of
/// collapsed triangles stay, and join remove_collinear().
void NodeMerge::remove_collapsed_fans() {
    struct Use {
        Vertex centre;
        std::uint32_t triangle;
    };
    std::vector<bool> stays(surface_.vertices.size(), false);
    std::vector<Use> uses;
    const auto is_free = [&](Vertex v) { return !merged_[v]; };
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const bool collapsed = is_collapsed(triangles_[t]);
        const bool has_two_free = std::ranges::count_if(triangles_[t].v, is_free) == 2;
        for (const Vertex v : triangles_[t].v) {
            if (merged_[v]) continue;
            if (collapsed) uses.push_back({v, t});
            if (!collapsed || has_two_free) stays[v] = true;
        }
    }
    on_line_ = merged_;
    for (const Use& use : uses) on_line_[use.centre] = true;
    std::erase_if(uses, [&](const Use& use) { return stays[use.centre]; });
    std::ranges::stable_sort(uses, {}, &Use::centre);
    Vertex apex = none;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        NumberedTriangle& t = triangles_[uses[i].triangle];
        while (t.v[0] != uses[i].centre) std::rotate(t.v.begin(), t.v.begin() + 1, t.v.end());
        const bool first = i == 0 || uses[i - 1].centre != uses[i].centre;
        if (first) apex = t.v[1];
        t.v[0] = apex;
        if (t.v[1] == apex || t.v[2] == apex) t.from = none;
    }
    std::erase_if(triangles_, [](const NumberedTriangle& t) { return t.from == none; });
}

/// Removes pairs of triangles with the same merged vertices and opposite orientations.
void NodeMerge::cancel_pairs() {
    for_each_link([&](Vertex v, std::span<const Side> link) {
        for (const Side& side : link) {
            const auto [a, b] = side.edge;
            if (!merged_[v] || !merged_[a] || !merged_[b] || v > a || v > b || a > b) continue;
            const Edge turned{b, a};
            const auto back = std::ranges::find_if(link, [&](const Side& other) {
                return other.edge == turned && triangles_[other.triangle].from != none;
            });
            if (back == link.end()) continue;
            triangles_[side.triangle].from = none;
            triangles_[back->triangle].from = none;
        }
    });
    std::erase_if(triangles_, [](const NumberedTriangle& t) { return t.from == none; });
}

/// Finds the triangles around each vertex that renaming and flips may have changed.
void NodeMerge::find_links() {
    first_side_.assign(surface_.vertices.size() + 1, 0);
    const auto for_each_corner = [&](auto&& function) {
        for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
            const auto& v = triangles_[t].v;
            if (on_line_[v[0]]) function(v[0], Side{{v[1], v[2]}, t});
            if (on_line_[v[1]]) function(v[1], Side{{v[2], v[0]}, t});
            if (on_line_[v[2]]) function(v[2], Side{{v[0], v[1]}, t});
        }
    };
    for_each_corner([&](Vertex v, const Side&) { ++first_side_[v + 1U]; });
    std::partial_sum(first_side_.begin(), first_side_.end(), first_side_.begin());
    sides_.resize(first_side_.back());
    for_each_corner([&](Vertex v, const Side& side) { sides_[first_side_[v]++] = side; });
    std::shift_right(first_side_.begin(), first_side_.end(), 1);
    first_side_[0] = 0;
}

/// Calls function(vertex, link) for each of these vertices that has triangles; the link consists of
/// the sides opposite the vertex.
template <class Function>
void NodeMerge::for_each_link(Function&& function) {
    find_links();
    for (Vertex v = 0; v < surface_.vertices.size(); ++v) {
        const std::uint32_t first = first_side_[v];
        const std::uint32_t last = first_side_[v + 1U];
        if (first != last) function(v, std::span<const Side>(sides_).subspan(first, last - first));
    }
}

/// Takes the classes apart at which the surface is no manifold: where two triangles run along an
/// edge the same way, and where the triangles around a vertex are not one fan.
/// \return whether there were any
bool NodeMerge::separate_offenders() {
    std::vector<Vertex> offenders;
    for_each_link([&](Vertex v, std::span<const Side> link) {
        bool shares = false;
        for (const Side& side : link) {
            for (const std::size_t end : {0U, 1U}) {
                const Vertex at = side.edge[end];
                const auto meets = [&](const Side& other) { return other.edge[end] == at; };
                if (std::ranges::count_if(link, meets) < 2) continue;
                shares = true;
                offenders.insert(offenders.end(), {v, at});
                if (!merged_[v] && !merged_[at]) offenders.push_back(side.edge[1 - end]);
            }
        }
        if (!shares && merged_[v] && !is_one_fan(link)) offenders.push_back(v);
    });
    bool any = false;
    for (const Vertex v : offenders) {
        any = any || merged_[v];
        merged_[v] = false;
    }
    return any;
}

/// Whether the sides opposite a vertex form one path or one ring. Requires that no two sides begin,
/// and no two end, at one vertex.
bool NodeMerge::is_one_fan(std::span<const Side> link) {
    std::size_t steps = 0;
    const Vertex start = link[0].edge[0];
    Vertex at = start;
    const auto go_on = [&](std::size_t end) {
        const auto next =
            std::ranges::find_if(link, [&](const Side& side) { return side.edge[end] == at; });
        if (next == link.end()) return false;
        at = next->edge[1 - end];
        ++steps;
        return true;
    };
    while (go_on(0)) {
        if (at == start) return steps == link.size();
    }
    at = start;
    while (go_on(1)) {
    }
    return steps == link.size();
}

/// Keeps the boundary edges that nothing changed, and adds those changed ones that one triangle
/// alone has.
void NodeMerge::find_boundary() {
    auto& boundary = surface_.boundary;
    for (auto& ridge : boundary) ridge = {renamed(ridge[0]), renamed(ridge[1])};
    const auto is_changed = [&](const Edge& edge) {
        return on_line_[edge[0]] || on_line_[edge[1]];
    };
    std::erase_if(boundary, is_changed);
    for_each_link([&](Vertex v, std::span<const Side> link) {
        const auto any = [&](std::size_t end, Vertex at) {
            return std::ranges::any_of(link, [&](const Side& s) { return s.edge[end] == at; });
        };
        for (const Side& side : link) {
            const auto [from, to] = side.edge;
            if (!any(1, from)) boundary.push_back({v, from});
            if (!on_line_[to] && !any(0, to)) boundary.push_back({to, v});
        }
    });
}

/// Writes the result into the surface, vertices in their old order.
void NodeMerge::rewrite() {
    find_boundary();
    std::vector<Vertex> number(surface_.vertices.size(), none);
    for (const NumberedTriangle& t : triangles_) {
        for (const Vertex v : t.v) number[v] = 0;
    }
    const std::size_t stride =
        number.empty() ? 0 : surface_.attributes.size() / surface_.vertices.size();
    Vertex next = 0;
    for (Vertex v = 0; v < number.size(); ++v) {
        if (number[v] == none) continue;
        const double* const attributes = merged_[v]
                                             ? at_nodes_.attributes.data() + entry_[v] * stride
                                             : surface_.attributes.data() + v * stride;
        std::copy_n(attributes, stride, surface_.attributes.data() + next * stride);
        surface_.vertices[next] = position(v);
        if (!surface_.normals.empty()) surface_.normals[next] = surface_.normals[v];
        number[v] = next++;
    }
    surface_.vertices.resize(next);
    surface_.attributes.resize(next * stride);
    if (!surface_.normals.empty()) surface_.normals.resize(next);
    std::vector<Surface<3>::Simplex> simplices;
    std::vector<std::uint32_t> element_of;
    for (const NumberedTriangle& t : triangles_) {
        simplices.push_back({number[t.v[0]], number[t.v[1]], number[t.v[2]]});
        if (!surface_.element_of.empty()) element_of.push_back(surface_.element_of[t.from]);
    }
    surface_.simplices = std::move(simplices);
    surface_.element_of = std::move(element_of);
    for (auto& [a, b] : surface_.boundary) {
        a = number[a];
        b = number[b];
    }
}

}  // namespace

void merge_at_nodes(Surface<3>& surface, const VerticesAtNodes& at_nodes) {
    if (!at_nodes.vertex.empty()) NodeMerge(surface, at_nodes).run();
}

}  // namespace nestgrid::engine
