// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The formats of files. Each stands in one source, which registers it when the program starts; the
// table that 'nestgrid formats' prints, help and refusals are made of what is registered.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <vtkPolyData.h>

class Report;
struct FileSamples;
struct Input;
struct InputField;
struct WantedSamples;
struct WantedMesh;
namespace nestgrid {
struct CoarseGrid;
}

/// How a surface is put into a file, where its format leaves a choice.
struct SurfaceEncoding {
    enum class Compression : std::uint8_t { lz4, zlib, none };
    Compression compression = Compression::lz4;
    bool doubles = false;  ///< points of double precision, also where single precision suffices
};

struct Format {
    using Path = std::filesystem::path;

    std::string name;                     ///< like NIfTI
    std::vector<std::string> endings;     ///< in lower case, with their dot; the usual one first
    std::string holds{};                  ///< what a file has in it, in a few words
    std::vector<std::string> detached{};  ///< endings of files that come with others
    std::vector<std::string> options{};   ///< of those that say how it is read, which apply to it

    bool single_precision = false;  ///< of points in files that are written
    bool keeps_elements = false;    ///< in files that are written: values of triangles
    bool compresses = false;        ///< files that are written, as a SurfaceEncoding says
    bool has_doubles = false;       ///< in files that are written, where they are wanted
    bool reads_beside = false;      ///< other files of the folder, too
    bool fills_complexes = false;   ///< which takes longer than reading
    /// Whether files keep hierarchies with their fields, which are read and written as such
    /// (input/hierarchy.hpp).
    bool keeps_hierarchies = false;

    /// Whether a file of another ending, or a folder, is of this format; null where the ending
    /// tells.
    bool (*recognises)(const Path& path) = nullptr;

    // What it can be used as; what it cannot is null. Readers are called in a child process, and
    // throw nestgrid::IoError or nestgrid::InvalidInput with a sentence that names the file.
    FileSamples (*read_samples)(const Path& path, const WantedSamples& wanted) = nullptr;
    nestgrid::CoarseGrid (*read_mesh)(const Path& path, const WantedMesh& wanted) = nullptr;
    /// Reads a field on a grid of its own, or frames of one, in this process.
    /// \param paths one for each frame
    /// \param times of the frames; empty for those of the files
    InputField (*read_field)(const Input& input, const std::vector<Path>& paths,
                             const std::vector<double>& times) = nullptr;
    /// Says what such a file has in it; null where there are no such files.
    void (*describe)(const Path& path, Report& report) = nullptr;
    /// \return why it could not be written, or nothing
    std::string (*write_surface)(vtkPolyData* surface, const Path& path,
                                 const SurfaceEncoding& encoding) = nullptr;

    /// Whether a field is read from files.
    bool has_fields() const {
        return read_samples != nullptr || read_field != nullptr || keeps_hierarchies;
    }
};

/// Makes a format known. For objects of static lifetime. What is read by one source and written by
/// another is registered by both, under one name.
class RegisteredFormat {
public:
    explicit RegisteredFormat(Format format);
};

/// All formats, by name.
const std::vector<Format>& formats();

/// The format of a file by the ending of its name, in capital letters or not, or by what is in it;
/// null for none.
const Format* format_of(const std::filesystem::path& path);

/// The endings of all formats that fields are read from.
std::vector<std::string> endings_of_fields();

/// The endings of all formats that are used for this.
template <class Use>
std::vector<std::string> endings_for(Use Format::*use) {
    std::vector<std::string> endings;
    for (const Format& format : formats()) {
        if (format.*use == nullptr) continue;
        endings.insert(endings.end(), format.endings.begin(), format.endings.end());
    }
    return endings;
}
