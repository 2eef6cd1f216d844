// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "film.hpp"

#include <array>
#include <cstdio>
#include <string>

#include "surface_file.hpp"

namespace fs = std::filesystem;

Film::Film(const fs::path& path) : path_{path} { check_writable(collection_path(path)); }

Film::~Film() {
    if (finished_) return;
    std::error_code ignored;
    for (const CollectionPart& picture : pictures_) fs::remove(picture.path, ignored);
}

void Film::add(vtkPolyData* surface, double time) {
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), "_%04zu", pictures_.size());
    const fs::path path =
        path_.parent_path() / (path_.stem().string() + digits.data() + path_.extension().string());
    write_surface(surface, path);
    pictures_.push_back({path, time});
}

void Film::finish() {
    write_collection(collection_path(path_), pictures_);
    finished_ = true;
}
