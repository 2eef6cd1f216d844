// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The isovalue to begin with, where nobody gives one: the surface of the thing in the data.
//
// Data mostly have a *background*: a constant, or noise around one value, at one end of their
// histogram. Then the isovalue lies halfway between the background and the median of the rest, as
// far as few samples are there. In order:
//   - labels (whole numbers that are equal in most neighbours): between the background and the next
//     label, so that every label is inside;
//   - a constant background, behind which noise may follow; a padding value far from smooth data is
//     left out before anything else;
//   - noise at an end of the histogram, up to the valley behind it;
//   - smooth data of both signs: 0;
//   - else the value that parts the data in two with little variation in each (Otsu 1979).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nestgrid/error.hpp>

/// Values spread over the data, and the one that follows each of them in memory.
struct ValueSample {
    static constexpr std::size_t most = std::size_t{1} << 17;

    std::vector<double> values{};
    std::vector<double> next{};
    double least = 0;  ///< of all data
    double greatest = 0;
};

/// \param at at(i) is value i; those that are not a number (NaN) do not count
/// \throw nestgrid::InvalidInput where a value is infinite
template <class At>
ValueSample value_sample_of(std::size_t count, const At& at) {
    ValueSample sample;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double least = infinity;
    double greatest = -infinity;
    for (std::size_t i = 0; i < count; ++i) {
        const auto value = static_cast<double>(at(i));
        if (std::isinf(value)) {
            throw nestgrid::InvalidInput("a value of the field is infinite");
        }
        // Comparisons with what is not a number are false.
        least = value < least ? value : least;
        greatest = value > greatest ? value : greatest;
    }
    if (!(least <= greatest)) return sample;
    sample.least = least;
    sample.greatest = greatest;
    // Multiples of the golden ratio are spread evenly, and do not follow the rows of a lattice.
    constexpr double golden = 0.6180339887498949;
    const std::size_t taken = std::min(count, ValueSample::most);
    for (std::size_t k = 0; k < taken; ++k) {
        const double part = std::fmod(static_cast<double>(k) * golden, 1.0);
        const std::size_t i =
            taken == count ? k : static_cast<std::size_t>(part * static_cast<double>(count));
        const auto value = static_cast<double>(at(std::min(i, count - 1)));
        const auto next = static_cast<double>(at(std::min(i + 1, count - 1)));
        if (std::isnan(value)) continue;
        sample.values.push_back(value);
        sample.next.push_back(std::isnan(next) ? value : next);
    }
    return sample;
}

/// The range of nearly all values, where a few lie so far off that a slider between them is of no
/// use; else nothing.
std::optional<std::array<double, 2>> usual_range(const ValueSample& sample);

/// \return a value between the least and the greatest one, and different from both unless the data
///         are constant
double first_isovalue(const ValueSample& sample);

/// The same with as few digits as serve.
double readable_isovalue(const ValueSample& sample);
