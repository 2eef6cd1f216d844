// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/input_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <nestgrid/error.hpp>

#include "suggestion.hpp"
#include "text_header.hpp"

namespace {

namespace fs = std::filesystem;

/// A file with a similar name in the folder of one that is missing.
std::string meant_file(const fs::path& path) {
    constexpr std::size_t most = 10000;
    std::vector<std::string> names;
    std::error_code none;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    for (fs::directory_iterator at(folder, none), end; !none && at != end && names.size() < most;
         at.increment(none)) {
        names.push_back(at->path().filename().string());
    }
    return did_you_mean(path.filename().string(), names);
}

}  // namespace

void require_file(const fs::path& path) {
    const std::string name = "'" + path.string() + "'";
    std::error_code none;
    if (!fs::exists(path, none)) {
        throw nestgrid::IoError(name + " does not exist" + meant_file(path));
    }
    if (fs::is_directory(path, none)) {
        throw nestgrid::IoError(name + " is a folder, not a file");
    }
    if (!fs::is_regular_file(path, none)) throw nestgrid::IoError(name + " is no file");
    errno = 0;
    if (std::ifstream file(path); !file) {
        throw nestgrid::IoError(name + " cannot be opened: " + std::strerror(errno));
    }
    if (fs::file_size(path, none) == 0) throw nestgrid::IoError(name + " is empty");
}

std::string ending_of(const fs::path& path) { return lower(path.extension().string()); }
