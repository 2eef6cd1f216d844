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

}  // namespace

std::vector<bool> remove_collapsed_fans(std::vector<NumberedTriangle>& triangles,
                                        const NodeClasses& classes) {
    struct Use {
        Vertex centre;
        std::uint32_t triangle;
    };
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
    Vertex apex = 0;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        NumberedTriangle& t = triangles[uses[i].triangle];
        while (t.v[0] != uses[i].centre) std::rotate(t.v.begin(), t.v.begin() + 1, t.v.end());
        const bool first = i == 0 || uses[i - 1].centre != uses[i].centre;
        if (first) apex = t.v[1];
        t.v[0] = apex;
        if (t.v[1] == apex || t.v[2] == apex) t.from = NumberedTriangle::removed;
    }
    erase_removed(triangles);
    return on_line;
}

}  // namespace nestgrid::engine
