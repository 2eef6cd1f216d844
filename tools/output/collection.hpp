// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "formats.hpp"
#include "output/report.hpp"

/// One of several surfaces in files beside each other.
struct CollectionPart {
    std::filesystem::path path;
    double time;  ///< where ParaView's slider shows it
};

/// The name of the list of surfaces that are called like a path: name.pvd.
std::filesystem::path collection_path(const std::filesystem::path& surfaces);

/// Writes a .pvd file, which ParaView opens as one data set with a slider. It appears by rename.
/// \throw nestgrid::IoError
void write_collection(const std::filesystem::path& path, const std::vector<CollectionPart>& parts);

/// Writes one surface into a file; several into files with numbers (numbered()), and a list of them
/// where they are .vtp. The report names all of them. One may go to standard output, which the
/// report then leaves alone.
/// \param ending of the format, with its dot
/// \throw nestgrid::IoError
void write_surfaces(const std::vector<vtkSmartPointer<vtkPolyData>>& surfaces,
                    const std::filesystem::path& path, const std::string& ending,
                    const SurfaceEncoding& encoding, Report& report);
