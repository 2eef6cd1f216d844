// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A part of a file as memory that the system reads when it is looked at, and may drop again. Where
// another program cuts the file off meanwhile, the system ends who looks beyond its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

class MappedFile {
public:
    /// \throw nestgrid::IoError where the file cannot be opened or has not so many bytes
    MappedFile(const std::filesystem::path& path, std::uintmax_t begin, std::size_t bytes);
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile();

    std::span<const std::byte> bytes() const { return bytes_; }

private:
    std::span<const std::byte> bytes_;
    void* pages_ = nullptr;  // that hold the bytes
    std::size_t size_ = 0;   // of the pages
};
