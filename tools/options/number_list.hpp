// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <nestgrid/detail/geometry.hpp>

/// The finite numbers of a text with commas between them; none where it is anything else.
inline std::vector<double> numbers_of(const std::string& text) {
    std::vector<double> numbers;
    const char* at = text.c_str();
    while (true) {
        char* end = nullptr;
        numbers.push_back(std::strtod(at, &end));
        if (end == at || !std::isfinite(numbers.back())) return {};
        if (*end == '\0') return numbers;
        if (*end != ',') return {};
        at = end + 1;
    }
}

/// The point whose coordinates are three of these numbers.
inline nestgrid::Point point_at(const std::vector<double>& numbers, std::size_t first) {
    return {numbers[first], numbers[first + 1], numbers[first + 2]};
}
