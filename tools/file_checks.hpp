// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is known of a volume file before anything of it is allocated: VTK's readers accept files
// that end too early, and some headers make them search for ever.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

std::string lower(std::string text);

/// \throw nestgrid::IoError
[[noreturn]] void truncated(const std::filesystem::path& path, std::uintmax_t found,
                            std::uintmax_t expected);

/// The text header of MetaImage and NRRD files: keys in lower case.
struct TextHeader {
    std::map<std::string, std::string> field;
    std::uintmax_t length = 0;
    bool ended = false;  ///< by a blank line

    std::vector<double> numbers(const std::string& key) const;
    std::string value(const std::string& key) const;
};

/// Reads "key <separator> value" lines up to a blank line or the key `last`.
TextHeader read_text_header(const std::filesystem::path& path, char separator,
                            const std::string& last);

/// \throw nestgrid::IoError where the data file of a MetaImage is missing or too short
void check_meta_sizes(const std::filesystem::path& path);

/// \throw nestgrid::IoError where the header of an NRRD file does not end, or its data are too
/// short
void check_nrrd_sizes(const std::filesystem::path& path, const TextHeader& header);

/// The bytes of a file, unpacked where it is packed with gzip.
/// \throw nestgrid::IoError where it ends too early
std::uintmax_t unpacked_size(const std::filesystem::path& path);

/// Where the samples of a NIfTI file start.
std::uintmax_t nifti_offset(const std::filesystem::path& path);

/// \throw nestgrid::IoError where the file does not end with its closing element
void check_xml_end(const std::filesystem::path& path);
