// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/collapsed_fans.hpp>

#include <algorithm>

namespace nestgrid::engine {

namespace {

using Vertex = std::uint32_t;

bool is_collapsed(const NumberedTriangle& t, const NodeClasses& classes) {
    const auto& [a, b, c] = t.v;
    const int merged = classes.is_merged(a) + classes.is_merged(b) + classes.is_merged(c);
    return 0 < merged && merged < 3 &&
           are_collinear(classes.position(a), classes.position(b), classes.position(c));
}

/// A triangle of a fan around a vertex.
struct Use {
    Vertex centre;
    std::uint32_t triangle;
};

/// Puts the vertex around the fan that lies at the least place in the place of the centre.
void move_centre(std::vector<NumberedTriangle>& triangles, std::span<const Use> fan,
                 const NodeClasses& classes) {
    for (const Use& use : fan) {
        auto& v = triangles[use.triangle].v;
        while (v[0] != use.centre) std::rotate(v.begin(), v.begin() + 1, v.end());
    }
    const auto place = [&](const Use& use) {
        return classes.position(triangles[use.triangle].v[1]);
    };
    const Vertex apex = triangles[std::ranges::min_element(fan, {}, place)->triangle].v[1];
    for (const Use& use : fan) {
        NumberedTriangle& t = triangles[use.triangle];
        t.v[0] = apex;
        if (t.v[1] == apex || t.v[2] == apex) t.from = NumberedTriangle::removed;
    }
}

}  // namespace

std::vector<bool> remove_collapsed_fans(std::vector<NumberedTriangle>& triangles,
                                        const NodeClasses& classes) {
    std::vector<bool> on_line = classes.merged();
    std::vector<bool> stays(on_line.size(), false);
    std::vector<Use> uses;
    const auto is_free = [&](Vertex v) { return !classes.is_merged(v); };
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const bool collapsed = is_collapsed(triangles[t], classes);
        const bool has_two_free = std::ranges::count_if(triangles[t].v, is_free) == 2;
        for (const Vertex v : triangles[t].v) {
            if (!is_free(v)) continue;
            if (collapsed) uses.push_back({v, t});
            if (!collapsed || has_two_free) stays[v] = true;
        }
    }
    for (const Use& use : uses) on_line[use.centre] = true;
    std::erase_if(uses, [&](const Use& use) { return stays[use.centre]; });
    std::ranges::stable_sort(uses, {}, &Use::centre);
    for (auto rest = std::span(uses); !rest.empty();) {
        const auto same = [&](const Use& use) { return use.centre == rest.front().centre; };
        const auto end = std::find_if_not(rest.begin(), rest.end(), same);
        const auto fan = rest.first(static_cast<std::size_t>(end - rest.begin()));
        rest = rest.subspan(fan.size());
        move_centre(triangles, fan, classes);
    }
    erase_removed(triangles);
    return on_line;
}

}  // namespace nestgrid::engine
