// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/near_parts.hpp>

#include <algorithm>

namespace nestgrid::engine {

namespace {

constexpr std::size_t most_of_a_task = 4096;  // triangles

}  // namespace

Triangle PartedSurface::corners(const NearPart& part) const {
    const auto& [a, b, c] = whole_->simplices[part.triangle];
    Triangle x{whole_->vertices[a], whole_->vertices[b], whole_->vertices[c]};
    unsigned bits = 0;
    while (part.path >> bits > 1) bits += 2;
    while (bits > 0) {
        bits -= 2;
        x = quarters(x)[part.path >> bits & 3U];
    }
    return x;
}

bool PartedSurface::has_quarters(const NearPart& part, const Triangle& x) const {
    const double length = std::max({norm(x[1] - x[0]), norm(x[2] - x[1]), norm(x[0] - x[2])});
    return length > least_ && part.path < std::uint32_t{1} << 30U;
}

std::size_t give_parts(const PartedSurface& whole, const Surface<3>& to,
                       std::vector<std::vector<NearPart>>& parts, const Executor& executor) {
    struct Given {
        std::vector<std::pair<std::uint32_t, NearPart>> parts;
        std::size_t missed = 0;
    };
    const ClosestPoints closest(to);
    parts.assign(to.simplices.size(), {});
    const std::size_t count = whole.size();
    std::vector<Given> of_tasks((count + most_of_a_task - 1) / most_of_a_task);
    std::size_t missed = 0;
    executor.run(
        of_tasks.size(),
        [&](std::size_t task) {
            Given& given = of_tasks[task];
            double bound = ClosestPoints::infinity;
            Point last{};
            const auto find = [&](const Triangle& x) -> Owner {
                const Point middle = middle_of(x);
                const auto nearest = closest.nearest(middle, bound + norm(middle - last));
                bound = nearest.distance;
                last = middle;
                if (!(bound < ClosestPoints::infinity)) return {};
                const auto& [a, b, c] = to.simplices[nearest.triangle];
                const Triangle owner{to.vertices[a], to.vertices[b], to.vertices[c]};
                if (whole.is_near(x, owner)) return {nearest.triangle};
                return {Owner::none, whole.is_near(middle, owner)};
            };
            const auto first = static_cast<std::uint32_t>(task * most_of_a_task);
            const std::size_t end = std::min(count, first + most_of_a_task);
            for (std::uint32_t t = first; t < end; ++t) {
                const bool all = whole.give({t}, find, [&](std::uint32_t owner, NearPart part) {
                    given.parts.emplace_back(owner, part);
                });
                if (!all) ++given.missed;
            }
        },
        [&](std::size_t task) {
            for (const auto& [owner, part] : of_tasks[task].parts) parts[owner].push_back(part);
            missed += of_tasks[task].missed;
            of_tasks[task] = {};
        });
    return missed;
}

}  // namespace nestgrid::engine
