// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

/// A file in a folder of its own. Both go with this object, or where a signal ends the program. At
/// most two of them are there at any time.
class TemporaryFile {
public:
    /// \throw nestgrid::IoError where there can be no folder
    explicit TemporaryFile(const std::string& name);
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    std::size_t slot_ = 0;
};
