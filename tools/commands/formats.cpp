// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "formats.hpp"

#include "commands/command.hpp"

namespace {

/// What a format can be used as.
std::string uses_of(const Format& format) {
    std::string uses;
    const auto add = [&](bool used, const char* as) {
        if (used) uses += (uses.empty() ? "" : ", ") + std::string(as);
    };
    add(format.has_fields(), "read");
    add(format.read_mesh != nullptr, "mesh");
    add(format.write_surface != nullptr || format.keeps_hierarchies, "written");
    return uses;
}

void run_formats(Report& report) {
    for (const Format& format : formats()) {
        std::string endings = format.endings.empty() ? "a folder" : "";
        for (const std::string& ending : format.endings) {
            endings += (endings.empty() ? "" : " ") + ending;
        }
        Row row;
        row.add("format", format.name).add("endings", endings).add("use", uses_of(format));
        report.add_row("formats", row.add("holds", format.holds));
    }
    report.say("read: a field is drawn of it; mesh: 'nestgrid mesh' makes a hierarchy of it");
}

Command add_formats(CLI::App& program) {
    CLI::App* formats = program.add_subcommand("formats", "list the formats of files");
    formats->footer(
        "Examples:\n"
        "  nestgrid formats\n");
    return {formats, run_formats};
}

const RegisteredCommand formats_command(90, add_formats);

}  // namespace
