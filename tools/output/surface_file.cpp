// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/surface_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkStringArray.h>

#include <nestgrid/error.hpp>

#include "input/input_file.hpp"
#include "joined.hpp"
#include "output/precision.hpp"
#include "suggestion.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::IoError;

/// A name in the same folder and of the same format that nobody uses.
fs::path temporary_beside(const fs::path& path) {
    // VTK's writers append an ending in capital letters once more.
    return path.parent_path() /
           ("." + path.stem().string() + "." + std::to_string(getpid()) + ending_of(path));
}

}  // namespace

void describe(vtkPolyData* surface, const std::string& unit, const std::string& space,
              const std::map<std::string, double>& values) {
    for (const auto& [name, value] : values) {
        const vtkNew<vtkDoubleArray> array;
        array->SetName(name.c_str());
        array->InsertNextValue(value);
        surface->GetFieldData()->AddArray(array);
    }
    for (const auto& [name, text] : {std::pair{"length_unit", unit}, std::pair{"space", space}}) {
        if (text.empty()) continue;
        const vtkNew<vtkStringArray> array;
        array->SetName(name);
        array->InsertNextValue(text);
        surface->GetFieldData()->AddArray(array);
    }
}

std::string what_single_precision_moves(vtkPolyData* surface, const fs::path& path) {
    const Format* const format = format_of(path);
    if (format == nullptr || !format->single_precision) return "";
    if (single_keeps_shape(surface)) return "";
    const SinglePrecision single = single_precision(surface);
    std::vector<std::string> others;
    for (const Format& other : formats()) {
        const bool keeps = other.write_surface != nullptr && !other.single_precision;
        if (keeps) others.push_back(other.endings.front());
    }
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "%s has points of seven digits: they move by up to %.3g, where the mean edge "
                  "is %.3g long; ",
                  format->endings.front().c_str(), single.moved, single.mean_edge);
    return text.data() + joined(others, "and") + " keep them";
}

std::vector<std::pair<std::string, std::uint64_t>> contents_of(vtkPolyData* surface) {
    std::vector<std::pair<std::string, std::uint64_t>> contents;
    const auto polygons = static_cast<std::uint64_t>(surface->GetNumberOfPolys());
    const auto lines = static_cast<std::uint64_t>(surface->GetNumberOfLines());
    if (polygons > 0 || lines == 0) contents.emplace_back("triangles", polygons);
    if (lines > 0) contents.emplace_back("lines", lines);
    return contents;
}

void check_output(const fs::path& path, const std::vector<std::string>& formats) {
    const std::string format = ending_of(path);
    if (std::ranges::find(formats, format) == formats.end()) {
        std::string known;
        for (const std::string& each : formats) known += (known.empty() ? "" : ", ") + each;
        throw IoError("'" + path.string() + "' names no known format, which is " + known +
                      did_you_mean(format, formats));
    }
    check_writable(path);
}

void check_writable(const fs::path& path) {
    if (fs::is_directory(path)) throw IoError(path.string() + " cannot be written: it is a folder");
    const fs::path trial = temporary_beside(path);
    const bool writable = static_cast<bool>(std::ofstream(trial));
    const int reason = errno;
    std::error_code ignored;
    fs::remove(trial, ignored);
    if (!writable) throw IoError(path.string() + " cannot be written: " + std::strerror(reason));
}

void write_by_rename(const fs::path& path,
                     const std::function<std::string(const fs::path&)>& write) {
    const fs::path temporary = temporary_beside(path);
    std::error_code error;
    std::string reason;
    try {
        reason = write(temporary);
    } catch (...) {
        fs::remove(temporary, error);
        throw;
    }
    if (reason.empty() && fs::file_size(temporary, error) == 0) reason = "nothing was written";
    if (reason.empty() && !error) fs::rename(temporary, path, error);
    if (reason.empty() && !error) return;
    if (reason.empty()) reason = error.message();
    fs::remove(temporary, error);
    throw IoError(path.string() + " could not be written: " + reason);
}

void write_surface(vtkPolyData* surface, const fs::path& path, const SurfaceEncoding& encoding) {
    const Format* const format = format_of(path);
    if (format == nullptr || format->write_surface == nullptr) {
        throw IoError("'" + path.string() + "' is of no format for surfaces");
    }
    write_by_rename(path, [&](const fs::path& temporary) {
        return format->write_surface(surface, temporary, encoding);
    });
}
