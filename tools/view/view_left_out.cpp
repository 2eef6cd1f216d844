// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/error.hpp>

#include "commands/command.hpp"

namespace {

Command add_view(CLI::App& program) {
    CLI::App* view = program.add_subcommand(
        "view", "explore a field in the browser (left out: -DNESTGRID_VIEW=ON)");
    view->footer(
        "Examples:\n"
        "  nestgrid view head.nii.gz\n");
    view->allow_extras();
    return {view, [](Report& /*report*/) {
                throw nestgrid::InvalidInput(
                    "this program was built without its page: configure with -DNESTGRID_VIEW=ON");
            }};
}

const RegisteredCommand view_command(120, add_view);

}  // namespace
