// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

/// Writes a text into a file. The file appears complete, by rename, or not at all.
/// \throw nestgrid::IoError
void write_text(const std::string& text, const std::filesystem::path& path);
