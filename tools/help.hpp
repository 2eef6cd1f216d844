// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the program says about itself: help, a manual page and completion, all of them made from its
// tree of commands and options.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

/// Gives the program, and the commands that are added to it afterwards, help as wide as the
/// terminal, at most 100 columns, or 80 where there is none. --help takes at most 45 lines: groups
/// of options that do not fit are listed by their names, and described by --help-all.
void set_help(CLI::App& program);

/// The page for man(1).
std::string manual_page(const CLI::App& program, const std::string& version);

/// A script that completes commands, options, their words and files.
std::string bash_completion(const CLI::App& program);
std::string zsh_completion(const CLI::App& program);

/// An option as its readers see it.
struct OptionText {
    const CLI::Option* option = nullptr;
    std::vector<std::string> names{};    ///< -o, --output; of a positional: INPUT
    std::string value{};                 ///< what it takes: NUMBER; empty for flags
    std::vector<std::string> choices{};  ///< the words that it takes, where they are known
    std::string description{};
    bool positional = false;

    /// "-o,--output FILE"
    std::string usage() const;
};

struct OptionGroup {
    std::string title;
    std::vector<OptionText> options;
};

/// A description as a sentence.
std::string sentence(std::string description);

/// The options that help describes, in the order of their creation; the group "Further" last.
std::vector<OptionGroup> option_groups(const CLI::App& command);

/// The commands that help lists.
std::vector<const CLI::App*> listed_commands(const CLI::App& program);

/// "nestgrid slice INPUT [FRAMES...] --value NUMBER [OPTIONS]"
std::string usage_line(const CLI::App& command, const std::string& name);

/// A footer has parts, each of a title with a colon and lines below it that begin with two blanks;
/// blank lines are between them.
struct FooterPart {
    std::string title;
    std::vector<std::string> lines;
};
std::vector<FooterPart> footer_parts(const CLI::App& command);
