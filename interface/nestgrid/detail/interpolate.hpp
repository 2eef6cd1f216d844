// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Interpolates at a new node: takes the weighted mean of the numbers at its parents, eq. (1).
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include <nestgrid/detail/mean.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid::detail {

/// The first components of the weighted mean of the parents of a stencil; component c of node n is
/// at value[n * stride + c].
template <std::size_t count, class Real>
std::array<Real, count> interpolate(const Stencil& s, const Real* value, std::size_t stride) {
    std::array<Real, count> result;
    const auto set = [&](auto&& mean) {
        for (std::size_t c = 0; c < count; ++c) {
            result[c] = mean([&](std::size_t i) { return value[s.parent[i] * stride + c]; });
        }
    };
    if (s.mean == Mean::midpoint) {
        set([](const auto& at) { return midpoint(at(0), at(1)); });
    } else if (s.mean == Mean::face) {
        set([](const auto& at) { return face_mean(at(0), at(1), at(2), at(3)); });
    } else if (s.mean == Mean::cell) {
        set([](const auto& at) {
            return cell_mean(std::array{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)});
        });
    } else {
        set([&](const auto& at) {
            std::array<Real, max_corners> product;
            Real lo = at(0);
            Real hi = at(0);
            for (std::size_t i = 0; i < s.count; ++i) {
                product[i] = static_cast<Real>(s.weight[i] * at(i));
                lo = std::min(lo, at(i));
                hi = std::max(hi, at(i));
            }
            return ordered_sum(std::span<Real>(product.data(), s.count), lo, hi);
        });
    }
    return result;
}
template <class Real>
Real interpolate(const Stencil& s, const Real* value, std::size_t stride) {
    return interpolate<1>(s, value, stride)[0];
}
inline Point interpolate(const Stencil& s, const Point* position) {
    return interpolate<3>(s, position->data(), 3);
}

}  // namespace nestgrid::detail
