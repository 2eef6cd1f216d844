// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "formats.hpp"
#include "input/hierarchy.hpp"
#include "options/command_line.hpp"
#include "output/print.hpp"

namespace {

void run_info(Input& input, Report& report) {
    open(input);
    const Format* const format = format_of(input.path);
    if (format != nullptr && format->describe != nullptr) {
        refuse_options(*input.command, {"--array"}, "chooses nothing: all fields are described");
        refuse_options(*input.command, {"--cells"}, "changes nothing: cells are described");
        format->describe(input.path, report);
    } else if (is_hierarchy(input.path)) {
        refuse_options(*input.command, {"--array"}, "chooses nothing: all fields are described");
        report_info(hierarchy_info(input.path), report);
    } else {
        report_info(read_volumes(input, false).front(), report);
    }
}

Command add_info(CLI::App& program) {
    auto input = std::make_shared<Input>();
    CLI::App* info =
        program.add_subcommand("info", "describe a file: what the program takes it for");
    info->footer(
        "Examples:\n"
        "  nestgrid info head.nii.gz\n"
        "  nestgrid info ct.raw --dims 20,24,18 --type uint8 --spacing 0.5,1,2\n");
    add_input(*info, *input);
    add_read_options(*info, *input);
    return {info, [input](Report& report) { run_info(*input, report); }};
}

const RegisteredCommand info_command(80, add_info);

}  // namespace
