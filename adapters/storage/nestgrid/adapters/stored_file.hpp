// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Stored hierarchies in files: one format for all families, little-endian, versioned and
// checksummed. docs/hierarchies.md describes it byte by byte.
//
// A file holds one grid, fields on it, and frames of these at several times. Values are kept as
// they are, or as CompressedValues (compressed_field.hpp), bit for bit or within half a step.
//
// Reading trusts nothing: sizes are compared with that of the file before anything is allocated,
// the checksum before anything is used, and then every record is walked: codes, sets of entities,
// places and references must be just what writing would have produced.
#pragma once

#include <bit>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nestgrid/adapters/stored_grid.hpp>
#include <nestgrid/algorithms/compressed_field.hpp>

namespace nestgrid {

/// Values at the nodes, by node number; those of several frames one after the other.
struct NamedField {
    std::string name;
    std::vector<double> values;  ///< one for each node of each frame; none where encoded
    /// One for each frame, where values are encoded.
    std::vector<CompressedValues<double>> encoded{};
};

/// What a file says about itself.
struct HierarchyHeader {
    std::string family;  ///< Family::name
    int dimension = 0;
    int corners = 0;  ///< of an element at most: Family::max_corners
};

/// What a .nestgrid file held.
template <class Family>
struct StoredHierarchy {
    StoredGrid<Family> grid;
    std::vector<NamedField> fields;
    std::vector<double> times{0};  ///< of the frames, finite and ascending

    /// The values of a frame of a field that is not encoded.
    std::span<const double> frame(const NamedField& field, std::size_t i) const {
        return std::span(field.values).subspan(i * grid.node_count(), grid.node_count());
    }
};

/// What a .nestgrid file holds beside the grid.
struct StoredFileOptions {
    std::vector<double> times{0};  ///< of the frames, finite and ascending
    /// How values are encoded; nothing: as they are. Nodes that hang lose their values, and have
    /// the mean of their parents when they are decoded.
    std::optional<CompressionOptions> compression{};
};

/// Writes a grid and fields on it. The file appears when it is complete. One frame of values as
/// they are has the format's version 1, all else version 2.
/// \throw InvalidInput for a field that has not one value for each node of each frame, for times
///        that do not ascend, and as CompressedValues; IoError where writing fails
template <class Family>
void write_hierarchy(const StoredGrid<Family>& grid, const std::filesystem::path& path,
                     const std::vector<NamedField>& fields = {},
                     const StoredFileOptions& options = {});

/// \throw IoError for a file that cannot be read or is no hierarchy
HierarchyHeader read_hierarchy_header(const std::filesystem::path& path);

/// What reading makes of encoded values.
enum class Encoded { decode, keep };

/// \param encoded `keep` leaves encoded values in NamedField::encoded, for a CompressedField
/// \throw IoError for a file that cannot be read, is damaged, of another version or family
template <class Family>
StoredHierarchy<Family> read_hierarchy(const std::filesystem::path& path,
                                       Encoded encoded = Encoded::decode);

/// The values at the nodes of a grid by node number; 0 at numbers that are not in use.
/// \param encoded as many values as the grid has nodes
template <class Family>
std::vector<double> decode(const StoredGrid<Family>& grid, const CompressedValues<double>& encoded);

}  // namespace nestgrid

#include <nestgrid/adapters/stored_file_steps.hpp>
