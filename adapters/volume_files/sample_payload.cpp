// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The samples behind the headers: plain, packed by zlib or gzip, or written as text.
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <nestgrid/error.hpp>

#include "sample_layout.hpp"
#include "samples.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::IoError;

/// Zlib packs at most 1032 to 1.
constexpr std::uintmax_t most_packed = 1032;

[[noreturn]] void throw_damaged(const fs::path& file) {
    throw IoError(file.string() + " is truncated or damaged: it cannot be unpacked to its end");
}

/// The least number of bytes that hold what a layout expects in each of its files.
std::uintmax_t least_size(const SampleLayout& layout, std::uintmax_t samples) {
    const std::uintmax_t bytes = samples * bytes_of(layout.type);
    if (layout.encoding == Encoding::deflated) return bytes / most_packed;
    if (layout.encoding == Encoding::text) return 2 * samples - 1;
    if (layout.encoding == Encoding::hex) return 2 * bytes;
    return bytes;
}

/// Opens a file where its samples start.
std::ifstream open_samples(const SampleLayout& layout, const fs::path& path, std::uintmax_t bytes) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw IoError(path.string() + " cannot be opened");
    file.seekg(static_cast<std::streamoff>(layout.header_bytes));
    for (std::uintmax_t i = 0; i < layout.skipped_lines && file; ++i) {
        file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    if (layout.skipped_bytes < 0) {
        file.seekg(-static_cast<std::streamoff>(bytes), std::ios::end);
    } else {
        file.seekg(layout.skipped_bytes, std::ios::cur);
    }
    return file;
}

void read_raw(std::istream& file, const fs::path& path, std::span<std::byte> samples) {
    file.read(reinterpret_cast<char*>(samples.data()),
              static_cast<std::streamsize>(samples.size()));
    if (static_cast<std::size_t>(file.gcount()) != samples.size()) {
        throw IoError(path.string() + " is truncated: it ends after " +
                      std::to_string(file.gcount()) + " bytes of samples of " +
                      std::to_string(samples.size()));
    }
}

/// Unpacks a stream of zlib or gzip, which may have several members, and lets zlib compare its
/// checksum.
void read_deflated(std::istream& file, const fs::path& path, std::span<std::byte> samples) {
    struct Stream : z_stream {
        Stream() : z_stream{} {
            if (inflateInit2(this, 15 + 32) != Z_OK) throw std::bad_alloc();
        }
        ~Stream() { inflateEnd(this); }
    } stream;
    std::vector<char> input(std::size_t{1} << 18U);
    std::array<unsigned char, 64> behind{};  // takes what follows the samples
    std::size_t done = 0;
    while (true) {
        if (stream.avail_in == 0) {
            file.read(input.data(), static_cast<std::streamsize>(input.size()));
            stream.next_in = reinterpret_cast<unsigned char*>(input.data());
            stream.avail_in = static_cast<unsigned>(file.gcount());
            if (stream.avail_in == 0) throw_damaged(path);
        }
        const std::size_t wanted = std::min<std::size_t>(samples.size() - done, 1U << 30U);
        stream.next_out =
            wanted > 0 ? reinterpret_cast<unsigned char*>(samples.data() + done) : behind.data();
        const auto space = static_cast<unsigned>(wanted > 0 ? wanted : behind.size());
        stream.avail_out = space;
        const int status = inflate(&stream, Z_NO_FLUSH);
        if (status != Z_OK && status != Z_STREAM_END) throw_damaged(path);
        if (wanted > 0) done += space - stream.avail_out;
        const bool more_than_samples = wanted == 0 && stream.avail_out < space;
        if (more_than_samples) return;
        if (status != Z_STREAM_END) continue;
        if (done == samples.size()) return;
        if (inflateReset(&stream) != Z_OK) throw_damaged(path);
    }
}

