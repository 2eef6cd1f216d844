// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <distances/curve_order.hpp>

#include <algorithm>
#include <numeric>

#include <distances/box_tree.hpp>

namespace nestgrid::engine {

namespace {

/// The bits of a number of 21 bits, with two zeros between them.
std::uint64_t spread_bits(std::uint64_t n) {
    n = (n | n << 32U) & 0x1F00000000FFFFU;
    n = (n | n << 16U) & 0x1F0000FF0000FFU;
    n = (n | n << 8U) & 0x100F00F00F00F00FU;
    n = (n | n << 4U) & 0x10C30C30C30C30C3U;
    return (n | n << 2U) & 0x1249249249249249U;
}

/// The place of a point on the Z curve through a box.
std::uint64_t place_on_curve(const Point& x, const Box& box) {
    constexpr double last = (1 << 21) - 1;
    std::uint64_t place = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        const double extent = box.high[d] - box.low[d];
        const double part = extent > 0 ? (x[d] - box.low[d]) / extent : 0;
        place |= spread_bits(static_cast<std::uint64_t>(std::clamp(part, 0.0, 1.0) * last)) << d;
    }
    return place;
}

}  // namespace

std::vector<std::uint32_t> order_on_curve(std::span<const Point> points) {
    const Box box = Box::around(points);
    std::vector<std::uint64_t> place;
    place.reserve(points.size());
    for (const Point& x : points) place.push_back(place_on_curve(x, box));
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(place[a], a) < std::pair(place[b], b);
    });
    return order;
}

}  // namespace nestgrid::engine
