// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Work that may crash, hang or ask for all memory, because foreign code reads foreign files, is
// done by a child process. Its death is one sentence to the parent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

struct Format;

/// Blocks of bytes in memory that a child process shares with its parent. The child appends them,
/// the parent looks at them without a copy. A block starts at a page.
class Parcel {
public:
    /// \throw nestgrid::IoError where the system gives no memory to share
    Parcel();
    Parcel(const Parcel&) = delete;
    Parcel& operator=(const Parcel&) = delete;
    ~Parcel();

    /// Appends a block of zeros, one of 15 at most.
    /// \return the block, which stays where it is as long as the process lives
    /// \throw std::bad_alloc
    std::span<std::byte> append(std::size_t bytes);

    /// Appends a copy.
    template <class Value>
    void put(std::span<const Value> values) {
        const std::span<std::byte> block = append(values.size_bytes());
        if (!values.empty()) std::memcpy(block.data(), values.data(), values.size_bytes());
    }

    /// Appends a copy and gives the memory of the original back to the system as the copy grows,
    /// so that both together are never twice as large. The original must not be used any more.
    void put_last_use(std::span<std::byte> bytes);

    /// Block i, once the parcel has been opened.
    template <class Value>
    std::span<const Value> block(std::size_t i) const {
        const std::span<const std::byte> bytes = block_bytes(i);
        return {reinterpret_cast<const Value*>(bytes.data()), bytes.size() / sizeof(Value)};
    }

    /// Lets the parent look at what its child has appended.
    /// \throw std::bad_alloc
    void open();

private:
    struct Directory;

    std::span<const std::byte> block_bytes(std::size_t i) const;

    int file_ = -1;
    Directory* directory_ = nullptr;
    std::span<std::byte> contents_;  ///< of the file, once it has been opened
};

/// The size of a file, or of all files in a folder; where the format reads files beside, of those,
/// too.
std::uintmax_t bytes_to_read(const std::filesystem::path& path, const Format& format);

/// Seconds within which a file of so many bytes, unpacked, can be read from a slow disk.
constexpr double reading_time(std::uintmax_t bytes) {
    return 60 + static_cast<double>(bytes) / 1e6;
}

/// Runs work(parcel) in a child process, which sees no standard input and whose output is thrown
/// away. It may use the memory that is free, and `seconds`. To be called before there are threads.
/// \param file to be named in sentences
/// \return what the child has put into its parcel
/// \throw nestgrid::IoError with the text of the exception that the work throws, or with a
///        sentence on how the child died
std::shared_ptr<const Parcel> run_apart(const std::string& file, double seconds,
                                        const std::function<void(Parcel&)>& work);
/// The same for work that reads a file; what is wrong with its content is said behind its name.
std::shared_ptr<const Parcel> read_file_apart(const std::filesystem::path& path, double seconds,
                                              const std::function<void(Parcel&)>& work);