void read_text(std::istream& file, const SampleLayout& layout, const fs::path& path,
               std::span<std::byte> bytes) {
    with_samples(layout.type, bytes.data(), bytes.size() / bytes_of(layout.type),
                 [&](auto samples) {
                     using Sample = typename decltype(samples)::value_type;
                     for (Sample& sample : samples) {
                         std::conditional_t<sizeof(Sample) == 1, int, Sample> number{};
                         if (!(file >> number)) {
                             throw IoError(path.string() + " is truncated or damaged: only " +
                                           std::to_string(&sample - samples.data()) +
                                           " of its samples are numbers");
                         }
                         sample = static_cast<Sample>(number);
                     }
                 });
}

/// Reads two hexadecimal digits for each byte.
void read_hex(std::istream& file, const fs::path& path, std::span<std::byte> bytes) {
    const auto digit = [](char c) { return std::isdigit(c) != 0 ? c - '0' : (c | 32) - 'a' + 10; };
    for (std::byte& byte : bytes) {
        char high = 0;
        char low = 0;
        file >> high >> low;
        if (std::isxdigit(static_cast<unsigned char>(high)) == 0 ||
            std::isxdigit(static_cast<unsigned char>(low)) == 0) {
            throw IoError(path.string() + " is truncated or damaged: only " +
                          std::to_string(&byte - bytes.data()) + " of its bytes are hexadecimal");
        }
        byte = static_cast<std::byte>(16 * digit(high) + digit(low));
    }
}

void swap_bytes(std::span<std::byte> samples, std::size_t size) {
    for (std::size_t i = 0; i + size <= samples.size(); i += size) {
        std::reverse(samples.begin() + static_cast<std::ptrdiff_t>(i),
                     samples.begin() + static_cast<std::ptrdiff_t>(i + size));
    }
}

}  // namespace

std::size_t checked_size(const SampleLayout& layout) {
    std::uintmax_t samples = 1;  // at most 2^60
    for (const int n : layout.geometry.samples) samples *= static_cast<std::uintmax_t>(n);
    for (const std::size_t n : {layout.components, layout.frames}) {
        if (n == 0 || samples > PTRDIFF_MAX / 8 / n) throw std::bad_alloc();
        samples *= n;
    }
    const std::uintmax_t parts = layout.files.size();
    const std::string path = layout.path.string();
    if (samples % parts != 0) {
        throw IoError(path + " does not spread its samples evenly over its " +
                      std::to_string(parts) + " data files");
    }
    for (const fs::path& file : layout.files) {
        const std::uintmax_t found = fs::file_size(file);
        const std::uintmax_t behind = found - std::min(found, layout.header_bytes);
        const std::uintmax_t expected = least_size(layout, samples / parts);
        if (behind < expected) {
            throw IoError(file.string() + " is truncated: " + std::to_string(behind) +
                          " bytes of samples, but its header asks for " +
                          (layout.encoding == Encoding::raw ? "" : "at least ") +
                          std::to_string(expected));
        }
    }
    return samples * bytes_of(layout.type);
}

std::optional<std::uintmax_t> mappable_from(const SampleLayout& layout) {
    const std::size_t size = bytes_of(layout.type);
    const bool own_order =
        size == 1 || layout.big_endian == (std::endian::native == std::endian::big);
    if (layout.files.size() != 1 || layout.encoding != Encoding::raw || !own_order) return {};
    std::ifstream file = open_samples(layout, layout.files.front(), checked_size(layout));
    const std::streamoff begin = file.tellg();
    if (begin < 0 || static_cast<std::uintmax_t>(begin) % size != 0) return {};
    return static_cast<std::uintmax_t>(begin);
}

void read_samples(const SampleLayout& layout, std::span<std::byte> samples) {
    const std::size_t share = samples.size() / layout.files.size();
    for (std::size_t i = 0; i < layout.files.size(); ++i) {
        const fs::path& path = layout.files[i];
        const std::span<std::byte> part = samples.subspan(i * share, share);
        std::ifstream file = open_samples(layout, path, share);
        if (layout.encoding == Encoding::raw) read_raw(file, path, part);
        if (layout.encoding == Encoding::deflated) read_deflated(file, path, part);
        if (layout.encoding == Encoding::hex) read_hex(file, path, part);
        if (layout.encoding == Encoding::text) read_text(file, layout, path, part);
    }
    if (layout.big_endian && layout.encoding != Encoding::text) {
        swap_bytes(samples, bytes_of(layout.type));
    }
}
