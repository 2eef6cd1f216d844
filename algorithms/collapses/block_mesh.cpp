// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/block_mesh.hpp>

#include <algorithm>

namespace nestgrid::engine {

namespace {

bool has(const BlockMesh::Corners& corners, std::uint32_t vertex) {
    return corners[0] == vertex || corners[1] == vertex || corners[2] == vertex;
}

}  // namespace

void BlockMesh::connect() {
    around_.assign(vertices.size(), {});
    mark_.assign(vertices.size(), 0);
    position_.clear();
    for (const CollapsingVertex& vertex : vertices) position_.push_back(vertex.x);
    for (std::uint32_t t = 0; t < own; ++t) {
        for (const std::uint32_t v : triangles[t]) around_[v].push_back(t);
    }
}

void BlockMesh::find_star(std::uint32_t u, std::uint32_t v, Star& star) const {
    star.clear();
    for (const std::uint32_t centre : {u, v}) {
        const std::uint32_t other = centre == u ? v : u;
        for (const std::uint32_t t : around_[centre]) {
            const Corners& c = triangles[t];
            const bool goes = has(c, other);
            if (goes && centre == v) continue;
            const std::size_t i = c[0] == centre ? 0 : c[1] == centre ? 1 : 2;
            star.push_back({t, centre, c[(i + 1) % 3], c[(i + 2) % 3], goes});
        }
    }
}

bool BlockMesh::keeps_manifold(std::uint32_t u, std::uint32_t v, const Star& star) {
    boost::container::small_vector<std::uint32_t, 2> opposite;
    for (const StarTriangle& t : star) {
        if (t.goes) opposite.push_back(t.a == v ? t.b : t.a);
    }
    if (opposite.empty() || opposite.size() > 2) return false;
    // An edge between two borders would join them.
    const bool borders = vertices[u].on_border && vertices[v].on_border;
    if (borders && opposite.size() != 1) return false;
    const auto mark_around = [&](std::uint32_t centre, std::uint8_t mark) {
        for (const std::uint32_t t : around_[centre]) {
            for (const std::uint32_t w : triangles[t]) mark_[w] = mark;
        }
    };
    std::size_t common = 0;
    mark_around(u, 1);
    mark_[u] = mark_[v] = 0;
    for (const std::uint32_t t : around_[v]) {
        for (const std::uint32_t w : triangles[t]) {
            common += mark_[w];
            mark_[w] = 0;
        }
    }
    mark_around(u, 0);
    if (common != opposite.size()) return false;
    if (opposite.size() == 1) return around_[opposite[0]].size() > 1;  // or it would vanish
    // The collapse of an edge of a tetrahedron would leave two triangles, back to back.
    bool at_u = false;
    bool at_v = false;
    for (const StarTriangle& t : star) {
        if (t.goes) continue;
        const bool both = (t.a == opposite[0] || t.a == opposite[1]) &&
                          (t.b == opposite[0] || t.b == opposite[1]);
        (t.centre == u ? at_u : at_v) |= both;
    }
    return !(at_u && at_v);
}

void BlockMesh::collapse(std::uint32_t u, std::uint32_t v, const CollapsePlace& place) {
    const auto drop = [](Around& list, std::uint32_t t) {
        list.erase(std::find(list.begin(), list.end(), t));
    };
    Around kept;
    for (const std::uint32_t t : around_[u]) {
        Corners& c = triangles[t];
        if (!has(c, v)) {
            kept.push_back(t);
            continue;
        }
        for (const std::uint32_t w : c) {
            if (w != u) drop(around_[w], t);
        }
        c[0] = gone;
    }
    for (const std::uint32_t t : around_[v]) {
        std::replace(triangles[t].begin(), triangles[t].end(), v, u);
        kept.push_back(t);
    }
    around_[v].clear();
    around_[u] = std::move(kept);
    CollapsingVertex& to = vertices[u];
    const CollapsingVertex& from = vertices[v];
    if (place.x != to.x) to.drawn = place.x == from.x ? from.drawn : CollapsingVertex::moved;
    to.x = position_[u] = place.x;
    to.quadric.add(from.quadric);
    to.colours.add(from.colours);
    to.colours.set_values(place.colours);
    if (from.freedom.count() > to.freedom.count()) to.freedom = from.freedom;
    to.on_border = to.on_border || from.on_border;
    to.at_boundary = to.at_boundary || from.at_boundary;
}

std::span<const std::uint32_t> BlockMesh::neighbours(std::uint32_t vertex) {
    neighbours_.clear();
    mark_[vertex] = 1;
    for (const std::uint32_t t : around_[vertex]) {
        for (const std::uint32_t w : triangles[t]) {
            if (mark_[w] != 0) continue;
            mark_[w] = 1;
            neighbours_.push_back(w);
        }
    }
    for (const std::uint32_t w : neighbours_) mark_[w] = 0;
    mark_[vertex] = 0;
    return neighbours_;
}

}  // namespace nestgrid::engine
