// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/end_checks.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <nestgrid/error.hpp>

namespace {

namespace fs = std::filesystem;
using nestgrid::IoError;

/// The bytes of a file, unpacked where it is packed with gzip.
std::uintmax_t unpacked_size(const fs::path& path) {
    gzFile file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw IoError(path.string() + " cannot be opened");
    if (gzdirect(file) == 1) {
        gzclose(file);
        return fs::file_size(path);
    }
    std::vector<char> buffer(1U << 20U);
    std::uintmax_t total = 0;
    int count = 0;
    while ((count = gzread(file, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0) {
        total += static_cast<std::uintmax_t>(count);
    }
    const int error = gzclose(file);
    if (count < 0 || error != Z_OK) {
        throw IoError(path.string() + " is truncated or damaged: it cannot be unpacked to its end");
    }
    return total;
}

NiftiStart nifti_start(const fs::path& path) {
    std::array<char, 352> header{};
    gzFile file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw IoError(path.string() + " cannot be opened");
    const int count = gzread(file, header.data(), header.size());
    gzclose(file);
    if (count < 348) throw IoError(path.string() + " is truncated in its header");
    const bool swapped = header[0] != 0x5C && header[0] != 0x1C;  // 348 or 540, low byte first
    const auto load = [&]<class Number>(std::size_t at, Number number) {
        std::array<char, sizeof(Number)> bytes{};
        std::copy_n(header.begin() + static_cast<std::ptrdiff_t>(at), bytes.size(), bytes.begin());
        if (swapped) std::reverse(bytes.begin(), bytes.end());
        std::memcpy(&number, bytes.data(), bytes.size());
        return number;
    };
    const bool second = load(0, std::int32_t{}) == 540;
    NiftiStart start;
    start.type = load(second ? 12 : 70, std::int16_t{});
    start.offset = second ? static_cast<double>(load(168, std::int64_t{})) : load(108, float{});
    start.header = second ? 544 : 352;
    start.single = header[second ? 5 : 345] == '+';
    return start;
}

}  // namespace

void check_xml_end(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const auto size = static_cast<std::streamoff>(fs::file_size(path));
    file.seekg(std::max<std::streamoff>(0, size - 64));
    const std::string tail((std::istreambuf_iterator<char>(file)), {});
    if (tail.find("</VTKFile>") == std::string::npos) {
        throw IoError(path.string() + " is truncated: it does not end with </VTKFile>");
    }
}

NiftiStart checked_nifti_start(const fs::path& path) {
    const NiftiStart start = nifti_start(path);
    // The types of the standard, but for bits and for numbers of 128 bits.
    constexpr std::array known{2, 4, 8, 16, 32, 64, 128, 256, 512, 768, 1024, 1280, 1792, 2304};
    if (std::ranges::find(known, start.type) == known.end()) {
        throw IoError(path.string() + " has samples of the type " + std::to_string(start.type) +
                      ", which is not read");
    }
    if (start.single && !(start.offset >= start.header && start.offset < 1e12)) {
        throw IoError(path.string() + " places its samples inside its header");
    }
    return start;
}

void check_nifti_size(const fs::path& samples, const NiftiStart& start, std::uintmax_t bytes) {
    // Analyze headers, and others of samples in a file of their own, may say 0.
    const std::uintmax_t expected =
        bytes + static_cast<std::uintmax_t>(std::max(0.0, start.offset));
    const std::uintmax_t found = unpacked_size(samples);
    if (found < expected) {
        throw IoError(samples.string() + " is truncated: " + std::to_string(found) +
                      " bytes, but its header asks for " + std::to_string(expected));
    }
}
