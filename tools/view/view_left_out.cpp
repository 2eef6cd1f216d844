// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/error.hpp>

#include "../command_line.hpp"

Command add_view(CLI::App& program) {
    CLI::App* view = program.add_subcommand(
        "view", "explore a field in the browser (left out here: build with -DNESTGRID_VIEW=ON)");
    view->allow_extras();
    return {view, [] {
                throw nestgrid::InvalidInput(
                    "this program was built without its page: configure with -DNESTGRID_VIEW=ON");
            }};
}
