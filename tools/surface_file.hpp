// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

/// Throws nestgrid::IoError where the format of the name is unknown or its folder cannot be
/// written, so that this is known before any work is done.
void check_output(const std::filesystem::path& path);

/// The same for a file of any format.
void check_writable(const std::filesystem::path& path);

/// Writes .vtp, .ply, .stl, .obj or .gltf. The file appears complete, by rename, or not at all.
/// \throw nestgrid::IoError
void write_surface(vtkPolyData* surface, const std::filesystem::path& path);

/// A name in the same folder and of the same format that nobody uses.
std::filesystem::path temporary_beside(const std::filesystem::path& path);
