// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of one field: several files of one layout, or one file that holds them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/error.hpp>

#include "input/hierarchy.hpp"
#include "input/volume.hpp"

using Paths = std::vector<std::filesystem::path>;

/// The times of frames.
/// \param given in the option --times; may be empty
/// \param stored those that the frames have otherwise
/// \throw nestgrid::InvalidInput where there is not one given for each frame
std::vector<double> times_of_frames(const std::vector<double>& given, std::vector<double> stored);

/// 0, 1, 2, ...: the times of files.
std::vector<double> times_of_files(std::size_t files);

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

/// Appends the frames of other files of hierarchies to those of the first one.
/// \param first the hierarchy of paths[0]; its times become 0, 1, 2, ... where there are several
/// \param array the name of the field; where it is empty and there is one field only, that of other
///        files may have another name
/// \throw nestgrid::InvalidInput where a file has another grid or other fields, and where one of
///        several files has several frames
/// \throw nestgrid::IoError where a file cannot be read
template <class Family>
void append_frames(nestgrid::StoredHierarchy<Family>& first, const Paths& paths,
                   const std::string& array) {
    if (paths.size() == 1) return;
    const auto require_one_frame = [](const auto& stored, const std::filesystem::path& path) {
        if (stored.times.size() == 1) return;
        throw nestgrid::InvalidInput("'" + path.string() + "' has " +
                                     std::to_string(stored.times.size()) +
                                     " frames of its own: it is for one input");
    };
    require_one_frame(first, paths.front());
    for (const auto& path : std::span(paths).subspan(1)) {
        require_family<Family>(path);
        const auto other = nestgrid::read_hierarchy<Family>(path);
        require_one_frame(other, path);
        if (leaf_nodes(other.grid) != leaf_nodes(first.grid) ||
            other.grid.node_positions() != first.grid.node_positions()) {
            throw nestgrid::InvalidInput("'" + path.string() +
                                         "' has another grid than the first input");
        }
        const bool by_name = !array.empty() || first.fields.size() > 1;
        for (nestgrid::NamedField& field : first.fields) {
            const auto& values = field_named(other.fields, by_name ? field.name : array).values;
            field.values.insert(field.values.end(), values.begin(), values.end());
        }
    }
    first.times = times_of_files(paths.size());
}
