// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/blocks.hpp>

#include <numeric>

namespace nestgrid::engine {

Blocks::Blocks(std::span<const Point> positions, std::size_t most, double cut)
    : block_of_(positions.size()) {
    std::vector<std::uint32_t> vertices(positions.size());
    std::iota(vertices.begin(), vertices.end(), 0U);
    constexpr double far = Box::infinity;
    divide(positions, vertices, {{-far, -far, -far}, {far, far, far}}, most, cut);
}

void Blocks::divide(std::span<const Point> x, std::span<std::uint32_t> vertices, const Box& region,
                    std::size_t most, double cut) {
    const std::size_t node = nodes_.size();
    nodes_.emplace_back();
    Box box;
    for (const std::uint32_t v : vertices) box.add(x[v]);
    const Point size = vertices.empty() ? Point{} : box.high - box.low;
    const auto axis =
        static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    if (vertices.size() <= most || !(size[axis] > 0)) {
        nodes_[node].block = static_cast<std::uint32_t>(regions_.size());
        for (const std::uint32_t v : vertices) block_of_[v] = nodes_[node].block;
        regions_.push_back(region);
        return;
    }
    const auto below = [&](std::uint32_t a, std::uint32_t b) { return x[a][axis] < x[b][axis]; };
    const auto middle =
        vertices.begin() + static_cast<std::ptrdiff_t>(cut * static_cast<double>(vertices.size()));
    std::nth_element(vertices.begin(), middle, vertices.end(), below);
    // Both sides get a vertex, also where many have the same coordinate.
    const double at = x[*middle][axis] > box.low[axis] ? x[*middle][axis] : box.high[axis];
    const auto first_above = std::partition(vertices.begin(), vertices.end(),
                                            [&](std::uint32_t v) { return x[v][axis] < at; });
    const auto lower = static_cast<std::size_t>(first_above - vertices.begin());
    Box under = region;
    Box over = region;
    under.high[axis] = over.low[axis] = at;
    divide(x, vertices.first(lower), under, most, cut);
    nodes_[node] = {axis, at, static_cast<std::uint32_t>(nodes_.size()), 0, false};
    divide(x, vertices.subspan(lower), over, most, cut);
}

}  // namespace nestgrid::engine
