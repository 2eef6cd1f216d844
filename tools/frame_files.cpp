// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_files.hpp"

#include <numeric>

std::vector<double> times_of_frames(const std::vector<double>& given, std::size_t files) {
    if (given.empty()) {
        std::vector<double> numbers(files);
        std::iota(numbers.begin(), numbers.end(), 0.0);
        return numbers;
    }
    if (given.size() != files) {
        throw nestgrid::InvalidInput("--times has " + std::to_string(given.size()) +
                                     " numbers, but there are " + std::to_string(files) +
                                     " inputs");
    }
    return given;
}

void require_one_layout(const std::vector<Volume>& volumes, const Paths& paths) {
    const auto& first = volumes.front().geometry;
    for (std::size_t i = 1; i < volumes.size(); ++i) {
        const auto& other = volumes[i].geometry;
        const char* what = nullptr;
        if (other.samples != first.samples) {
            what = "other dimensions";
        } else if (volumes[i].type != volumes.front().type) {
            what = "samples of another type";
        } else if (other.spacing != first.spacing || other.origin != first.origin ||
                   other.direction != first.direction) {
            what = "another place in space";
        }
        if (what != nullptr) {
            throw nestgrid::InvalidInput("'" + paths[i].string() + "' has " + what + " than '" +
                                         paths.front().string() + "'");
        }
    }
}
