// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <vtkPolyData.h>

#include "formats.hpp"
#include "output/collection.hpp"

/// Surfaces at several times, in files, and a .pvd file that lists them, as ParaView opens it.
/// Invariant: the .pvd file appears when all surfaces are there; unless it does, none of them
/// stays.
class Film {
public:
    /// \param path of the surfaces without their number: name.vtp for name_0000.vtp, ... and
    ///        name.pvd
    /// \throw nestgrid::IoError where the files cannot be written
    Film(const std::filesystem::path& path, const SurfaceEncoding& encoding);
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;
    ~Film();

    /// \throw nestgrid::IoError
    void add(vtkPolyData* surface, double time);
    /// Writes the list. To be called once, after the last surface.
    /// \param report takes the names of all files
    /// \throw nestgrid::IoError
    void finish(Report& report);

private:
    std::filesystem::path path_;
    SurfaceEncoding encoding_;
    std::vector<CollectionPart> pictures_;
    std::vector<std::vector<std::pair<std::string, std::uint64_t>>> contents_;
    std::string moved_;  // what the format does to points; mostly empty
    bool finished_ = false;
};
