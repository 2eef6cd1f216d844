// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/collection.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>

#include <nestgrid/error.hpp>

#include "input/standard_input.hpp"
#include "options/command_line.hpp"
#include "output/surface_file.hpp"
#include "output/text_file.hpp"
#include "output/xml.hpp"
#include "temporary_file.hpp"

namespace {

namespace fs = std::filesystem;

std::string number(double x) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.17g", x);
    return text.data();
}

/// Writes a surface to standard output.
void write_stream(vtkPolyData* surface, const std::string& ending, const SurfaceEncoding& encoding,
                  Report& report) {
    const TemporaryFile file("standard output" + ending);
    write_surface(surface, file.path(), encoding);
    report.leave_standard_output();
    report.wrote(file.path().filename(), contents_of(surface), fs::file_size(file.path()));
    const std::string moved = what_single_precision_moves(surface, file.path());
    if (!moved.empty()) report.say(moved);
    std::ifstream in(file.path(), std::ios::binary);
    errno = 0;
    std::cout << in.rdbuf() << std::flush;
    if (!std::cout) {
        throw nestgrid::IoError(std::string("standard output could not be written: ") +
                                std::strerror(errno == 0 ? EIO : errno));
    }
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
                xml_value(part.path.filename().string()) + "/>\n";
    }
    text += "  </Collection>\n</VTKFile>\n";
    write_text(text, path);
}

void write_surfaces(const std::vector<vtkSmartPointer<vtkPolyData>>& surfaces, const fs::path& path,
                    const std::string& ending, const SurfaceEncoding& encoding, Report& report) {
    if (is_standard_stream(path)) return write_stream(surfaces.front(), ending, encoding, report);
    std::vector<CollectionPart> parts;
    std::string moved;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        parts.push_back({numbered(path, i, surfaces.size()), static_cast<double>(i + 1)});
        write_surface(surfaces[i], parts.back().path, encoding);
        report.wrote(parts.back().path, contents_of(surfaces[i]));
        if (moved.empty()) moved = what_single_precision_moves(surfaces[i], path);
    }
    if (!moved.empty()) report.say(moved);
    if (parts.size() > 1 && ending == ".vtp") {
        write_collection(collection_path(path), parts);
        report.wrote(collection_path(path), {{"files", parts.size()}});
    }
}
