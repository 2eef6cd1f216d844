// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/node_classes.hpp>

#include <algorithm>

#include <surfaces/widest_direction.hpp>

namespace nestgrid::engine {

namespace {

constexpr std::uint32_t no_entry = ~std::uint32_t{0};

template <class Function>
void for_each_side(const std::array<std::uint32_t, 3>& v, Function&& function) {
    function(v[0], v[1]);
    function(v[1], v[2]);
    function(v[2], v[0]);
}

}  // namespace

NodeClasses::NodeClasses(const Surface<3>& surface, const VerticesAtNodes& at_nodes)
    : surface_{surface},
      at_nodes_{at_nodes},
      entry_(surface.vertices.size(), no_entry),
      classes_{surface.vertices.size()},
      merged_(surface.vertices.size()) {
    for (std::uint32_t i = 0; i < at_nodes_.vertex.size(); ++i) entry_[at_nodes_.vertex[i]] = i;
    for (const auto& triangle : surface_.simplices) {
        for_each_side(triangle, [&](Vertex a, Vertex b) {
            if (entry_[a] != no_entry && entry_[b] != no_entry && key(a) == key(b))
                classes_.join(a, b);
        });
    }
    for (Vertex v = 0; v < merged_.size(); ++v) {
        merged_[v] = entry_[v] != no_entry && classes_.root(v) == v;
    }
}

bool NodeClasses::join_neighbours(std::span<const NumberedTriangle> triangles) {
    bool any = false;
    for (const NumberedTriangle& t : triangles) {
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

/// Whether no direction is in front of all triangles between a vertex and its link. Triangles
/// without a direction of their own do not count.
bool NodeClasses::is_folded(Vertex v, VertexLink link) const {
    std::vector<Point> directions;
    for (const OppositeSide& side : link) {
        const Point& a = position(side.edge[0]);
        const Point& b = position(side.edge[1]);
        if (are_collinear(position(v), a, b)) continue;
        directions.push_back(cross(a - position(v), b - position(v)));
    }
    if (directions.empty()) return false;
    // So that rounding does not depend on the order of the triangles.
    std::ranges::sort(directions);
    Point sum{0, 0, 0};
    for (Point& n : directions) {
        sum = sum + n;
        n = (1 / norm(n)) * n;
    }
    if (least_cosine(sum, directions) > 0) return false;
    return widest_direction(directions).cosine <= 0;
}

bool NodeClasses::split_nonmanifold_classes(const VertexLinks& links) {
    std::vector<Vertex> offenders;
    links.for_each([&](Vertex v, VertexLink link) {
        bool shares = false;
        for (const OppositeSide& side : link) {
            for (const std::size_t end : {0U, 1U}) {
                const Vertex at = side.edge[end];
                const auto meets = [&](const OppositeSide& s) { return s.edge[end] == at; };
                if (std::ranges::count_if(link, meets) < 2) continue;
                shares = true;
                offenders.insert(offenders.end(), {v, at});
                if (!merged_[v] && !merged_[at]) offenders.push_back(side.edge[1 - end]);
            }
        }
        if (shares || !merged_[v]) return;
        if (!is_one_fan(link) || is_folded(v, link)) offenders.push_back(v);
    });
    bool any = false;
    for (const Vertex v : offenders) {
        any = any || merged_[v];
        merged_[v] = false;
    }
    return any;
}

}  // namespace nestgrid::engine
