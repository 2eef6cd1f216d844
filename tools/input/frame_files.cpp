// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/frame_files.hpp"

#include <numeric>

namespace {

/// \throw nestgrid::InvalidInput that says in what the file differs from the first one
void refuse(const std::filesystem::path& path, const char* what, const Paths& paths) {
    throw nestgrid::InvalidInput("'" + path.string() + "' has " + what + " than '" +
                                 paths.front().string() + "'");
}

}  // namespace

std::vector<double> times_of_files(std::size_t files) {
    std::vector<double> numbers(files);
    std::iota(numbers.begin(), numbers.end(), 0.0);
    return numbers;
}

std::vector<double> times_of_frames(const std::vector<double>& given, std::vector<double> stored) {
    if (given.empty()) return stored;
    if (given.size() != stored.size()) {
        throw nestgrid::InvalidInput("--times has " + std::to_string(given.size()) +
                                     " numbers, but there are " + std::to_string(stored.size()) +
                                     " frames");
    }
    return given;
}

void require_one_layout(const std::vector<Volume>& volumes, const Paths& paths) {
    const auto& first = volumes.front().geometry;
    for (std::size_t i = 1; i < volumes.size(); ++i) {
        const auto& other = volumes[i].geometry;
        if (other.samples != first.samples) refuse(paths[i], "other dimensions", paths);
        if (volumes[i].type != volumes.front().type) {
            refuse(paths[i], "samples of another type", paths);
        }
        if (other.spacing != first.spacing || other.origin != first.origin ||
            other.direction != first.direction) {
            refuse(paths[i], "another place in space", paths);
        }
    }
}
