// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include <nestgrid/error.hpp>

namespace {

using nestgrid::IoError;

/// An open file.
class OpenFile {
public:
    explicit OpenFile(const std::filesystem::path& path)
        : file_{open(path.c_str(), O_RDONLY | O_CLOEXEC)} {
        if (file_ < 0) {
            throw IoError(path.string() + " cannot be opened: " + std::strerror(errno));
        }
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile() { close(file_); }

    int number() const { return file_; }
    std::uintmax_t size() const {
        struct stat status {};
        return fstat(file_, &status) == 0 ? static_cast<std::uintmax_t>(status.st_size) : 0;
    }

private:
    int file_;
};

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path, std::uintmax_t begin, std::size_t bytes) {
    const OpenFile file(path);
    if (begin > file.size() || file.size() - begin < bytes) {
        throw IoError(path.string() + " is truncated: it has " + std::to_string(file.size()) +
                      " bytes, but its samples end at " + std::to_string(begin + bytes));
    }
    if (bytes == 0) return;
    const auto page = static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE));
    const auto within = static_cast<std::size_t>(begin % page);
    size_ = within + bytes;
    pages_ = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.number(),
                  static_cast<off_t>(begin - within));
    if (pages_ == MAP_FAILED) {
        pages_ = nullptr;
        throw IoError(path.string() + " cannot be mapped: " + std::strerror(errno));
    }
    bytes_ = {static_cast<const std::byte*>(pages_) + within, bytes};
}

MappedFile::~MappedFile() {
    if (pages_ != nullptr) munmap(pages_, size_);
}
