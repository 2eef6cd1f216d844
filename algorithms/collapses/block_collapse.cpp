// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/block_collapse.hpp>

#include <algorithm>

namespace nestgrid::engine {

void BlockCollapse::run() {
    for (std::uint32_t t = 0; t < mesh_->own; ++t) {
        const auto corners = mesh_->triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = corners[i];
            const std::uint32_t b = corners[(i + 1) % 3];
            const bool border = mesh_->vertices[a].on_border() && mesh_->vertices[b].on_border();
            if (a < b || border) push(a, b);
        }
    }
    while (!edges_.empty()) {
        const Entry edge = edges_.top();
        edges_.pop();
        if (version_[edge.u] + version_[edge.v] == edge.stamp) attempt(edge.u, edge.v);
    }
}

void BlockCollapse::push(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t u = std::min(a, b);
    const std::uint32_t v = std::max(a, b);
    if (!mesh_->vertices[u].moves || !mesh_->vertices[v].moves) return;
    Quadric quadric = mesh_->vertices[u].quadric;
    quadric.add(mesh_->vertices[v].quadric);
    const Places found = places(u, v, quadric);
    if (found.empty()) return;
    const Point along = mesh_->x(u) - mesh_->x(v);
    // The length decides between edges whose quadrics are equally small, as in a plane.
    const double cost = std::max(quadric.at(found[0]), 0.0) + 1e-9 * dot(along, along);
    edges_.push({cost, u, v, version_[u] + version_[v]});
}

auto BlockCollapse::places(std::uint32_t u, std::uint32_t v, const Quadric& quadric) const
    -> Places {
    const CollapsingVertex& a = mesh_->vertices[u];
    const CollapsingVertex& b = mesh_->vertices[v];
    const bool a_stays = !b.freedom.keeps(a.freedom);
    const bool b_stays = !a.freedom.keeps(b.freedom);
    if (a_stays && b_stays) return {};
    if (a_stays) return {a.x};
    if (b_stays) return {b.x};
    const Point middle = 0.5 * (a.x + b.x);
    Point best = quadric.least(middle, a.freedom);
    const Point off = best - middle;
    const Point along = a.x - b.x;
    if (!(dot(off, off) < 4 * dot(along, along))) best = middle;
    std::array<std::pair<double, Point>, 3> others{
        {{quadric.at(middle), middle}, {quadric.at(a.x), a.x}, {quadric.at(b.x), b.x}}};
    std::stable_sort(others.begin(), others.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
    Places result{best};
    for (const auto& [cost, x] : others) result.push_back(x);
    return result;
}

void BlockCollapse::attempt(std::uint32_t u, std::uint32_t v) {
    mesh_->find_star(u, v, star_);
    if (!mesh_->keeps_manifold(u, v, star_)) {
        ++counts_.refused_by_manifold;
        return;
    }
    Quadric quadric = mesh_->vertices[u].quadric;
    quadric.add(mesh_->vertices[v].quadric);
    Refusal refused = nullptr;
    for (const Point& w : places(u, v, quadric)) {
        refused = checks_.refuse(u, v, star_, w);
        if (refused != nullptr) continue;
        mesh_->collapse(u, v, w);
        ++counts_.collapses;
        ++version_[u];
        version_[v] += 1U << 20U;  // no entry of an edge to it is valid any more
        checks_.note_done(star_, u, *mesh_);
        for (const std::uint32_t y : mesh_->neighbours(u)) push(u, y);
        return;
    }
    if (refused != nullptr) ++(counts_.*refused);
}

}  // namespace nestgrid::engine
