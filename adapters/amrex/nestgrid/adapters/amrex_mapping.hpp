// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>

#include <nestgrid/error.hpp>

namespace nestgrid::detail {

/// A file as memory that the system reads when it is looked at. Where another program cuts the file
/// off meanwhile, the system ends who looks beyond its end.
class AmrexMapping {
public:
    /// \throw IoError where there is no such file, or it cannot be mapped
    explicit AmrexMapping(const std::filesystem::path& path) {
        const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
        if (file < 0) fail(path, "cannot be opened");
        struct stat status {};
        const bool is_file = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
        if (is_file && status.st_size > 0) {
            const auto size = static_cast<std::size_t>(status.st_size);
            pages_ = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
            if (pages_ != MAP_FAILED) bytes_ = {static_cast<const std::byte*>(pages_), size};
        }
        const bool is_mapped = pages_ != MAP_FAILED;
        close(file);
        if (!is_file) throw IoError("'" + path.string() + "' is no file");
        if (!is_mapped) fail(path, "cannot be mapped");
    }
    AmrexMapping(const AmrexMapping&) = delete;
    AmrexMapping& operator=(const AmrexMapping&) = delete;
    ~AmrexMapping() {
        if (!bytes_.empty()) munmap(pages_, bytes_.size());
    }

    std::span<const std::byte> bytes() const { return bytes_; }

private:
    [[noreturn]] static void fail(const std::filesystem::path& path, const char* what) {
        throw IoError("'" + path.string() + "' " + what + ": " + std::strerror(errno));
    }

    void* pages_ = nullptr;
    std::span<const std::byte> bytes_;
};

}  // namespace nestgrid::detail
