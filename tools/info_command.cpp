// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.hpp"
#include "hierarchy.hpp"
#include "print.hpp"

namespace {

void run_info(Input& input) {
    if (is_hierarchy(input.path)) {
        print_info(hierarchy_info(input.path));
    } else {
        print_info(read_volume(input));
    }
}

}  // namespace

Command add_info(CLI::App& program) {
    auto input = std::make_shared<Input>();
    CLI::App* info = program.add_subcommand("info", "describe a volume or a hierarchy");
    add_input_options(*info, *input);
    return {info, [input] { run_info(*input); }};
}
