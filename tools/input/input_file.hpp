// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

/// \throw nestgrid::IoError unless the path is that of a file with something in it that can be
///        opened: one sentence on what it is instead, or on a file beside it with a similar name
void require_file(const std::filesystem::path& path);

/// The ending of a name in lower case, with its dot: ".vtp" of "X.VTP".
std::string ending_of(const std::filesystem::path& path);
