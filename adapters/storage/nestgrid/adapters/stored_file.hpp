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

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nestgrid/adapters/grid_file.hpp>
#include <nestgrid/adapters/stored_hierarchy.hpp>
#include <nestgrid/adapters/values_file.hpp>

namespace nestgrid {

/// What a file says about itself.
struct HierarchyHeader {
    std::string family;  ///< Family::name
    int dimension = 0;
    int corners = 0;  ///< of an element at most: Family::max_corners
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

/// \param encoded `keep` leaves encoded values in NamedField::encoded, for a CompressedField
/// \throw IoError for a file that cannot be read, is damaged, of another version or family
template <class Family>
StoredHierarchy<Family> read_hierarchy(const std::filesystem::path& path,
                                       Encoded encoded = Encoded::decode);

template <class Family>
void write_hierarchy(const StoredGrid<Family>& grid, const std::filesystem::path& path,
                     const std::vector<NamedField>& fields, const StoredFileOptions& options) {
    detail::check_values(fields, grid.node_count(), options.times);
    detail::FileHeader header;
    header.version = detail::version_for(fields, options);
    detail::Writer body;
    detail::GridFile<Family>::write(grid, body);
    if (header.version == 1) {
        detail::write_plain(fields, body);
    } else {
        detail::write_frames(grid, fields, options, body);
    }
    header.dimension = static_cast<std::uint32_t>(Family::dimension);
    std::strncpy(header.family.data(), Family::name, header.family.size() - 1);
    header.corners = static_cast<std::uint32_t>(Family::max_corners);
    header.options = detail::options(grid.family());
    detail::write_file(path, header, body.bytes);
}

inline HierarchyHeader read_hierarchy_header(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const detail::FileHeader header = detail::read_file_header(file, path);
    return {detail::text(header.family), static_cast<int>(header.dimension),
            static_cast<int>(header.corners)};
}

template <class Family>
StoredHierarchy<Family> read_hierarchy(const std::filesystem::path& path, Encoded encoded) {
    std::ifstream file(path, std::ios::binary);
    const detail::FileHeader header = detail::read_file_header(file, path);
    if (detail::text(header.family) != Family::name ||
        header.dimension != static_cast<std::uint32_t>(Family::dimension) ||
        header.corners != static_cast<std::uint32_t>(Family::max_corners)) {
        throw IoError(detail::quoted(path) + " holds a " + detail::text(header.family) +
                      " hierarchy of dimension " + std::to_string(header.dimension) +
                      " with at most " + std::to_string(header.corners) + " corners");
    }
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (failed || size < sizeof(header) || size - sizeof(header) != header.body) {
        throw IoError(detail::quoted(path) + " is damaged: it should be " +
                      std::to_string(header.body + sizeof(header)) + " bytes long and is " +
                      std::to_string(size));
    }
    std::vector<char> bytes(static_cast<std::size_t>(header.body));
    if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
        throw IoError(detail::quoted(path) + " cannot be read");
    }
    boost::crc_32_type crc;
    crc.process_bytes(bytes.data(), bytes.size());
    if (crc.checksum() != header.body_checksum) {
        throw IoError(detail::quoted(path) + " is damaged: its checksum is wrong");
    }
    detail::Reader body(std::move(bytes), detail::quoted(path));
    StoredHierarchy<Family> stored{
        detail::GridFile<Family>::read(body, detail::from_options<Family>(header.options)), {}};
    if (header.version == 1) {
        detail::read_plain(body, stored);
    } else {
        detail::read_frames(body, encoded, stored);
    }
    if (!body.at_end()) body.fail("there is something after its end");
    return stored;
}

}  // namespace nestgrid
