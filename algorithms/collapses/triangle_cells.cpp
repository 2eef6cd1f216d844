// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/triangle_cells.hpp>

#include <numeric>

namespace nestgrid::engine {

BoxedTriangle::BoxedTriangle(std::uint32_t number, const Box& box)
    : triangle{number}, low{}, high{} {
    constexpr float far = std::numeric_limits<float>::infinity();
    for (std::size_t d = 0; d < 3; ++d) {
        low[d] = std::nextafter(static_cast<float>(box.low[d]), -far);
        high[d] = std::nextafter(static_cast<float>(box.high[d]), far);
    }
}

TriangleCells::TriangleCells(std::span<const BoxedTriangle> triangles) {
    Box box;
    for (const BoxedTriangle& t : triangles) {
        box.add(Point{t.low[0], t.low[1], t.low[2]});
        box.add(Point{t.high[0], t.high[1], t.high[2]});
    }
    const Point size = triangles.empty() ? Point{1, 1, 1} : box.high - box.low;
    const double most = std::max({size[0], size[1], size[2]});
    double volume = 1;
    for (const double s : size) volume *= std::max(s, 1e-3 * most);
    double edge = std::cbrt(volume / (2.0 * static_cast<double>(triangles.size()) + 1));
    if (!(edge > 0)) edge = 1;
    per_edge_ = static_cast<float>(1 / edge);
    std::size_t count = 1;
    for (std::size_t d = 0; d < 3; ++d) {
        low_[d] = triangles.empty() ? 0.0F : static_cast<float>(box.low[d]);
        cells_[d] = static_cast<std::size_t>(size[d] / edge) + 1;
        count *= cells_[d];
    }
    first_.assign(count + 2, 0);
    last_added_.assign(count, none);
    for (const BoxedTriangle& t : triangles) {
        for_each_cell(t, [&](std::size_t cell, const Index&) { ++first_[cell + 2]; });
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    sorted_.assign(first_.back(), BoxedTriangle(0, Box{}));
    for (const BoxedTriangle& t : triangles) {
        for_each_cell(t, [&](std::size_t cell, const Index&) { sorted_[first_[cell + 1]++] = t; });
    }
}

void TriangleCells::add(const BoxedTriangle& triangle) {
    for_each_cell(triangle, [&](std::size_t cell, const Index&) {
        added_.push_back({triangle, last_added_[cell]});
        last_added_[cell] = static_cast<std::uint32_t>(added_.size() - 1);
    });
}

}  // namespace nestgrid::engine
