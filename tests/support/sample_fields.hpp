// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sampled functions for tests, each with an isovalue that its surface crosses.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "bucky_ball.hpp"

namespace nestgrid_test {

using Samples = std::array<int, 3>;

struct SampledField {
    std::string name;
    std::vector<float> values;  // x fastest
    double isovalue;
    double range;
};

inline std::vector<float> sample(const Samples& n,
                                 const std::function<double(double, double, double)>& f) {
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
                   static_cast<std::size_t>(n[2]));
    for (int z = 0; z < n[2]; ++z) {
        for (int y = 0; y < n[1]; ++y) {
            for (int x = 0; x < n[0]; ++x) {
                values.push_back(static_cast<float>(
                    f(double(x) / (n[0] - 1), double(y) / (n[1] - 1), double(z) / (n[2] - 1))));
            }
        }
    }
    return values;
}

/// Distance from the centre of the unit cube, in which the samples lie.
inline double distance_to_centre(double x, double y, double z) {
    return std::hypot(x - 0.5, y - 0.5, z - 0.5);
}

/// Sphere, bucky ball (only for equal dimensions), gyroid, white noise, noise of few integers
/// around the isovalue, and a rounded sphere whose plateaus lie exactly at the isovalue.
inline std::vector<SampledField> sampled_fields(const Samples& n) {
    std::vector<SampledField> fields;
    fields.push_back({"sphere", sample(n, distance_to_centre), 0.37, 0.87});
    if (n[0] == n[1] && n[1] == n[2]) fields.push_back({"bucky ball", bucky_ball(n[0]), 0.275, 1});
    fields.push_back({"gyroid",
                      sample(n,
                             [](double x, double y, double z) {
                                 const double k = 6 * 3.14159265358979;
                                 const double a = k * x + 0.3;  // no symmetry of the lattice
                                 const double b = k * y + 0.7;
                                 const double c = k * z + 1.1;
                                 return std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) +
                                        std::sin(c) * std::cos(a);
                             }),
                      0.5, 3});
    std::mt19937 random(1998);
    const auto noise = [&](double, double, double) {
        return static_cast<double>(random()) / 4294967296.0;
    };
    fields.push_back({"noise", sample(n, noise), 0.1, 1});
    fields.push_back({"integer noise",
                      sample(n, [&](double, double, double) { return double(random() % 3); }), 1,
                      2});
    fields.push_back(
        {"plateaus",
         sample(n, [](double x, double y,
                      double z) { return std::floor(16 * distance_to_centre(x, y, z)); }),
         6, 14});
    return fields;
}

/// The thresholds of the paper's table, as fractions of the range.
inline constexpr std::array<double, 6> thresholds{0.02, 0.01, 0.005, 0.0025, 0.00125, 0};

/// The samples interpolated linearly along every direction; the point is in units of cells.
inline double evaluate_cells(const std::vector<float>& values, const Samples& n,
                             const std::array<double, 3>& at) {
    double result = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        double weight = 1;
        std::size_t index = 0;
        std::size_t stride = 1;
        for (std::size_t d = 0; d < 3; ++d) {
            const int cell = std::min(static_cast<int>(at[d]), n[d] - 2);
            const int side = static_cast<int>(corner >> d & 1U);
            weight *= side == 1 ? at[d] - cell : 1 - (at[d] - cell);
            index += stride * static_cast<std::size_t>(cell + side);
            stride *= static_cast<std::size_t>(n[d]);
        }
        result += weight * static_cast<double>(values[index]);
    }
    return result;
}

/// The piecewise linear function on the leaves of the bisection of a lattice, at a point in lattice
/// coordinates: the reference for everything that is said about "the data".
inline double evaluate_leaves(const std::vector<float>& values, const Samples& n,
                              const std::array<double, 3>& at) {
    std::array<int, 3> corner{};
    std::array<int, 3> step{};
    std::array<std::pair<double, int>, 3> fraction{};
    for (std::size_t d = 0; d < 3; ++d) {
        const int cell = std::min(static_cast<int>(at[d]), n[d] - 2);
        const double f = at[d] - cell;
        // Every cell's path starts at its corner with even coordinates.
        const bool down = cell % 2 == 1;
        corner[d] = down ? cell + 1 : cell;
        step[d] = down ? -1 : 1;
        fraction[d] = {down ? 1 - f : f, static_cast<int>(d)};
    }
    std::sort(fraction.rbegin(), fraction.rend());
    const auto value = [&] {
        const int sample = corner[0] + n[0] * (corner[1] + n[1] * corner[2]);
        return static_cast<double>(values[static_cast<std::size_t>(sample)]);
    };
    double result = (1 - fraction[0].first) * value();
    for (std::size_t k = 0; k < 3; ++k) {
        const auto d = static_cast<std::size_t>(fraction[k].second);
        corner[d] += step[d];
        const double next = k < 2 ? fraction[k + 1].first : 0;
        result += (fraction[k].first - next) * value();
    }
    return result;
}

}  // namespace nestgrid_test
