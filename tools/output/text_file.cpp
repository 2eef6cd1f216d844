// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/text_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "output/surface_file.hpp"

void write_text(const std::string& text, const std::filesystem::path& path) {
    write_by_rename(path, [&](const std::filesystem::path& temporary) -> std::string {
        std::ofstream file(temporary, std::ios::binary);
        file << text;
        file.close();
        return file ? "" : std::strerror(errno);
    });
}
