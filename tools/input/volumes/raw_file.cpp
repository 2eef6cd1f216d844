// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bare samples, x fastest, of which the command line says everything.
#include <algorithm>
#include <array>
#include <cstdio>

#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/volumes/file_samples.hpp"
#include "sample_layout.hpp"
#include "samples.hpp"

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;
namespace fs = std::filesystem;

/// A large whole number without an exponent.
std::string whole(double number) {
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), "%.0f", number);
    return text.data();
}

SampleLayout raw_layout(const fs::path& path, const RawFormat& raw) {
    const std::size_t size = bytes_of(raw.type);
    if (size == 0 || *std::min_element(raw.dims.begin(), raw.dims.end()) < 1) {
        throw InvalidInput(path.string() +
                           " does not describe itself: give --dims NX,NY,NZ and --type");
    }
    SampleLayout layout{.path = path, .type = raw.type};
    layout.files = {path};
    layout.geometry.samples = raw.dims;
    std::copy(raw.spacing.begin(), raw.spacing.end(), layout.geometry.spacing.begin());
    layout.big_endian = raw.big_endian;
    auto expected = static_cast<double>(size);
    for (const int n : raw.dims) expected *= n;
    const std::uintmax_t found = fs::file_size(path);
    if (static_cast<double>(found) != expected) {
        throw IoError(path.string() + " has " + std::to_string(found) +
                      " bytes, but --dims and --type ask for " + whole(expected));
    }
    return layout;
}

FileSamples read_raw(const fs::path& path, const WantedSamples& wanted) {
    return read_layout(raw_layout(path, wanted.raw));
}

const RegisteredFormat raw({.name = "bare samples",
                            .endings = {".raw"},
                            .holds = "samples in space, described by options",
                            .options = {"--dims", "--type", "--endian", "--spacing"},
                            .read_samples = read_raw});

}  // namespace
