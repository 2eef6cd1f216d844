// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The text headers of MetaImage and NRRD files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

std::string lower(std::string text);

/// Lines "key <separator> value" of a header.
struct TextHeader {
    std::filesystem::path path;
    std::map<std::string, std::string> field;       ///< by keys in lower case
    std::map<std::string, std::string> spelling{};  ///< of these keys in the file
    std::uintmax_t length = 0;                      ///< bytes
    bool ended = false;                             ///< by a blank line or by the last key

    /// The words of a value, brackets and commas aside.
    /// \throw nestgrid::IoError where one of them is no number
    std::vector<double> numbers(const std::string& key) const;
    /// The numbers of a key, which must be `count`; none where there is no such key.
    std::vector<double> numbers(const std::string& key, std::size_t count) const;
    /// "the ElementSpacing '1 1 2'", for sentences.
    std::string described(const std::string& key) const;
    /// Empty where there is no such key.
    std::string value(const std::string& key) const;
};

/// Reads lines up to a blank one, or to one with the key `last` whose value begins with
/// `last_value`.
TextHeader read_text_header(const std::filesystem::path& path, char separator,
                            const std::string& last, const std::string& last_value = "");

/// The data files that a header names, which stand in its folder: one name; LIST and the names in
/// the lines behind the header; or a pattern like slice%03d.raw and its first and last number and
/// step.
/// \throw nestgrid::IoError for a name that is no file, and for lists that are no such lists
std::vector<std::filesystem::path> data_files(const TextHeader& header, const std::string& names);
