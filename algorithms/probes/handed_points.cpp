// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/handed_points.hpp>

#include <algorithm>
#include <limits>

namespace nestgrid::engine {

void hand_to_deepest(const ChildMaps& maps, std::span<const PointInElement> group,
                     std::vector<PointInElement>& handed) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const PointInElement& point : group) {
        PointInElement deepest = point;
        double greatest = -infinity;
        for (std::size_t c = 0; c < maps.child.size() && greatest < 0; ++c) {
            Point s;
            if (!maps.child[c](point.at, s)) continue;
            const double distance = face_distance(maps.child[c].shape(), s);
            if (!(distance > greatest)) continue;
            greatest = distance;
            deepest = {s, point.point, static_cast<std::uint32_t>(c)};
        }
        if (greatest > -infinity) handed.push_back(deepest);
    }
}

NodeMask HandedPoints::sort(std::span<const PointInElement> handed, std::size_t children) {
    NodeMask some = 0;
    std::fill_n(first_.begin(), children + 1, 0U);
    for (const PointInElement& point : handed) {
        some |= NodeMask{1} << point.element;
        ++first_[point.element + 1U];
    }
    for (std::size_t c = 0; c < children; ++c) first_[c + 1] += first_[c];
    std::array<std::size_t, max_children> next;
    std::copy_n(first_.begin(), children, next.begin());
    if (points_.size() < handed.size()) points_.resize(handed.size());
    for (const PointInElement& point : handed) points_[next[point.element]++] = point;
    return some;
}

}  // namespace nestgrid::engine
