// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/command.hpp"

#include <map>

namespace {

using Add = Command (*)(CLI::App& program);

std::multimap<int, Add>& all_commands() {
    static std::multimap<int, Add> all;
    return all;
}

}  // namespace

RegisteredCommand::RegisteredCommand(int rank, Add add) { all_commands().emplace(rank, add); }

std::vector<Command> add_commands(CLI::App& program) {
    std::vector<Command> commands;
    for (const auto& [rank, add] : all_commands()) commands.push_back(add(program));
    return commands;
}
