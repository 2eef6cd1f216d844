// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The leaves of a stored grid, with their positions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include <nestgrid/rule.hpp>

namespace nestgrid {

/// A leaf, as a marker sees it.
struct Leaf {
    Shape shape = Shape::point;
    int level = 0;                         ///< refinements above it
    std::size_t coarse = 0;                ///< coarse element it descends from
    std::span<const Point> corners;        ///< positions
    std::span<const std::uint32_t> nodes;  ///< numbers of the corners

    Point centre() const {
        Point sum{0, 0, 0};
        for (const Point& x : corners) sum = sum + x;
        return 1.0 / static_cast<double>(corners.size()) * sum;
    }
};

namespace detail {

/// Walks a stored grid with the positions of its nodes.
template <class Grid, class Visitor>
class PositionWalk {
public:
    PositionWalk(const Grid& grid, Visitor& visitor) : grid_{grid}, visitor_{visitor} {}

    void run() {
        for (std::size_t i = 0; i < grid_.coarse_count(); ++i) {
            const auto c = grid_.coarse(i);
            coarse_ = i;
            visit(c.element, c.shape, 0, c.corners.data());
        }
    }

private:
    using Element = typename Grid::Element;

    void visit(const Element& e, Shape shape, int level, const Point* corners) {
        const std::size_t n = topology(shape).corners;
        const Rule* rule = grid_.split(e);
        visitor_(Leaf{shape, level, coarse_, {corners, n}, {e.corner.data(), n}}, rule == nullptr);
        if (rule == nullptr) return;
        std::array<Point, static_cast<std::size_t>(Grid::max_corners + Grid::max_new_nodes)> x;
        std::copy_n(corners, n, x.begin());
        for (std::size_t k = 0; k < rule->new_nodes.size(); ++k) {
            const Stencil& s = rule->new_nodes[k];
            Point sum{0, 0, 0};
            for (std::size_t i = 0; i < s.count; ++i) sum = sum + s.weight[i] * x[s.parent[i]];
            x[n + k] = sum;
        }
        std::array<Element, static_cast<std::size_t>(Grid::max_children)> child;
        grid_.children(e, std::span(child).first(rule->children.size()), context_);
        for (std::size_t c = 0; c < rule->children.size(); ++c) {
            const Child& to = rule->children[c];
            std::array<Point, static_cast<std::size_t>(Grid::max_corners)> y;
            for (std::size_t i = 0; i < topology(to.shape).corners; ++i) y[i] = x[to.corner[i]];
            visit(child[c], to.shape, level + 1, y.data());
        }
    }

    const Grid& grid_;
    Visitor& visitor_;
    typename Grid::Context context_;
    std::size_t coarse_ = 0;
};

}  // namespace detail

}  // namespace nestgrid
