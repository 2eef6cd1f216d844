// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <distances/far_points.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace nestgrid::engine {

namespace {

constexpr std::size_t most_of_a_task = 4096;  // triangles

/// A point of a triangle that is farther than the distance, if there is one. From its middle no
/// point of a triangle is farther than its farthest corner: what is nearer there by that much is
/// near as a whole. Other triangles are looked at by quarters.
/// \param near as ClosestPoints::is_within() has it
/// \param stack emptied
std::optional<Point> far_point(const Triangle& whole, const ClosestPoints& to, double distance,
                               std::uint32_t& near, std::vector<Triangle>& stack) {
    stack.assign({whole});
    while (!stack.empty()) {
        const Triangle t = stack.back();
        stack.pop_back();
        const Point middle = (1.0 / 3) * (t[0] + t[1] + t[2]);
        double reach = 0;
        for (const Point& x : t) reach = std::max(reach, norm(x - middle));
        if (reach <= distance && to.is_within(middle, distance - reach, near)) continue;
        if (reach < 1e-3 * distance || !to.is_within(middle, distance, near)) return middle;
        const std::array<Point, 3> half{0.5 * (t[1] + t[2]), 0.5 * (t[2] + t[0]),
                                        0.5 * (t[0] + t[1])};
        stack.push_back({half[0], half[1], half[2]});
        stack.push_back({t[0], half[2], half[1]});
        stack.push_back({half[2], t[1], half[0]});
        stack.push_back({half[1], half[0], t[2]});
    }
    return std::nullopt;
}

}  // namespace

std::vector<Point> far_points(const Surface<3>& from, const ClosestPoints& to, double distance,
                              const Executor& executor) {
    const std::size_t count = from.simplices.size();
    std::vector<std::vector<Point>> of_tasks((count + most_of_a_task - 1) / most_of_a_task);
    std::vector<Point> all;
    executor.run(
        of_tasks.size(),
        [&](std::size_t task) {
            std::vector<Triangle> stack;
            std::uint32_t near = 0;
            const std::size_t first = task * most_of_a_task;
            const std::size_t last = std::min(count, first + most_of_a_task);
            for (std::size_t t = first; t < last; ++t) {
                const auto& [a, b, c] = from.simplices[t];
                const auto far = far_point({from.vertices[a], from.vertices[b], from.vertices[c]},
                                           to, distance, near, stack);
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
