// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The subcommands of the program. Each stands in one source, which registers it when the program
// starts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "output/report.hpp"

/// A subcommand: its options, and what it does once they are parsed.
struct Command {
    CLI::App* options;
    std::function<void(Report&)> run;
    /// What a required option may be, where it was left out and the others are known; empty where
    /// there is nothing to say.
    std::function<std::string()> advice{};
};

/// Makes a subcommand known. For objects of static lifetime.
class RegisteredCommand {
public:
    /// \param rank the help lists subcommands in ascending order of it
    RegisteredCommand(int rank, Command (*add)(CLI::App& program));
};

/// Adds all subcommands to the program.
std::vector<Command> add_commands(CLI::App& program);
