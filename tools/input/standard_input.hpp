// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Standard input in the place of a file: "-".
#pragma once

#include <filesystem>
#include <string>

/// Whether a name stands for standard input or output.
bool is_standard_stream(const std::filesystem::path& path);

/// Keeps all of standard input in a file, which has the ending of its format and goes when the
/// program ends.
/// \param ending with its dot or without; in capital letters or not
/// \return its path, the same each time
/// \throw nestgrid::InvalidInput for an ending of no format, or of one whose data are in several
///        files
/// \throw nestgrid::IoError where standard input is a terminal, or cannot be kept
std::filesystem::path keep_standard_input(const std::string& ending);

/// A sentence that calls the file by its name alone, without the folder where it is kept.
std::string without_folder_of_input(std::string sentence);
