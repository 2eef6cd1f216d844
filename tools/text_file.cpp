// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "text_file.hpp"

#include <fstream>

#include <nestgrid/error.hpp>

#include "surface_file.hpp"

namespace fs = std::filesystem;

void write_text(const std::string& text, const fs::path& path) {
    const fs::path temporary = temporary_beside(path);
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    file.close();
    std::error_code error;
    if (file) fs::rename(temporary, path, error);
    if (file && !error) return;
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw nestgrid::IoError(path.string() + " could not be written");
}
