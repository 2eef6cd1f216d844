// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// MetaImage (.mha and .mhd). The header is read here, not by the library of MetaImage that VTK and
// ITK have, which takes truncated packed samples, and slabs in several files for garbage, without a
// word.
#include "formats.hpp"
#include "input/volumes/file_samples.hpp"
#include "sample_layout.hpp"

namespace {

FileSamples read_meta_image(const std::filesystem::path& path, const WantedSamples& /*wanted*/) {
    return read_layout(meta_layout(path));
}

const RegisteredFormat meta_image({.name = "MetaImage",
                                   .endings = {".mha", ".mhd"},
                                   .holds = "samples in space, several frames",
                                   .detached = {".mhd"},
                                   .reads_beside = true,
                                   .read_samples = read_meta_image});

}  // namespace
