// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A tree of boxes over items that come in an order in which near ones follow each other, as
// elements do in a depth-first walk: four boxes, one after the other, have one box around them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

using Triangle = std::array<Point, 3>;

/// A box along the axes; at first an empty one.
struct Box {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    Point low{infinity, infinity, infinity};
    Point high{-infinity, -infinity, -infinity};

    static Box around(std::span<const Point> points) {
        Box box;
        for (const Point& x : points) box.add(x);
        return box;
    }
    void add(const Point& x) {
        for (std::size_t d = 0; d < 3; ++d) {
            low[d] = std::min(low[d], x[d]);
            high[d] = std::max(high[d], x[d]);
        }
    }
    void add(const Box& box) {
        for (std::size_t d = 0; d < 3; ++d) {
            low[d] = std::min(low[d], box.low[d]);
            high[d] = std::max(high[d], box.high[d]);
        }
    }
    bool meets(const Box& b) const {
        return low[0] <= b.high[0] && b.low[0] <= high[0] && low[1] <= b.high[1] &&
               b.low[1] <= high[1] && low[2] <= b.high[2] && b.low[2] <= high[2];
    }
    bool contains(const Point& x) const { return meets({x, x}); }
    double diameter() const { return norm(high - low); }
    /// The square of the distance of a point; 0 inside.
    double square_distance(const Point& x) const {
        double sum = 0;
        for (std::size_t d = 0; d < 3; ++d) {
            const double off = std::max({low[d] - x[d], x[d] - high[d], 0.0});
            sum += off * off;
        }
        return sum;
    }
    /// Makes the box larger on all sides.
    void widen(double by) {
        low = low - Point{by, by, by};
        high = high + Point{by, by, by};
    }
};

/// A triangle with its box and its plane.
struct FlatTriangle {
    explicit FlatTriangle(const Triangle& x)
        : corner{x}, box{Box::around(x)}, normal{cross(x[1] - x[0], x[2] - x[0])} {
        slack = 1e-12 * box.diameter() * norm(normal);
    }
    /// False where a box lies beside the triangle's box, or on one side of its plane.
    bool may_meet(const Box& b) const {
        if (!box.meets(b)) return false;
        double middle = 0;
        double reach = slack;
        for (std::size_t d = 0; d < 3; ++d) {
            middle += normal[d] * (0.5 * (b.low[d] + b.high[d]) - corner[0][d]);
            reach += std::abs(normal[d]) * 0.5 * (b.high[d] - b.low[d]);
        }
        return std::abs(middle) <= reach;
    }

    /// The gradient of a linear function on the triangle, in its plane.
    Point gradient(const std::array<double, 3>& at_corners) const {
        const Point a = corner[1] - corner[0];
        const Point b = corner[2] - corner[0];
        return (1 / dot(normal, normal)) * ((at_corners[1] - at_corners[0]) * cross(b, normal) +
                                            (at_corners[2] - at_corners[0]) * cross(normal, a));
    }
    /// A linear function on the triangle, continued in its plane and constant across.
    double interpolant(const std::array<double, 3>& at_corners, const Point& x) const {
        return at_corners[0] + dot(gradient(at_corners), x - corner[0]);
    }

    Triangle corner;
    Box box;
    Point normal;
    double slack;
};

class BoxTree {
public:
    static constexpr std::size_t fan = 4;  ///< items in a group, and groups in one above

    /// Adds the box of the next item.
    void add(const Box& box) {
        if (count_ % fan == 0) groups_.emplace_back();
        groups_.back().add(box);
        ++count_;
    }
    /// Makes the tree; no item is added any more.
    void finish() {
        levels_.clear();
        levels_.push_back(std::move(groups_));
        while (levels_.back().size() > fan) {
            const std::vector<Box>& below = levels_.back();
            std::vector<Box> above((below.size() + fan - 1) / fan);
            for (std::size_t i = 0; i < below.size(); ++i) above[i / fan].add(below[i]);
            levels_.push_back(std::move(above));
        }
    }
    /// Calls function(item) for the items of all boxes of which meets(box) is true, in order, until
    /// it returns false. \return whether it never did
    template <class Meets, class Function>
    bool for_each(const Meets& meets, const Function& function) const {
        const auto of_box = [&](const Box& box, std::size_t /*level*/, std::size_t /*group*/) {
            return meets(box);
        };
        return for_each_in_groups(of_box, function);
    }
    /// for_each(), but meets(box, level, group) is told of which group the box is: items number
    /// fan * group and following on level 0, groups of the level below on the others.
    template <class Meets, class Function>
    bool for_each_in_groups(const Meets& meets, const Function& function) const {
        for (std::size_t i = 0; i < levels_.back().size(); ++i) {
            if (!visit(levels_.size() - 1, i, meets, function)) return false;
        }
        return true;
    }
    std::size_t memory_bytes() const {
        std::size_t bytes = 0;
        for (const auto& level : levels_) bytes += level.capacity() * sizeof(Box);
        return bytes;
    }

private:
    template <class Meets, class Function>
    bool visit(std::size_t level, std::size_t group, const Meets& meets,
               const Function& function) const {
        if (!meets(levels_[level][group], level, group)) return true;
        const std::size_t count = level == 0 ? count_ : levels_[level - 1].size();
        const std::size_t last = std::min(count, (group + 1) * fan);
        for (std::size_t i = group * fan; i < last; ++i) {
            if (!(level == 0 ? function(i) : visit(level - 1, i, meets, function))) return false;
        }
        return true;
    }

    std::size_t count_ = 0;
    std::vector<Box> groups_;
    std::vector<std::vector<Box>> levels_{{}};  // the finest first
};

}  // namespace nestgrid::engine
