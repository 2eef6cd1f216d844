// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "temporary_file.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <nestgrid/error.hpp>

namespace {

/// What a signal removes.
struct Names {
    std::array<char, 4096> folder{};
    std::array<char, 4096> file{};
};
std::array<Names, 2> all_names{};
// Only the process that made the files removes them: its children have the handler, too.
pid_t maker = 0;

void remove_file(Names& names) {
    if (names.folder.front() == 0 || getpid() != maker) return;
    unlink(names.file.data());
    rmdir(names.folder.data());
    names.folder.front() = 0;
}

void end_by(int signal) {
    for (Names& names : all_names) remove_file(names);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

void remember(const std::string& name, std::array<char, 4096>& where) {
    if (name.size() >= where.size()) throw nestgrid::IoError(name + " is too long a name");
    where = {};
    name.copy(where.data(), name.size());
}

}  // namespace

TemporaryFile::TemporaryFile(const std::string& name) {
    std::string folder = (std::filesystem::temp_directory_path() / "nestgrid-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) {
        throw nestgrid::IoError(folder + " cannot be made: " + std::strerror(errno));
    }
    path_ = std::filesystem::path(folder) / name;
    slot_ = all_names.front().folder.front() == 0 ? 0 : 1;
    remember(path_.string(), all_names[slot_].file);
    remember(folder, all_names[slot_].folder);
    maker = getpid();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, end_by);
}

TemporaryFile::~TemporaryFile() { remove_file(all_names[slot_]); }
