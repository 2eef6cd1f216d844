// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the reader of a format gives: the numbers of a file as they lie in memory, and what they
// mean. Which of them make the volume is chosen afterwards, in one place for all formats.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <nestgrid/adapters/lattice.hpp>

struct SampleLayout;

/// An axis of an array that is none of space.
struct SampleAxis {
    std::size_t count = 1;
    std::size_t stride = 0;  ///< from one to the next, in numbers
};

/// A file in which numbers stand as they do in memory.
struct NumbersInFile {
    std::filesystem::path path;
    std::uintmax_t begin = 0;  ///< byte of the first one, a multiple of their size
};

struct FileSamples {
    std::filesystem::path path;
    std::byte* data = nullptr;       ///< the numbers; null where they are not read yet
    std::shared_ptr<void> memory{};  ///< keeps them
    /// Reads all numbers, of which there are numbers_in_file(), where they are not read yet.
    std::function<void(std::span<std::byte> block)> fill{};
    /// Where all numbers stand in a file without gaps, in the order of the strides.
    std::optional<NumbersInFile> in_file{};
    std::string type{};  ///< of the numbers, like uint8
    nestgrid::LatticeGeometry<3> geometry{};
    std::array<std::size_t, 3> stride{};  ///< along each axis of space, in numbers
    SampleAxis components{};              ///< of a sample
    std::string component_kind{};         ///< such as RGB-color; empty where the file does not say
    SampleAxis frames{};
    double first_time = 0;
    double time_step = 1;
    bool frames_are_list = false;  ///< which the file does not say to be times
    double slope = 1;              ///< a value is slope times number plus intercept
    double intercept = 0;
    std::string name{};         ///< of the data; empty where the file has none
    std::string length_unit{};  ///< like mm; empty where the file has none
    std::string space{};        ///< like RAS: where the axes point to; empty where it is not said
    std::string note{};         ///< a sentence on how the file is taken; mostly empty
};

/// \throw std::bad_alloc where they are more than memory could hold
std::size_t numbers_in_file(const FileSamples& samples);

/// Strides of numbers without gaps: components of a sample first, then x, y, z and frames.
void set_dense_strides(FileSamples& samples);

/// What a .raw file does not say about itself.
struct RawFormat {
    std::array<int, 3> dims{0, 0, 0};
    std::string type;
    bool big_endian = false;
    std::array<double, 3> spacing{1, 1, 1};
};

/// What the reader of a format is told beside the name of the file.
struct WantedSamples {
    std::string array;           ///< of a .vti file; empty for the active one
    bool several_frames = true;  ///< false: the first is enough, which may spare work
    RawFormat raw;               ///< of a .raw file
};

/// Bare samples, and others of which a layout tells where they are.
FileSamples read_layout(const SampleLayout& layout);

/// \throw nestgrid::IoError where a file of so many bytes cannot hold so many bytes of samples,
///        packed or not
void check_plausible(const std::filesystem::path& path, std::uintmax_t found, double asked_for);
