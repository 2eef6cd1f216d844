// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The bytes of a .nestgrid file: its header, and numbers that are put behind it and got from there.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <boost/crc.hpp>

#include <nestgrid/error.hpp>

namespace nestgrid::detail {

static_assert(std::endian::native == std::endian::little, "the file format is little-endian");

/// The first bytes of a file; what follows them is `body` bytes long.
struct FileHeader {
    std::array<char, 8> magic{'n', 'e', 's', 't', 'g', 'r', 'i', 'd'};
    std::uint32_t version = 1;  // 2 where there are frames, or encoded values
    std::uint32_t dimension = 0;
    std::array<char, 16> family{};
    std::uint32_t corners = 0;
    std::uint32_t options = 0;  // of the family
    std::uint64_t body = 0;
    std::uint32_t body_checksum = 0;    // CRC-32
    std::uint32_t header_checksum = 0;  // of all before

    std::uint32_t own_checksum() const {
        boost::crc_32_type crc;
        crc.process_bytes(this, offsetof(FileHeader, header_checksum));
        return crc.checksum();
    }
};
static_assert(sizeof(FileHeader) == 56 && std::is_trivially_copyable_v<FileHeader>);

inline std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

/// The body of a file in memory.
class Writer {
public:
    template <class T>
    void put(const T& value) {
        const auto* at = reinterpret_cast<const char*>(&value);
        bytes.insert(bytes.end(), at, at + sizeof(T));
    }
    template <class T>
    void put_all(const std::vector<T>& values) {
        put(static_cast<std::uint64_t>(values.size()));
        const auto* at = reinterpret_cast<const char*>(values.data());
        bytes.insert(bytes.end(), at, at + values.size() * sizeof(T));
    }
    std::vector<char> bytes;
};

class Reader {
public:
    Reader(std::vector<char> bytes, std::string name)
        : bytes_{std::move(bytes)}, name_{std::move(name)} {}

    [[noreturn]] void fail(const std::string& what) const {
        throw IoError(name_ + " is damaged: " + what);
    }
    template <class T>
    T get() {
        if (bytes_.size() - at_ < sizeof(T)) fail("it ends too early");
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }
    template <class T>
    std::vector<T> get_all() {
        const auto count = get<std::uint64_t>();
        if (count > (bytes_.size() - at_) / sizeof(T)) fail("it ends too early");
        std::vector<T> values(static_cast<std::size_t>(count));
        if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, values.size() * sizeof(T));
        at_ += values.size() * sizeof(T);
        return values;
    }
    bool at_end() const { return at_ == bytes_.size(); }

private:
    std::vector<char> bytes_;
    std::string name_;
    std::size_t at_ = 0;
};

inline FileHeader read_file_header(std::ifstream& file, const std::filesystem::path& path) {
    FileHeader header;
    if (!file) throw IoError(quoted(path) + " cannot be opened");
    if (!file.read(reinterpret_cast<char*>(&header), sizeof(header)) ||
        header.magic != FileHeader{}.magic) {
        throw IoError(quoted(path) + " is no nestgrid hierarchy");
    }
    if (header.version != 1 && header.version != 2) {
        throw IoError(quoted(path) + " has version " + std::to_string(header.version) +
                      " of the format; this program reads versions 1 and 2");
    }
    if (header.header_checksum != header.own_checksum()) {
        throw IoError(quoted(path) + " is damaged: the checksum of its header is wrong");
    }
    return header;
}

inline std::string text(const std::array<char, 16>& name) {
    return {name.data(), strnlen(name.data(), name.size())};
}

/// Completes the header and writes both. The file appears when it is complete.
inline void write_file(const std::filesystem::path& path, FileHeader header,
                       const std::vector<char>& body) {
    header.body = body.size();
    boost::crc_32_type crc;
    crc.process_bytes(body.data(), body.size());
    header.body_checksum = crc.checksum();
    header.header_checksum = header.own_checksum();

    std::filesystem::path part = path;
    part += ".part";
    {
        std::ofstream file(part, std::ios::binary);
        file.write(reinterpret_cast<const char*>(&header), sizeof(header));
        file.write(body.data(), static_cast<std::streamsize>(body.size()));
        file.close();
        if (!file) {
            std::error_code ignored;
            std::filesystem::remove(part, ignored);
            throw IoError(quoted(path) + " cannot be written");
        }
    }
    std::error_code failed;
    std::filesystem::rename(part, path, failed);
    if (failed) {
        std::filesystem::remove(part, failed);
        throw IoError(quoted(path) + " cannot be written");
    }
}

}  // namespace nestgrid::detail
