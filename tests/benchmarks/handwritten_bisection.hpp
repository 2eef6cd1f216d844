// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What others are measured against: a recursion written by hand for one grid, the bisection of the
// Kuhn tetrahedra of one block of n - 1 cells per direction (a power of two), float samples with
// stop and bound beside them. Indices and values stay in registers; the tag is a template
// parameter.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

template <std::uint32_t n>
class HandwrittenBisection {
public:
    struct Node {
        float value;
        std::uint16_t stop;   // bfloat16
        std::uint16_t bound;  // bfloat16
    };
    using Triangle = std::array<float, 9>;

    std::uint64_t bisected = 0;
    std::uint64_t stopped = 0;

    std::uint64_t calls() const { return 6 + 2 * bisected; }
    std::uint64_t visited() const { return bisected + stopped; }

    HandwrittenBisection(const Node* nodes, float isovalue, float threshold, Triangle* out)
        : nodes_{nodes},
          isovalue_{isovalue},
          threshold_{static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(threshold) >> 16U)},
          out_{out} {}

    Triangle* run() {
        constexpr std::array<std::array<std::uint32_t, 3>, 6> paths{
            {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 0, 1}, {1, 2, 0}, {2, 1, 0}}};
        constexpr std::array<std::uint32_t, 3> step{n - 1, n * (n - 1), n * n * (n - 1)};
        constexpr std::array<bool, 6> mirrored{false, true, true, false, false, true};
        for (std::size_t i = 0; i < 6; ++i) {
            const std::uint32_t a = step[paths[i][0]];
            const std::uint32_t b = a + step[paths[i][1]];
            const std::uint32_t c = b + step[paths[i][2]];
            inspect<3>(0, a, b, c, at(0), at(a), at(b), at(c), 2 * depth_ + (mirrored[i] ? 1 : 0));
        }
        return out_;
    }

private:
    static constexpr int depth_ = 3 * (std::bit_width(n - 1) - 1);

    float at(std::uint32_t i) const { return nodes_[i].value; }

    /// \param left twice the bisections left, plus 1 in a mirror
    template <int tag>
    void inspect(std::uint32_t i0, std::uint32_t i1, std::uint32_t i2, std::uint32_t i3, float u0,
                 float u1, float u2, float u3, int left) {
        const float lo = std::min(std::min(u0, u1), std::min(u2, u3));
        const float hi = std::max(std::max(u0, u1), std::max(u2, u3));
        if (left < 2) {
            if (hi < isovalue_ || lo >= isovalue_) return;
            ++stopped;
            return draw(i0, i1, i2, i3, u0, u1, u2, u3, left);
        }
        const std::uint32_t m = (i0 + (tag == 1 ? i1 : tag == 2 ? i2 : i3)) / 2;
        const Node node = nodes_[m];
        const auto bound = std::bit_cast<float>(std::uint32_t{node.bound} << 16U);
        if (hi + bound < isovalue_ || lo - bound > isovalue_) return;
        if (node.stop <= threshold_) {
            ++stopped;
            if (hi >= isovalue_ && lo < isovalue_) draw(i0, i1, i2, i3, u0, u1, u2, u3, left);
            return;
        }
        ++bisected;
        const float u = node.value;
        if constexpr (tag == 3) {
            inspect<2>(i0, i1, i2, m, u0, u1, u2, u, left - 2);
            inspect<2>(i1, i2, i3, m, u1, u2, u3, u, (left - 2) ^ 1);
        } else if constexpr (tag == 2) {
            inspect<1>(i0, i1, m, i3, u0, u1, u, u3, left - 2);
            inspect<1>(i1, i2, m, i3, u1, u2, u, u3, left - 2);
        } else {
            inspect<3>(i0, m, i2, i3, u0, u, u2, u3, left - 2);
            inspect<3>(i1, m, i2, i3, u1, u, u2, u3, (left - 2) ^ 1);
        }
    }

    using Vertex = float __attribute__((vector_size(16)));  // x, y, z, and a number without meaning
    using Place = std::int32_t __attribute__((vector_size(16)));
    struct Corner {
        Vertex x;
        float u;
    };

    static Corner corner(std::uint32_t i, float u) {
        const std::uint32_t row = i / n;
        const std::uint32_t layer = i / (n * n);
        const Place place{static_cast<std::int32_t>(i - row * n),
                          static_cast<std::int32_t>(row - layer * n),
                          static_cast<std::int32_t>(layer), 0};
        return {__builtin_convertvector(place, Vertex), u};
    }
    Vertex cut(const Corner& a, const Corner& b) const {  // from a, outside
        const float f = (isovalue_ - a.u) / (b.u - a.u);
        return a.x + f * (b.x - a.x);
    }
    /// Each vertex is stored over the last number of the one before; behind the last triangle there
    /// must be room for one number.
    void put(const Vertex& a, const Vertex& b, const Vertex& c) {
        float* const to = out_++->data();
        std::memcpy(to, &a, 16);
        std::memcpy(to + 3, &b, 16);
        std::memcpy(to + 6, &c, 16);
    }

    void draw(std::uint32_t i0, std::uint32_t i1, std::uint32_t i2, std::uint32_t i3, float u0,
              float u1, float u2, float u3, int left) {
        const bool mirrored = left % 2 != 0;
        const std::array<Corner, 4> at{corner(i0, u0), corner(i1, u1), corner(i2, u2),
                                       corner(i3, u3)};
        const unsigned inside = unsigned{u0 >= isovalue_} | unsigned{u1 >= isovalue_} << 1U |
                                unsigned{u2 >= isovalue_} << 2U | unsigned{u3 >= isovalue_} << 3U;
        // An even permutation that puts the one of its kind first, or the two inside.
        static constexpr std::array<std::array<std::uint8_t, 4>, 16> order{{{0, 1, 2, 3},
                                                                            {0, 1, 2, 3},
                                                                            {1, 0, 3, 2},
                                                                            {0, 1, 2, 3},
                                                                            {2, 0, 1, 3},
                                                                            {0, 2, 3, 1},
                                                                            {1, 2, 0, 3},
                                                                            {3, 0, 2, 1},
                                                                            {3, 0, 2, 1},
                                                                            {0, 3, 1, 2},
                                                                            {1, 3, 2, 0},
                                                                            {2, 0, 1, 3},
                                                                            {2, 3, 0, 1},
                                                                            {1, 0, 3, 2},
                                                                            {0, 1, 2, 3},
                                                                            {0, 1, 2, 3}}};
        // In a mirror the last two change places.
        const auto& o = order[inside];
        const Corner& a = at[o[0]];
        const Corner& b = at[o[1]];
        const Corner& c = at[o[mirrored ? 3 : 2]];
        const Corner& d = at[o[mirrored ? 2 : 3]];
        static constexpr std::array<std::uint8_t, 16> count{0, 1, 1, 2, 1, 2, 2, 3,
                                                            1, 2, 2, 3, 2, 3, 3, 4};
        switch (count[inside]) {
            case 1:
                return put(cut(b, a), cut(c, a), cut(d, a));
            case 3:
                return put(cut(a, b), cut(a, d), cut(a, c));
            default: {
                const Vertex ac = cut(c, a);
                const Vertex ad = cut(d, a);
                const Vertex bc = cut(c, b);
                const Vertex bd = cut(d, b);
                put(ac, ad, bd);
                put(ac, bd, bc);
            }
        }
    }

    const Node* nodes_;
    float isovalue_;
    std::uint16_t threshold_;
    Triangle* out_;
};
