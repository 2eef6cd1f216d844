// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes from files of all formats that hold some.
#pragma once

#include <filesystem>
#include <optional>

#include <nestgrid/adapters/coarse.hpp>

/// What the reader of a format is told beside the name of the file.
struct WantedMesh {
    std::optional<double> maximum_volume{};  ///< of the tetrahedra that fill a complex
};

struct MeshFromFile {
    nestgrid::CoarseGrid grid;
    std::size_t welded = 0;  ///< nodes that became others
};

/// Reads a mesh in a child process, because its reader is foreign code (child_process.hpp). To be
/// called before there are threads.
/// \param weld nodes that are no farther from each other than this become one; nothing: none do
/// \param seconds that the child may take; 0 for a time by the size of the file
/// \throw nestgrid::IoError for a file that is missing, truncated, damaged or holds no mesh
/// \throw nestgrid::InvalidInput for a mesh of other elements than are known
MeshFromFile read_mesh(const std::filesystem::path& path, const WantedMesh& wanted,
                       std::optional<double> weld, double seconds);
