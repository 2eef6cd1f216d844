// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <span>

#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// The box around some points.
struct PointBox {
    Point low;
    Point high;

    static PointBox around(std::span<const Point> points) {
        PointBox box{points[0], points[0]};
        for (const Point& x : points.subspan(1)) box.add({x, x});
        return box;
    }
    void add(const PointBox& other) {
        for (std::size_t d = 0; d < 3; ++d) {
            low[d] = std::min(low[d], other.low[d]);
            high[d] = std::max(high[d], other.high[d]);
        }
    }
    void widen(double by) {
        for (std::size_t d = 0; d < 3; ++d) {
            low[d] -= by;
            high[d] += by;
        }
    }
    bool contains(const Point& x) const {
        bool in = true;
        for (std::size_t d = 0; d < 3; ++d) in &= x[d] >= low[d] && x[d] <= high[d];
        return in;
    }
    /// By how much another box exceeds this one.
    double exceeded_by(const PointBox& other) const {
        double most = 0;
        for (std::size_t d = 0; d < 3; ++d) {
            most = std::max({most, low[d] - other.low[d], other.high[d] - high[d]});
        }
        return most;
    }
};

}  // namespace nestgrid::engine
