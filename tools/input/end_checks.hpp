// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether files are complete that VTK also reads where their end is missing.
#pragma once

#include <cstdint>
#include <filesystem>

/// \throw nestgrid::IoError where the file does not end with its closing element
void check_xml_end(const std::filesystem::path& path);

/// What VTK believes of the header of a NIfTI file without a look at it.
struct NiftiStart {
    int type = 0;        ///< of the samples, as datatype codes it
    double offset = 0;   ///< where they start
    double header = 0;   ///< bytes of the header, with its extension flag
    bool single = true;  ///< whether header and samples are in one file
};

/// \throw nestgrid::IoError for a header whose samples have a type that VTK does not know, which it
///        looks for behind the end of its list, or start inside the header
NiftiStart checked_nifti_start(const std::filesystem::path& header);

/// Unpacks a file of samples that is packed with gzip, so that zlib compares its checksum.
/// \param bytes of samples that the header asks for
/// \throw nestgrid::IoError where it holds less, or is damaged
void check_nifti_size(const std::filesystem::path& samples, const NiftiStart& start,
                      std::uintmax_t bytes);
