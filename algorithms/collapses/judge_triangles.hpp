// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <distances/closest_points.hpp>
#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid::engine {

inline Triangle triangle_of(const Surface<3>& surface, std::size_t t) {
    const auto& [a, b, c] = surface.simplices[t];
    return {surface.vertices[a], surface.vertices[b], surface.vertices[c]};
}

/// Judges each of many triangles by itself, many at a time.
/// \param make make() is the judge of one task: judge(triangle, greatest) is whether a triangle
///        keeps what is asked for, and raises the greatest error of those that do
/// \param take take(triangle, whether it keeps it) is called in order
/// \return the greatest error
template <class Make, class Take>
double judge_triangles(std::size_t count, const Executor& executor, const Make& make,
                       const Take& take) {
    constexpr std::size_t chunk = 4096;
    const std::size_t tasks = (count + chunk - 1) / chunk;
    std::vector<std::uint8_t> keeps(count);
    std::vector<double> greatest(tasks, 0);
    executor.run(
        tasks,
        [&](std::size_t i) {
            auto judge = make();
            for (std::size_t t = i * chunk; t < std::min(count, (i + 1) * chunk); ++t) {
                keeps[t] = judge(t, greatest[i]) ? 1 : 0;
            }
        },
        [](std::size_t) {});
    for (std::size_t t = 0; t < count; ++t) take(t, keeps[t] != 0);
    double most = 0;
    for (const double part : greatest) most = std::max(most, part);
    return most;
}

}  // namespace nestgrid::engine
