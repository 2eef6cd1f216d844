// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether files are complete that VTK also reads where their end is missing.
#pragma once

#include <cstdint>
#include <filesystem>

/// \throw nestgrid::IoError where the file does not end with its closing element
void check_xml_end(const std::filesystem::path& path);

/// \throw nestgrid::IoError for a NIfTI file whose samples have a type that VTK does not know,
/// which
///        it looks for behind the end of its list, or start inside the header
void check_nifti_header(const std::filesystem::path& path);

/// Unpacks a NIfTI file that is packed with gzip, so that zlib compares its checksum.
/// \param samples bytes that its header asks for
/// \throw nestgrid::IoError where it holds less, or is damaged
void check_nifti_size(const std::filesystem::path& path, std::uintmax_t samples);
