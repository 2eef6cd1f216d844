// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/frame_weights.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

/// The place of a time among the frames: between frames `first` and first + 1, at this part of the
/// way from one to the other.
struct Place {
    std::size_t first;
    double part;
};

Place find_place(std::span<const double> times, double t) {
    if (times.empty()) throw InvalidInput("there are no frames to interpolate between");
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i] - times[0]) || (i > 0 && !(times[i - 1] < times[i]))) {
            throw InvalidInput("times of frames must be finite and ascend, but frame " +
                               std::to_string(i) + " has the time " + std::to_string(times[i]));
        }
    }
    if (!(times.front() <= t && t <= times.back())) {
        throw InvalidInput("the time " + std::to_string(t) + " does not lie between those of the " +
                           "first and the last frame, " + std::to_string(times.front()) + " and " +
                           std::to_string(times.back()));
    }
    if (times.size() == 1) return {0, 0};
    const auto after = std::upper_bound(times.begin(), times.end() - 1, t);
    const auto first = static_cast<std::size_t>(after - times.begin()) - 1;
    return {first, (t - times[first]) / (times[first + 1] - times[first])};
}

/// Rounds weights so that their sum is exactly 1.
std::vector<float> rounded(const std::vector<double>& exact) {
    constexpr double unit = 0x1p-23;
    std::vector<float> weights(exact.size());
    double rest = 1;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double multiple = std::round(exact[i] / unit) * unit;
        weights[i] = static_cast<float>(multiple);
        rest -= multiple;
    }
    const auto greatest = std::max_element(weights.begin(), weights.end());
    *greatest = static_cast<float>(static_cast<double>(*greatest) + rest);
    return weights;
}

}  // namespace

std::vector<float> linear_weights(std::span<const double> times, double t) {
    const Place place = find_place(times, t);
    std::vector<double> weights(times.size(), 0.0);
    weights[place.first] = 1 - place.part;
    if (times.size() > 1) weights[place.first + 1] = place.part;
    return rounded(weights);
}

std::vector<float> catmull_rom_weights(std::span<const double> times, double t) {
    const auto [first, s] = find_place(times, t);
    std::vector<double> weights(times.size(), 0.0);
    if (times.size() == 1) return {1.0F};
    const double interval = times[first + 1] - times[first];
    const auto add_slope = [&](std::size_t at, double factor) {
        const std::size_t before = at == 0 ? 0 : at - 1;
        const std::size_t after = std::min(at + 1, times.size() - 1);
        const double by = factor * interval / (times[after] - times[before]);
        weights[after] += by;
        weights[before] -= by;
    };
    // The cubic Hermite polynomials.
    weights[first] += (2 * s - 3) * s * s + 1;
    weights[first + 1] += (3 - 2 * s) * s * s;
    add_slope(first, ((s - 2) * s + 1) * s);
    add_slope(first + 1, (s - 1) * s * s);
    return rounded(weights);
}

namespace detail {

void require_weights(std::size_t frames, std::span<const float> weights) {
    if (weights.size() != frames) {
        throw InvalidInput(std::to_string(frames) + " frames need as many weights, not " +
                           std::to_string(weights.size()));
    }
    for (std::size_t i = 0; i < frames; ++i) {
        if (!std::isfinite(weights[i])) {
            throw InvalidInput("the weight of frame " + std::to_string(i) +
                               " is not a finite number");
        }
    }
}

}  // namespace detail

}  // namespace nestgrid
