// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The command-line program: options in, results out.
#include "program.hpp"

#include <cstdio>

#include <vtkObject.h>

#include "commands/command.hpp"
#include "help.hpp"
#include "input/standard_input.hpp"
#include "output/report.hpp"
#include "usage_error.hpp"
#include "version.hpp"

namespace {

/// Adds the options that all commands have.
std::vector<Command> commands_of(CLI::App& program, bool& json) {
    std::vector<Command> commands = add_commands(program);
    for (const Command& command : commands) {
        command.options->add_flag("--json", json, "print everything as one JSON document")
            ->group("Further");
        for (CLI::Option* option :
             {command.options->get_option("--help"), command.options->get_option("--help-all")}) {
            option->group("Further");
        }
        // What follows an option and its value is no further value of it, but a file.
        for (CLI::Option* option : command.options->get_options()) {
            if (!option->get_positional()) option->allow_extra_args(false);
        }
    }
    return commands;
}

/// Prints a text that is made of the tree of commands.
void add_text(CLI::App& program, const std::string& name,
              const std::function<std::string(const CLI::App&)>& text) {
    program.add_subcommand(name)->group("")->final_callback(
        [&program, text] { std::fputs(text(program).c_str(), stdout); });
}

/// Prints why the arguments cannot be used.
/// \return the exit status
int refuse(const CLI::ParseError& error, const CLI::App& program,
           const std::vector<Command>& commands) {
    std::string text = usage_error(error, program);
    const bool is_missing =
        dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && text == error.what();
    try {
        for (const Command& command : commands) {
            if (is_missing && *command.options && command.advice) text += command.advice();
        }
    } catch (const std::exception& unreadable) {
        std::fprintf(stderr, "nestgrid: %s\n", without_folder_of_input(unreadable.what()).c_str());
        return 1;
    }
    std::fprintf(stderr, "nestgrid: %s (see nestgrid --help)\n", text.c_str());
    return 2;
}

}  // namespace

int run_program(int argc, char** argv) {
    vtkObject::GlobalWarningDisplayOff();
    CLI::App app{"Adaptive, crack-free surfaces from hierarchical grids", "nestgrid"};
    set_help(app);
    app.set_version_flag(
        "--version", [] { return version_text(); }, "print what this is built with");
    app.require_subcommand(1);
    app.footer(
        "Examples:\n"
        "  nestgrid info head.nii.gz\n"
        "  nestgrid isosurface head.nii.gz --value 60 --threshold 2% -o head.vtp\n"
        "  nestgrid slice head.nii.gz --axis z --at 30 --threshold 2% --image slice.png\n"
        "  nestgrid view head.nii.gz");
    bool json = false;
    const std::vector<Command> commands = commands_of(app, json);
    Report report(json);
    add_text(app, "manual",
             [](const CLI::App& tree) { return manual_page(tree, NESTGRID_VERSION); });
    add_text(app, "bash-completion", bash_completion);
    add_text(app, "zsh-completion", zsh_completion);
    try {
        app.parse(argc, argv);
        refuse_empty_lists(app, std::span(argv, static_cast<std::size_t>(argc)));
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        return refuse(error, app, commands);
    }
    try {
        for (const Command& command : commands) {
            if (*command.options) command.run(report);
        }
        report.print();
        return 0;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "nestgrid: not enough memory\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "nestgrid: %s\n", without_folder_of_input(error.what()).c_str());
    }
    return 1;
}
