// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <nestgrid/shape.hpp>

/// The vertices of a truncated icosahedron with edge length 2: 60 of them, on a sphere of radius
/// 4.956: the even permutations of (0, 1, 3 p), (1, 2 + p, 2 p) and (p, 2, 2 p + 1) with all signs,
/// p the golden ratio.
inline std::vector<nestgrid::Point> truncated_icosahedron() {
    const double p = (1 + std::sqrt(5.0)) / 2;
    std::vector<nestgrid::Point> vertices;
    for (const nestgrid::Point& v :
         {nestgrid::Point{0, 1, 3 * p}, {1, 2 + p, 2 * p}, {p, 2, 2 * p + 1}}) {
        for (unsigned signs = 0; signs < 8; ++signs) {
            if ((signs & 1U) != 0 && v[0] == 0) continue;
            for (std::size_t turn = 0; turn < 3; ++turn) {
                nestgrid::Point w{};
                for (std::size_t d = 0; d < 3; ++d) {
                    w[(d + turn) % 3] = (signs >> d & 1U) != 0 ? -v[d] : v[d];
                }
                vertices.push_back(w);
            }
        }
    }
    return vertices;
}

/// A synthetic bucky ball on n x n x n samples, x fastest: Gaussians with sigma 0.7 at those
/// vertices in a cube of half-width 6.6, normalised to 0 ... 1.
inline std::vector<float> bucky_ball(int n) {
    const double half_width = 6.6;
    const double sigma = 0.7;
    const auto count = static_cast<std::size_t>(n);
    const std::vector<nestgrid::Point> centres = truncated_icosahedron();
    // A Gaussian is a product, so each direction needs one exponential per centre and coordinate.
    std::vector<double> factor(3 * centres.size() * count);
    const auto at = [&](std::size_t d, std::size_t c, std::size_t i) -> double& {
        return factor[(d * centres.size() + c) * count + i];
    };
    for (std::size_t d = 0; d < 3; ++d) {
        for (std::size_t c = 0; c < centres.size(); ++c) {
            for (std::size_t i = 0; i < count; ++i) {
                const double x = -half_width + 2 * half_width * double(i) / (n - 1) - centres[c][d];
                at(d, c, i) = std::exp(-x * x / (2 * sigma * sigma));
            }
        }
    }
    std::vector<double> sum(count * count * count, 0.0);
    for (std::size_t c = 0; c < centres.size(); ++c) {
        for (std::size_t z = 0, node = 0; z < count; ++z) {
            for (std::size_t y = 0; y < count; ++y) {
                const double yz = at(1, c, y) * at(2, c, z);
                for (std::size_t x = 0; x < count; ++x, ++node) sum[node] += at(0, c, x) * yz;
            }
        }
    }
    const auto [least, greatest] = std::minmax_element(sum.begin(), sum.end());
    const double lo = *least;
    const double range = *greatest - lo;
    std::vector<float> samples;
    samples.reserve(sum.size());
    for (const double s : sum) samples.push_back(static_cast<float>((s - lo) / range));
    return samples;
}
