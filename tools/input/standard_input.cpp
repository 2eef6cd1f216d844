// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/standard_input.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>

#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/input_file.hpp"
#include "suggestion.hpp"
#include "temporary_file.hpp"
#include "text_header.hpp"

namespace {

/// Keeps standard input as long as the program runs.
std::unique_ptr<const TemporaryFile> kept_input;

/// The ending with its dot, in lower case.
/// \throw nestgrid::InvalidInput where no stream has it
std::string checked(const std::string& ending) {
    if (ending.empty()) {
        throw nestgrid::InvalidInput(
            "standard input has no name that tells its format: give --input-format, like nii.gz");
    }
    std::string dotted = lower(ending.front() == '.' ? ending : "." + ending);
    const std::vector<std::string> known = endings_of_fields();
    if (std::ranges::find(known, dotted) == known.end()) {
        throw nestgrid::InvalidInput("the input format '" + ending + "' is none of " +
                                     listed(known) + did_you_mean(dotted, known));
    }
    const Format& format = *format_of("x" + dotted);
    if (std::ranges::find(format.detached, dotted) != format.detached.end()) {
        throw nestgrid::InvalidInput("a " + dotted +
                                     " file comes with others, which standard input has not: "
                                     "give its name");
    }
    return dotted;
}

}  // namespace

bool is_standard_stream(const std::filesystem::path& path) { return path == "-"; }

std::filesystem::path keep_standard_input(const std::string& ending) {
    if (kept_input) return kept_input->path();
    const std::string name = "standard input" + checked(ending);
    if (isatty(STDIN_FILENO) == 1) {
        throw nestgrid::IoError("standard input is a terminal: send a file to it");
    }
    auto file = std::make_unique<const TemporaryFile>(name);
    std::ofstream out(file->path(), std::ios::binary);
    errno = 0;
    if (std::cin.peek() != std::char_traits<char>::eof()) out << std::cin.rdbuf();
    out.close();
    if (!out) {
        throw nestgrid::IoError("standard input cannot be kept in " +
                                file->path().parent_path().string() + ": " + std::strerror(errno));
    }
    kept_input = std::move(file);
    return kept_input->path();
}

std::string without_folder_of_input(std::string sentence) {
    if (!kept_input) return sentence;
    const std::string folder = kept_input->path().parent_path().string() + "/";
    for (std::size_t at = 0; (at = sentence.find(folder, at)) != std::string::npos;) {
        sentence.erase(at, folder.size());
    }
    return sentence;
}
