// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkGLTFWriter.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkSTLWriter.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/error.hpp>

#include "input_file.hpp"
#include "suggestion.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::IoError;

/// glTF takes a tree of blocks.
vtkSmartPointer<vtkMultiBlockDataSet> as_blocks(vtkPolyData* surface) {
    const vtkNew<vtkMultiBlockDataSet> building;
    building->SetBlock(0, surface);
    auto scene = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    scene->SetBlock(0, building);
    return scene;
}

/// Runs a writer.
/// \return why it failed, or nothing
template <class Writer>
std::string written_by(Writer* writer, const fs::path& path) {
    writer->SetFileName(path.c_str());
    writer->Write();
    const auto code = writer->GetErrorCode();
    return code == 0 ? "" : vtkErrorCode::GetStringFromErrorCode(code);
}

template <class Writer>
std::string write_with(vtkPolyData* surface, const fs::path& path) {
    const vtkNew<Writer> writer;
    writer->SetInputData(surface);
    if constexpr (requires { writer->SetFileTypeToBinary(); }) writer->SetFileTypeToBinary();
    return written_by(writer.Get(), path);
}

std::string write_as(const std::string& format, vtkPolyData* surface, const fs::path& path) {
    if (format == ".vtp") return write_with<vtkXMLPolyDataWriter>(surface, path);
    if (format == ".ply") return write_with<vtkPLYWriter>(surface, path);
    if (format == ".stl") return write_with<vtkSTLWriter>(surface, path);
    if (format == ".obj") return write_with<vtkOBJWriter>(surface, path);
    const vtkNew<vtkGLTFWriter> writer;
    writer->InlineDataOn();
    writer->SetInputData(as_blocks(surface));
    return written_by(writer.Get(), path);
}

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

void write_surface(vtkPolyData* surface, const fs::path& path) {
    write_by_rename(path, [&](const fs::path& temporary) {
        return write_as(ending_of(path), surface, temporary);
    });
}
