// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "slice_jumps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace {

using nestgrid::dot;
using nestgrid::norm;
using nestgrid::Point;
using nestgrid::operator-;
using nestgrid::operator+;
using nestgrid::operator*;

/// VTK computes positions in float here and there.
constexpr double near = 1e-6;

/// Numbers of positions, equal for vertices that lie within that distance of the first one there.
std::vector<std::size_t> number_positions(const std::vector<Point>& vertices) {
    using Cell = std::array<long long, 3>;
    std::map<Cell, std::vector<std::size_t>> in_cell;  // the first vertices at positions
    const auto cell_of = [](const Point& x) {
        return Cell{std::llround(x[0] / (4 * near)), std::llround(x[1] / (4 * near)),
                    std::llround(x[2] / (4 * near))};
    };
    std::vector<std::size_t> number;
    for (const Point& x : vertices) {
        std::size_t here = number.size();
        const Cell low = cell_of(x - Point{near, near, near});
        const Cell high = cell_of(x + Point{near, near, near});
        for (long long i = low[0]; i <= high[0]; ++i) {
            for (long long j = low[1]; j <= high[1]; ++j) {
                for (long long k = low[2]; k <= high[2]; ++k) {
                    const auto found = in_cell.find({i, j, k});
                    if (found == in_cell.end()) continue;
                    for (const std::size_t v : found->second) {
                        if (norm(vertices[v] - x) <= near) here = v;
                    }
                }
            }
        }
        if (here == number.size()) in_cell[cell_of(x)].push_back(here);
        number.push_back(here);
    }
    return number;
}

/// An edge of one triangle: its ends, the one with the smaller number first.
struct Side {
    std::array<Point, 2> x;
    std::array<double, 2> value;
};

/// The greatest distance of a vertex inside an edge from the colours of the edge, and how many
/// vertices lie there.
class OpenSides {
public:
    explicit OpenSides(std::vector<Side> sides) : sides_{std::move(sides)} {
        for (const Side& s : sides_) {
            for (std::size_t i = 0; i < 2; ++i) ends_.emplace_back(s.x[i], s.value[i]);
        }
        Point low = ends_.empty() ? Point{} : ends_.front().first;
        Point high = low;
        for (const auto& [x, value] : ends_) {
            for (std::size_t d = 0; d < 3; ++d) {
                low[d] = std::min(low[d], x[d]);
                high[d] = std::max(high[d], x[d]);
            }
        }
        const Point extent = high - low;
        axis_ = static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) -
                                         extent.begin());
        std::sort(ends_.begin(), ends_.end(),
                  [&](const auto& a, const auto& b) { return a.first[axis_] < b.first[axis_]; });
    }
    const std::vector<Side>& sides() const { return sides_; }

    double greatest_jump(const Side& s) const {
        const Point along = s.x[1] - s.x[0];
        const auto [low, high] = std::minmax(s.x[0][axis_], s.x[1][axis_]);
        auto end = std::lower_bound(ends_.begin(), ends_.end(), low - near,
                                    [&](const auto& e, double at) { return e.first[axis_] < at; });
        double jump = 0;
        for (; end != ends_.end() && end->first[axis_] <= high + near; ++end) {
            const auto& [x, value] = *end;
            const double t = dot(x - s.x[0], along) / dot(along, along);
            if (t * norm(along) < near || (1 - t) * norm(along) < near) continue;
            if (norm(x - (s.x[0] + t * along)) > near) continue;
            jump = std::max(jump, std::abs(value - ((1 - t) * s.value[0] + t * s.value[1])));
        }
        return jump;
    }

private:
    std::vector<Side> sides_;
    std::vector<std::pair<Point, double>> ends_;  // sorted along the axis
    std::size_t axis_ = 0;
};

}  // namespace

JumpCount count_jumps(const ColouredTriangles& surface, const OnBoundary& on_boundary,
                      double tolerance) {
    const std::vector<std::size_t> number = number_positions(surface.vertices);
    std::map<std::array<std::size_t, 2>, std::vector<Side>> edges;
    for (const auto& t : surface.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            std::size_t a = t[i];
            std::size_t b = t[(i + 1) % 3];
            if (number[a] == number[b]) continue;
            if (number[a] > number[b]) std::swap(a, b);
            edges[{number[a], number[b]}].push_back({{surface.vertices[a], surface.vertices[b]},
                                                     {surface.values[a], surface.values[b]}});
        }
    }
    JumpCount count;
    const auto add = [&](double jump) {
        count.jumping_edges += jump > tolerance ? 1 : 0;
        count.greatest_jump = std::max(count.greatest_jump, jump);
    };
    std::vector<Side> open;
    for (const auto& [ends, sides] : edges) {
        double jump = 0;
        for (const Side& s : sides) {
            for (std::size_t i = 0; i < 2; ++i) {
                jump = std::max(jump, std::abs(s.value[i] - sides.front().value[i]));
            }
        }
        add(jump);
        const auto& [a, b] = sides.front().x;
        if (sides.size() == 1 &&
            !(on_boundary(a) && on_boundary(b) && on_boundary(0.5 * (a + b)))) {
            open.push_back(sides.front());
        }
    }
    count.open_edges = open.size();
    const OpenSides all(std::move(open));
    for (const Side& s : all.sides()) add(all.greatest_jump(s));
    return count;
}

std::size_t count_open_ends(const Segments& lines, const OnBoundary& on_boundary) {
    const std::vector<std::size_t> number = number_positions(lines.vertices);
    std::map<std::size_t, std::pair<std::size_t, Point>> ends;
    for (const auto& s : lines.segments) {
        if (number[s[0]] == number[s[1]]) continue;
        for (const std::size_t v : s) {
            auto& [uses, x] = ends[number[v]];
            ++uses;
            x = lines.vertices[v];
        }
    }
    return static_cast<std::size_t>(std::count_if(ends.begin(), ends.end(), [&](const auto& end) {
        return end.second.first == 1 && !on_boundary(end.second.second);
    }));
}
