// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/triangle_cells.hpp>

namespace nestgrid::engine {

TriangleCells::TriangleCells(const Box& box, std::size_t count) : low_{box.low} {
    const Point size = box.high - box.low;
    const double most = std::max({size[0], size[1], size[2]});
    double volume = 1;
    for (const double s : size) volume *= std::max(s, 1e-3 * most);
    edge_ = std::cbrt(volume / (2.0 * static_cast<double>(count) + 1));
    if (!(edge_ > 0)) edge_ = 1;
    for (std::size_t d = 0; d < 3; ++d) {
        cells_[d] = static_cast<std::size_t>(size[d] / edge_) + 1;
    }
    first_.assign(cells_[0] * cells_[1] * cells_[2], none);
    entries_.reserve(4 * count);
}

void TriangleCells::add(std::uint32_t triangle, const Box& box) {
    if (triangle >= seen_.size()) seen_.resize(triangle + std::size_t{1}, 0);
    for_each_cell(box, [&](std::size_t cell) {
        entries_.push_back({triangle, first_[cell]});
        first_[cell] = static_cast<std::uint32_t>(entries_.size() - 1);
    });
}

std::array<std::size_t, 3> TriangleCells::cell_of(const Point& x) const {
    std::array<std::size_t, 3> cell{};
    for (std::size_t d = 0; d < 3; ++d) {
        const double at = (x[d] - low_[d]) / edge_;
        cell[d] = at > 0 ? std::min(static_cast<std::size_t>(at), cells_[d] - 1) : 0;
    }
    return cell;
}

}  // namespace nestgrid::engine
