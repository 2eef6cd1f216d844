// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Volumes whose samples stand one after the other, x fastest, in a file or several: MetaImage, NRRD
// and bare samples. Their headers say where, and how they are packed. A sample may have several
// components, which stand together, and a volume several frames, one behind the other.
//
// Invariant: sizes are compared with the files that hold the samples before anything is allocated.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/adapters/lattice.hpp>

enum class Encoding { raw, deflated, text, hex };

struct SampleLayout {
    std::filesystem::path path;  ///< of the header
    std::string type{};          ///< of the samples, like uint8
    std::string name{};          ///< of the data; empty where the header has none
    std::string unit{};          ///< of length, like mm; empty where the header has none
    std::string space{};         ///< like LPS: where the axes point to; empty where it is not said
    nestgrid::LatticeGeometry<3> geometry{};
    std::size_t components = 1;
    std::size_t frames = 1;
    double time_step = 1;  ///< from a frame to the next
    double slope = 1;      ///< a value is slope times sample plus intercept
    double intercept = 0;
    std::vector<std::filesystem::path> files{};  ///< each holds as many samples as the others
    std::uintmax_t header_bytes = 0;             ///< before everything else in each file
    std::uintmax_t skipped_lines = 0;            ///< behind them
    std::intmax_t skipped_bytes = 0;             ///< behind the lines; -1: the samples end the file
    Encoding encoding = Encoding::raw;
    bool big_endian = false;
};

/// \throw nestgrid::IoError for a header of another format, or of a variant that is not read
SampleLayout meta_layout(const std::filesystem::path& path);
SampleLayout nrrd_layout(const std::filesystem::path& path);

/// The bytes of all samples in memory.
/// \throw nestgrid::IoError where the files are too short for them
/// \throw std::bad_alloc where no memory could hold them
std::size_t checked_size(const SampleLayout& layout);

/// The byte of the file at which all samples stand as they do in memory; nothing where they are
/// packed, written in another order of bytes, in several files, or not at a multiple of their size.
/// \throw nestgrid::IoError where the file cannot be opened
std::optional<std::uintmax_t> mappable_from(const SampleLayout& layout);

/// Reads all samples.
/// \param samples of checked_size() bytes, aligned for the type
/// \throw nestgrid::IoError for files that end too early or cannot be unpacked
void read_samples(const SampleLayout& layout, std::span<std::byte> samples);
