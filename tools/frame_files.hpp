// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several files of one layout, frames of one field.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/error.hpp>

#include "hierarchy.hpp"
#include "volume.hpp"

using Paths = std::vector<std::filesystem::path>;

/// The times of the frames in some files: those given, or 0, 1, 2, ...
/// \param given in the option --times; may be empty
/// \throw nestgrid::InvalidInput where there is not one for each file
std::vector<double> times_of_frames(const std::vector<double>& given, std::size_t files);

/// \throw nestgrid::InvalidInput where two volumes have another type or geometry
void require_one_layout(const std::vector<Volume>& volumes, const Paths& paths);

/// The numbers of the corners of all leaves, one after the other.
template <class Grid>
std::vector<std::uint32_t> leaf_nodes(const Grid& grid) {
    std::vector<std::uint32_t> nodes;
    grid.for_each_leaf([&](const nestgrid::Leaf& leaf) {
        nodes.insert(nodes.end(), leaf.nodes.begin(), leaf.nodes.end());
    });
    return nodes;
}

/// \throw nestgrid::InvalidInput unless the path is that of a hierarchy of this family
template <class Family>
void require_family(const std::filesystem::path& path) {
    bool same = is_hierarchy(path);
    if (same) {
        const nestgrid::HierarchyHeader header = nestgrid::read_hierarchy_header(path);
        same = header.family == Family::name && header.dimension == Family::dimension &&
               header.corners == Family::max_corners;
    }
    if (!same) {
        throw nestgrid::InvalidInput("'" + path.string() +
                                     "' holds no hierarchy of the family of the first input");
    }
}

/// The values of a field in several files of hierarchies, of which the first one has been read.
/// \throw nestgrid::InvalidInput where a file has another grid, or not the field
/// \throw nestgrid::IoError where a file cannot be read
template <class Family>
std::vector<std::vector<double>> frame_values(const nestgrid::StoredHierarchy<Family>& first,
                                              const Paths& paths, const std::string& array) {
    std::vector<std::vector<double>> values{field_named(first.fields, array).values};
    for (const auto& path : std::span(paths).subspan(1)) {
        require_family<Family>(path);
        const auto other = nestgrid::read_hierarchy<Family>(path);
        if (leaf_nodes(other.grid) != leaf_nodes(first.grid) ||
            other.grid.node_positions() != first.grid.node_positions()) {
            throw nestgrid::InvalidInput("'" + path.string() +
                                         "' has another grid than the first input");
        }
        values.push_back(field_named(other.fields, array).values);
    }
    return values;
}
