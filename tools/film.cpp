// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "film.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <string>

#include <nestgrid/error.hpp>

#include "surface_file.hpp"

namespace {

namespace fs = std::filesystem;

fs::path list_of(fs::path path) { return path.replace_extension(".pvd"); }

/// A name as the value of an attribute.
std::string quoted(const std::string& name) {
    std::string result;
    for (const char c : name) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return "\"" + result + "\"";
}

std::string number(double x) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.17g", x);
    return text.data();
}

}  // namespace

Film::Film(const fs::path& path) : path_{path} { check_writable(list_of(path)); }

Film::~Film() {
    if (finished_) return;
    std::error_code ignored;
    for (const Picture& picture : pictures_) fs::remove(picture.path, ignored);
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
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "  <Collection>\n";
    for (const Picture& picture : pictures_) {
        text += "    <DataSet timestep=\"" + number(picture.time) +
                "\" part=\"0\" file=" + quoted(picture.path.filename().string()) + "/>\n";
    }
    text += "  </Collection>\n</VTKFile>\n";
    const fs::path list = list_of(path_);
    const fs::path temporary = temporary_beside(list);
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    file.close();
    std::error_code error;
    if (file) fs::rename(temporary, list, error);
    if (!file || error) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw nestgrid::IoError(list.string() + " could not be written");
    }
    finished_ = true;
}
