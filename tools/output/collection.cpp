// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/collection.hpp"

#include <array>
#include <cstdio>
#include <string>

#include "input/input_file.hpp"
#include "options/command_line.hpp"
#include "output/surface_file.hpp"
#include "output/text_file.hpp"

namespace {

namespace fs = std::filesystem;

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

fs::path collection_path(const fs::path& surfaces) {
    fs::path path = surfaces;
    return path.replace_extension(".pvd");
}

void write_collection(const fs::path& path, const std::vector<CollectionPart>& parts) {
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "  <Collection>\n";
    for (const CollectionPart& part : parts) {
        text += "    <DataSet timestep=\"" + number(part.time) + R"(" part="0" file=)" +
                quoted(part.path.filename().string()) + "/>\n";
    }
    text += "  </Collection>\n</VTKFile>\n";
    write_text(text, path);
}

void write_surfaces(const std::vector<vtkSmartPointer<vtkPolyData>>& surfaces, const fs::path& path,
                    Report& report) {
    std::vector<CollectionPart> parts;
    std::string moved;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        parts.push_back({numbered(path, i, surfaces.size()), static_cast<double>(i + 1)});
        write_surface(surfaces[i], parts.back().path);
        report.wrote(parts.back().path, contents_of(surfaces[i]));
        if (moved.empty()) moved = what_single_precision_moves(surfaces[i], path);
    }
    if (!moved.empty()) report.say(moved);
    if (parts.size() > 1 && ending_of(path) == ".vtp") {
        write_collection(collection_path(path), parts);
        report.wrote(collection_path(path), {{"files", parts.size()}});
    }
}
