// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Stored hierarchies in files: one format for all families, little-endian, versioned and
// checksummed. docs/hierarchies.md describes it byte by byte.
//
// Reading trusts nothing: sizes are compared with that of the file before anything is allocated,
// the checksum before anything is used, and then every record is walked: codes, sets of entities,
// places and references must be just what writing would have produced.
#pragma once

#include <bit>
#include <filesystem>
#include <string>
#include <vector>

#include <nestgrid/adapters/stored_grid.hpp>

namespace nestgrid {

/// Values at the nodes, by node number.
struct NamedField {
    std::string name;
    std::vector<double> values;
};

/// What a file says about itself.
struct HierarchyHeader {
    std::string family;  ///< Family::name
    int dimension = 0;
    int corners = 0;  ///< of an element at most: Family::max_corners
};

template <class Family>
struct StoredHierarchy {
    StoredGrid<Family> grid;
    std::vector<NamedField> fields;
};

/// Writes a grid and fields on it. The file appears when it is complete.
/// \throw InvalidInput for a field of the wrong length; IoError where writing fails
template <class Family>
void write_hierarchy(const StoredGrid<Family>& grid, const std::filesystem::path& path,
                     const std::vector<NamedField>& fields = {});

/// \throw IoError for a file that cannot be read or is no hierarchy
HierarchyHeader read_hierarchy_header(const std::filesystem::path& path);

/// \throw IoError for a file that cannot be read, is damaged, of another version or family
template <class Family>
StoredHierarchy<Family> read_hierarchy(const std::filesystem::path& path);

}  // namespace nestgrid

#include <nestgrid/adapters/stored_file_steps.hpp>
