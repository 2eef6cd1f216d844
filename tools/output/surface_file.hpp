// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "formats.hpp"

/// Throws nestgrid::IoError where the name ends with none of the formats, in lower case or not, or
/// its folder cannot be written, so that this is known before any work is done.
void check_output(const std::filesystem::path& path, const std::vector<std::string>& formats);

/// The same for a file of any format.
void check_writable(const std::filesystem::path& path);

/// Writes in the format that the name tells. The file appears complete, by rename, or not at all.
/// \throw nestgrid::IoError
void write_surface(vtkPolyData* surface, const std::filesystem::path& path,
                   const SurfaceEncoding& encoding);

/// Adds what is known of a whole surface, as field data.
/// \param unit of lengths ("length_unit"); empty where it is unknown
/// \param space where the axes point to ("space"), like RAS; empty where it is unknown
/// \param values by their names: that of the field on an isosurface
void describe(vtkPolyData* surface, const std::string& unit, const std::string& space,
              const std::map<std::string, double>& values = {});

/// A sentence on how far points are moved by a format of single precision; nothing where that is
/// less than a thousandth of the mean edge.
std::string what_single_precision_moves(vtkPolyData* surface, const std::filesystem::path& path);

/// What a surface has: "triangles", "lines", and how many.
std::vector<std::pair<std::string, std::uint64_t>> contents_of(vtkPolyData* surface);

/// Has a file written under another name beside it, and then renames it: it appears complete or not
/// at all.
/// \param write writes the file of the name that it is given; returns why it could not, or nothing
/// \throw nestgrid::IoError; whatever write() throws
void write_by_rename(const std::filesystem::path& path,
                     const std::function<std::string(const std::filesystem::path&)>& write);
