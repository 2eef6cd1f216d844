// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "options/encoding_options.hpp"

struct MeshRequest {
    std::filesystem::path input;    ///< of a format for meshes
    std::optional<double> weld{};   ///< makes nodes one that are no farther from each other
    std::string family;             ///< red-green, bisection, octree, prism
    std::vector<double> layers;     ///< thicknesses of layers to extrude a surface in, for prisms
    std::vector<double> direction;  ///< to extrude along, x, y, z; empty: along the normals
    bool unbalanced = false;
    std::optional<double> maximum_volume{};  ///< of the tetrahedra that fill a .poly or .smesh
    int refine = 0;                          ///< uniform refinements
    std::vector<std::string> fields;         ///< names or expressions; may be empty
    std::vector<double> times;          ///< of frames of the fields; empty: there is one without t
    EncodingOptions encoding{};         ///< of the fields in the file
    std::optional<double> tolerance{};  ///< refine until the first field is interpolated to this
    std::optional<int> levels{};        ///< refinements for that at most; 30 unless given
    std::size_t maximum_elements = 20000000;  ///< leaves, before the closure
    double read_limit = 0;  ///< seconds to read the input and to fill a complex; 0: by its size
    std::filesystem::path output;
    std::function<void(const std::string&)> progress{};
};

/// Builds a hierarchy, refines it and writes it. To be called before there are threads.
/// \return how many nodes of the mesh became others
/// \throw nestgrid::IoError, nestgrid::InvalidInput with one sentence about what is wrong
std::size_t make_hierarchy(const MeshRequest& request);
