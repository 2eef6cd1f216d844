// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <distances/far_points.hpp>

#include <algorithm>

namespace nestgrid::engine {

namespace {

constexpr std::size_t most_of_a_task = 4096;  // triangles

}  // namespace

std::array<Triangle, 4> quarters(const Triangle& whole) {
    const auto& [a, b, c] = whole;
    const Point off_a = 0.5 * (b + c);
    const Point off_b = 0.5 * (c + a);
    const Point off_c = 0.5 * (a + b);
    return {{{off_a, off_b, off_c}, {a, off_c, off_b}, {off_c, b, off_a}, {off_b, off_a, c}}};
}

// From its middle no point of a triangle is farther than its farthest corner: what is nearer there
// by that much is near as a whole. So is a triangle all of whose corners are near to one triangle,
// the distance from which is convex. Others are looked at by quarters.
std::optional<Point> FarSearch::far_point(const Triangle& whole) {
    parts_.assign({whole});
    while (!parts_.empty()) {
        const Triangle t = parts_.back();
        parts_.pop_back();
        const Point middle = (1.0 / 3) * (t[0] + t[1] + t[2]);
        double reach = 0;
        for (const Point& x : t) reach = std::max(reach, norm(x - middle));
        if (reach <= distance_ && to_->is_within(middle, distance_ - reach, near_)) continue;
        if (reach < 1e-3 * distance_ || !is_near(middle)) return middle;
        if (to_->holds(near_, t, distance_)) continue;
        const auto parts = quarters(t);
        parts_.insert(parts_.end(), parts.begin(), parts.end());
    }
    return std::nullopt;
}

std::vector<Point> far_points(const Surface<3>& from, const ClosestPoints& to, double distance,
                              const Executor& executor) {
    const std::size_t count = from.simplices.size();
    std::vector<std::vector<Point>> of_tasks((count + most_of_a_task - 1) / most_of_a_task);
    std::vector<Point> all;
    executor.run(
        of_tasks.size(),
        [&](std::size_t task) {
            FarSearch search(to, distance);
            const std::size_t first = task * most_of_a_task;
            const std::size_t last = std::min(count, first + most_of_a_task);
            for (std::size_t t = first; t < last; ++t) {
                const auto& [a, b, c] = from.simplices[t];
                const auto far =
                    search.far_point({from.vertices[a], from.vertices[b], from.vertices[c]});
                if (far) of_tasks[task].push_back(*far);
            }
        },
        [&](std::size_t task) {
            all.insert(all.end(), of_tasks[task].begin(), of_tasks[task].end());
            of_tasks[task] = {};
        });
    return all;
}

}  // namespace nestgrid::engine
