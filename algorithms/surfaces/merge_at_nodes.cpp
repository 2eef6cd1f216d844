// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/merge_at_nodes.hpp>

#include <algorithm>

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
    struct Side {
        Edge edge;
        Vertex opposite;
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
    bool separate_offenders();
    std::vector<Side> changed_sides() const;
    void find_shared_edges(std::vector<Vertex>& offenders) const;
    void find_pinched_vertices(std::vector<Vertex>& offenders) const;
    static bool is_one_fan(std::span<const Edge> link);
    void find_boundary();
    void rewrite();

    Surface<3>& surface_;
    const VerticesAtNodes& at_nodes_;
    std::vector<std::uint32_t> entry_;  // by vertex: its place in at_nodes_, or none
    UnionFind classes_;
    std::vector<bool> merged_;   // by root: whether its class is one vertex at the node
    std::vector<bool> on_line_;  // by root: whether collinear triangles may have it
    std::vector<NumberedTriangle> triangles_;
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
    struct Turned {
        std::array<Vertex, 3> v;  // the least vertex first
        std::uint32_t number;
    };
    std::vector<Turned> forwards;
    std::vector<Turned> backwards;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        auto v = triangles_[t].v;
        if (!merged_[v[0]] || !merged_[v[1]] || !merged_[v[2]]) continue;
        std::rotate(v.begin(), std::ranges::min_element(v), v.end());
        const bool turned = v[1] > v[2];
        if (turned) std::swap(v[1], v[2]);
        (turned ? backwards : forwards).push_back({v, t});
    }
    std::ranges::stable_sort(forwards, {}, &Turned::v);
    std::ranges::stable_sort(backwards, {}, &Turned::v);
    auto back = backwards.begin();
    for (const Turned& t : forwards) {
        while (back != backwards.end() && back->v < t.v) ++back;
        if (back == backwards.end() || back->v != t.v) continue;
        triangles_[t.number].from = none;
        triangles_[back++->number].from = none;
    }
    std::erase_if(triangles_, [](const NumberedTriangle& t) { return t.from == none; });
}

/// The directed sides of triangles that renaming and flips may have changed, sorted.
auto NodeMerge::changed_sides() const -> std::vector<Side> {
    std::vector<Side> sides;
    for (const NumberedTriangle& t : triangles_) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Edge edge{t.v[i], t.v[(i + 1) % 3]};
            if (on_line_[edge[0]] || on_line_[edge[1]]) sides.push_back({edge, t.v[(i + 2) % 3]});
        }
    }
    std::ranges::sort(sides, {}, &Side::edge);
    return sides;
}

/// Finds the ends of edges along which two triangles run the same way, and the vertices opposite
/// edges of which neither end is merged.
void NodeMerge::find_shared_edges(std::vector<Vertex>& offenders) const {
    const std::vector<Side> sides = changed_sides();
    for (std::size_t i = 1; i < sides.size(); ++i) {
        const auto& [a, b] = sides[i].edge;
        if (sides[i].edge != sides[i - 1].edge) continue;
        offenders.insert(offenders.end(), {a, b});
        if (merged_[a] || merged_[b]) continue;
        offenders.insert(offenders.end(), {sides[i].opposite, sides[i - 1].opposite});
    }
}

/// Finds merged vertices around which the triangles are not one fan.
void NodeMerge::find_pinched_vertices(std::vector<Vertex>& offenders) const {
    struct Opposite {
        Vertex vertex;
        Edge side;
    };
    std::vector<Opposite> all;
    for (const NumberedTriangle& t : triangles_) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (merged_[t.v[i]]) all.push_back({t.v[i], {t.v[(i + 1) % 3], t.v[(i + 2) % 3]}});
        }
    }
    std::ranges::stable_sort(all, {}, &Opposite::vertex);
    std::vector<Edge> link;
    for (std::size_t i = 0; i < all.size();) {
        const Vertex vertex = all[i].vertex;
        link.clear();
        for (; i < all.size() && all[i].vertex == vertex; ++i) link.push_back(all[i].side);
        if (!is_one_fan(link)) offenders.push_back(vertex);
    }
}

/// Whether the sides opposite a vertex form one path or one ring. Requires that no two sides begin,
/// and no two end, at one vertex.
bool NodeMerge::is_one_fan(std::span<const Edge> link) {
    std::size_t steps = 0;
    Vertex at = link[0][0];
    const auto go_on = [&](std::size_t end) {
        const auto next = std::ranges::find(link, at, [&](const Edge& e) { return e[end]; });
        if (next == link.end()) return false;
        at = (*next)[1 - end];
        ++steps;
        return true;
    };
    while (go_on(0)) {
        if (at == link[0][0]) return steps == link.size();
    }
    at = link[0][0];
    while (go_on(1)) {
    }
    return steps == link.size();
}

/// Takes the classes apart at which the surface is no manifold. \return whether there were any
bool NodeMerge::separate_offenders() {
    std::vector<Vertex> offenders;
    find_shared_edges(offenders);
    if (offenders.empty()) find_pinched_vertices(offenders);
    bool any = false;
    for (const Vertex v : offenders) {
        any = any || merged_[v];
        merged_[v] = false;
    }
    return any;
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
    const std::vector<Side> sides = changed_sides();
    for (const Side& side : sides) {
        const Edge back{side.edge[1], side.edge[0]};
        if (!std::ranges::binary_search(sides, back, {}, &Side::edge))
            boundary.push_back(side.edge);
    }
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
