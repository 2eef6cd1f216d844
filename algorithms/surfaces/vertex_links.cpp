// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/vertex_links.hpp>

#include <algorithm>
#include <numeric>

namespace nestgrid::engine {

void VertexLinks::find(std::span<const NumberedTriangle> triangles,
                       const std::vector<bool>& wanted) {
    first_.assign(wanted.size() + 1, 0);
    const auto for_each_corner = [&](auto&& function) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const auto& v = triangles[t].v;
            if (wanted[v[0]]) function(v[0], OppositeSide{{v[1], v[2]}, t});
            if (wanted[v[1]]) function(v[1], OppositeSide{{v[2], v[0]}, t});
            if (wanted[v[2]]) function(v[2], OppositeSide{{v[0], v[1]}, t});
        }
    };
    for_each_corner([&](std::uint32_t v, const OppositeSide&) { ++first_[v + 1U]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    sides_.resize(first_.back());
    for_each_corner([&](std::uint32_t v, const OppositeSide& side) { sides_[first_[v]++] = side; });
    std::shift_right(first_.begin(), first_.end(), 1);
    first_[0] = 0;
}

bool is_one_fan(VertexLink link) {
    std::size_t steps = 0;
    const std::uint32_t start = link[0].edge[0];
    std::uint32_t at = start;
    const auto go_on = [&](std::size_t end) {
        const auto next = std::ranges::find_if(
            link, [&](const OppositeSide& side) { return side.edge[end] == at; });
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

}  // namespace nestgrid::engine
