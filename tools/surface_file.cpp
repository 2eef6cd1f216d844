// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include <vtkErrorCode.h>
#include <vtkGLTFWriter.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkSTLWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/error.hpp>

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

void check_written(vtkAlgorithm* writer) {
    if (writer->GetErrorCode() != 0) {
        throw IoError(std::string("writing failed: ") +
                      vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()));
    }
}

template <class Writer>
void write_with(vtkPolyData* surface, const fs::path& path) {
    const vtkNew<Writer> writer;
    writer->SetFileName(path.c_str());
    writer->SetInputData(surface);
    if constexpr (requires { writer->SetFileTypeToBinary(); }) writer->SetFileTypeToBinary();
    writer->Write();
    check_written(writer);
}

void write_as(const std::string& format, vtkPolyData* surface, const fs::path& path) {
    if (format == ".vtp") return write_with<vtkXMLPolyDataWriter>(surface, path);
    if (format == ".ply") return write_with<vtkPLYWriter>(surface, path);
    if (format == ".stl") return write_with<vtkSTLWriter>(surface, path);
    if (format == ".obj") return write_with<vtkOBJWriter>(surface, path);
    const vtkNew<vtkGLTFWriter> writer;
    writer->SetFileName(path.c_str());
    writer->InlineDataOn();
    writer->SetInputData(as_blocks(surface));
    writer->Write();
    check_written(writer);
}

}  // namespace

fs::path temporary_beside(const fs::path& path) {
    return path.parent_path() / ("." + path.stem().string() + "." + std::to_string(getpid()) +
                                 path.extension().string());
}

void check_output(const fs::path& path) {
    const std::string format = path.extension().string();
    if (format != ".vtp" && format != ".ply" && format != ".stl" && format != ".obj" &&
        format != ".gltf" && format != ".png") {
        throw IoError("'" + path.string() +
                      "' names no known format (.vtp, .ply, .stl, .obj, .gltf; .png for pictures)");
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

void write_surface(vtkPolyData* surface, const fs::path& path) {
    const fs::path temporary = temporary_beside(path);
    std::error_code error;
    try {
        write_as(path.extension().string(), surface, temporary);
    } catch (const IoError& failure) {
        fs::remove(temporary, error);
        throw IoError(path.string() + " could not be written: " + failure.what());
    }
    const bool complete = fs::exists(temporary, error) && fs::file_size(temporary, error) > 0;
    if (complete) fs::rename(temporary, path, error);
    if (!complete || error) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw IoError(path.string() + " could not be written" +
                      (error ? ": " + error.message() : std::string()));
    }
}
