// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What octrees are measured against: a recursion written by hand for the cubes of n - 1 cells per
// direction (a power of two), float samples with stop and bound beside them. Faces whose signs
// alternate are always cut one way, which closes a surface only where none is adaptive.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <contours/contour_table.hpp>

#include "handwritten_bisection.hpp"

template <std::uint32_t n>
class HandwrittenOctree {
public:
    using Node = typename HandwrittenBisection<n>::Node;
    using Triangle = std::array<float, 9>;

    std::uint64_t split = 0;
    std::uint64_t stopped = 0;

    std::uint64_t calls() const { return 1 + 8 * split; }
    std::uint64_t visited() const { return split + stopped; }

    HandwrittenOctree(const Node* nodes, float isovalue, float threshold, Triangle* out)
        : nodes_{nodes},
          isovalue_{isovalue},
          threshold_{static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(threshold) >> 16U)},
          out_{out} {}

    Triangle* run() {
        inspect(0, n - 1);
        return out_;
    }

private:
    using Triangles = std::array<std::vector<std::array<std::uint8_t, 3>>, 256>;
    /// By sign pattern, as edges.
    static const Triangles& triangles() {
        static const Triangles all = [] {
            Triangles result;
            const auto& table = nestgrid::engine::ContourTable::of(nestgrid::Shape::hexahedron);
            for (unsigned pattern = 0; pattern < 256; ++pattern) {
                const nestgrid::engine::Contour& contour = table.at(pattern, 0);
                for (std::size_t l = 0; l < contour.loop_count; ++l) {
                    const nestgrid::engine::ContourLoop& loop = contour.loop[l];
                    for (std::uint8_t i = 2; i < loop.count; ++i) {
                        result[pattern].push_back({loop.edge[0], loop.edge[i - 1U], loop.edge[i]});
                    }
                }
            }
            return result;
        }();
        return all;
    }

    static constexpr std::array<std::uint32_t, 3> stride_{1, n, n* n};

    static constexpr std::uint32_t offset(std::size_t corner) {
        std::uint32_t sum = 0;
        for (std::size_t d = 0; d < 3; ++d) sum += (corner >> d & 1U) != 0 ? stride_[d] : 0;
        return sum;
    }
    /// New nodes in units of half the size: all of 3 x 3 x 3 but the corners.
    static constexpr std::array<std::uint32_t, 19> new_nodes_ = [] {
        std::array<std::uint32_t, 19> result{};
        std::size_t count = 0;
        for (std::uint32_t i = 0; i < 27; ++i) {
            const std::array<std::uint32_t, 3> at{i % 3, i / 3 % 3, i / 9};
            if (at[0] % 2 == 0 && at[1] % 2 == 0 && at[2] % 2 == 0) continue;
            result[count++] = at[0] * stride_[0] + at[1] * stride_[1] + at[2] * stride_[2];
        }
        return result;
    }();

    void inspect(std::uint32_t low, std::uint32_t size) {
        std::array<float, 8> u;
        for (std::size_t c = 0; c < 8; ++c) u[c] = nodes_[low + size * offset(c)].value;
        const float lo = *std::min_element(u.begin(), u.end());
        const float hi = *std::max_element(u.begin(), u.end());
        if (size == 1) {
            if (hi < isovalue_ || lo >= isovalue_) return;
            ++stopped;
            return draw(low, size, u);
        }
        const std::uint32_t half = size / 2;
        std::uint16_t bound = 0;
        std::uint16_t stop = 0;
        for (const std::uint32_t node : new_nodes_) {
            bound = std::max(bound, nodes_[low + half * node].bound);
            stop = std::max(stop, nodes_[low + half * node].stop);
        }
        const auto range = std::bit_cast<float>(std::uint32_t{bound} << 16U);
        if (hi + range < isovalue_ || lo - range > isovalue_) return;
        if (stop <= threshold_) {
            ++stopped;
            if (hi >= isovalue_ && lo < isovalue_) draw(low, size, u);
            return;
        }
        ++split;
        for (std::size_t c = 0; c < 8; ++c) inspect(low + half * offset(c), half);
    }

    void draw(std::uint32_t low, std::uint32_t size, const std::array<float, 8>& u) {
        unsigned pattern = 0;
        for (std::size_t c = 0; c < 8; ++c) pattern |= unsigned{u[c] >= isovalue_} << c;
        const std::array<std::uint32_t, 3> at{low % n, low / n % n, low / (n * n)};
        const auto& edges = nestgrid::topology(nestgrid::Shape::hexahedron).edge;
        std::array<std::array<float, 3>, 12> vertex;
        for (std::size_t e = 0; e < 12; ++e) {
            const auto [a, b] = edges[e];
            if ((pattern >> a & 1U) == (pattern >> b & 1U)) continue;
            const float fraction = (isovalue_ - u[a]) / (u[b] - u[a]);
            for (std::size_t d = 0; d < 3; ++d) {
                const auto from = static_cast<float>(at[d] + size * (a >> d & 1U));
                const auto to = static_cast<float>(at[d] + size * (b >> d & 1U));
                vertex[e][d] = from + fraction * (to - from);
            }
        }
        for (const auto& [a, b, c] : (*triangles_)[pattern]) {
            *out_++ = {vertex[a][0], vertex[a][1], vertex[a][2], vertex[b][0], vertex[b][1],
                       vertex[b][2], vertex[c][0], vertex[c][1], vertex[c][2]};
        }
    }

    const Node* nodes_;
    float isovalue_;
    std::uint16_t threshold_;
    Triangle* out_;
    const Triangles* triangles_ = &triangles();
};
