// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/film.hpp"

#include <array>
#include <cstdio>
#include <string>

#include "output/surface_file.hpp"

namespace fs = std::filesystem;

Film::Film(const fs::path& path, const SurfaceEncoding& encoding)
    : path_{path}, encoding_{encoding} {
    check_writable(collection_path(path));
}

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
    write_surface(surface, path, encoding_);
    if (moved_.empty()) moved_ = what_single_precision_moves(surface, path);
    pictures_.push_back({path, time});
    contents_.push_back(contents_of(surface));
}

void Film::finish(Report& report) {
    write_collection(collection_path(path_), pictures_);
    finished_ = true;
    if (!moved_.empty()) report.say(moved_);
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
        report.wrote(pictures_[i].path, contents_[i]);
    }
    report.wrote(collection_path(path_), {{"files", pictures_.size()}});
}
