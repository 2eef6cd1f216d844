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
            const bool border = mesh_->vertices[a].on_border && mesh_->vertices[b].on_border;
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
    const auto [found, least] = places(u, v);
    if (found.empty()) return;
    const Point along = mesh_->x(u) - mesh_->x(v);
    // The length decides between edges whose quadrics are equally small, as in a plane.
    edges_.push({std::max(least, 0.0) + 1e-9 * dot(along, along), u, v, version_[u] + version_[v]});
}

auto BlockCollapse::places(std::uint32_t u, std::uint32_t v) const -> std::pair<Places, double> {
    const CollapsingVertex& a = mesh_->vertices[u];
    const CollapsingVertex& b = mesh_->vertices[v];
    const bool a_stays = !b.freedom.keeps(a.freedom);
    const bool b_stays = !a.freedom.keeps(b.freedom);
    if (a_stays && b_stays) return {};
    Colours colours = a.colours;
    colours.add(b.colours);
    Quadric quadric = a.quadric;
    quadric.add(b.quadric);
    quadric.add(colours.quadric());
    const auto fitting = [&](const Point& x) { return CollapsePlace{x, colours.best_at(x)}; };
    const auto cost = [&](const CollapsePlace& place) {
        return quadric.at(place.x) + colours.excess(place.x, place.colours);
    };
    Places result;
    if (a_stays || b_stays) {
        const CollapsingVertex& stays = a_stays ? a : b;
        result.push_back(fitting(stays.x));
        if (!stays.colours.values().empty()) result.push_back({stays.x, stays.colours.values()});
        return {result, cost(result[0])};
    }
    const Point middle = 0.5 * (a.x + b.x);
    Point best = quadric.least(middle, a.freedom);
    const Point off = best - middle;
    const Point along = a.x - b.x;
    if (!(dot(off, off) < 4 * dot(along, along))) best = middle;
    using Other = std::pair<double, CollapsePlace>;
    std::array<Other, 3> others;
    std::size_t count = 0;
    for (const CollapsePlace& place : {fitting(middle), CollapsePlace{a.x, a.colours.values()},
                                       CollapsePlace{b.x, b.colours.values()}}) {
        others[count++] = {cost(place), place};
    }
    std::stable_sort(others.begin(), others.end(),
                     [](const Other& x, const Other& y) { return x.first < y.first; });
    result.push_back(fitting(best));
    for (const auto& [of, place] : others) result.push_back(place);
    return {result, cost(result[0])};
}

void BlockCollapse::attempt(std::uint32_t u, std::uint32_t v) {
    mesh_->find_star(u, v, star_);
    if (!mesh_->keeps_manifold(u, v, star_)) {
        ++counts_.refused_by_manifold;
        return;
    }
    Refusal refused = nullptr;
    for (const CollapsePlace& place : places(u, v).first) {
        refused = checks_.refuse(u, v, star_, place);
        if (refused != nullptr) continue;
        mesh_->collapse(u, v, place);
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
