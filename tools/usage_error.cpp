// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "usage_error.hpp"

#include <filesystem>

#include "help.hpp"
#include "suggestion.hpp"

namespace {

std::vector<std::string> names_of_commands(const CLI::App& program) {
    std::vector<std::string> names;
    for (const CLI::App* command : listed_commands(program)) names.push_back(command->get_name());
    return names;
}

/// The command that was given, or the program where there is none.
const CLI::App& given_command(const CLI::App& program) {
    const auto given =
        program.get_subcommands([](const CLI::App* command) { return command->count() > 0; });
    return given.empty() ? program : *given.front();
}

std::string unknown_option(const std::string& word, const CLI::App& command) {
    std::vector<std::string> known;
    for (const OptionGroup& group : option_groups(command)) {
        for (const OptionText& option : group.options) {
            if (!option.positional) known.push_back(option.names.back());
        }
    }
    const std::string name = word.substr(0, word.find('='));
    return "'" + command.get_name() + "' has no option " + word + did_you_mean(name, known);
}

std::string unknown_command(const std::string& word, const CLI::App& program) {
    const std::vector<std::string> commands = names_of_commands(program);
    std::error_code none;
    if (std::filesystem::exists(word, none)) {
        return "'" + word + "' is no command but a file: 'nestgrid info " + word +
               "' describes it, 'nestgrid isosurface " + word + " ...' draws it";
    }
    const std::string meant = did_you_mean(word, commands);
    return "there is no command '" + word + "'" +
           (meant.empty() ? ", only " + listed(commands) : meant);
}

/// The option that an error of CLI11 is about: the first word of its text that names one.
const CLI::Option* option_in(const std::string& text, const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        const std::size_t at = text.find(name);
        if (at == std::string::npos) continue;
        const std::string next = text.substr(at + name.size(), 1);
        if (next.empty() || next == ":" || next == " ") return option;
    }
    return nullptr;
}

/// What an option takes: "NUMBER", or for switches "no value".
std::string taken(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    return option.get_type_size_max() == 0 ? "no value" : type.substr(0, type.find(':'));
}

/// A value that cannot be read, or too few or too many of them.
std::string wrong_value(const CLI::ParseError& error, const CLI::App& command) {
    std::string text = error.what();
    const CLI::Option* const option = option_in(text, command);
    if (option == nullptr) return text;
    const std::string given = CLI::detail::join(option->results(), ",");
    const bool once = option->get_items_expected_max() <= 1;
    if (once && option->results().size() > 1) return option->get_name() + " is given twice";
    const std::string found = given.empty() ? "but nothing follows it" : "not '" + given + "'";
    return option->get_name() + " takes " + taken(*option) + ", " + found;
}

}  // namespace

std::string usage_error(const CLI::ParseError& error, const CLI::App& program) {
    const CLI::App& command = given_command(program);
    // Who misspells an option that is required has left it out, too.
    const std::vector<std::string> extra = program.remaining(true);
    if (!extra.empty()) {
        const std::string& word = extra.front();
        if (word.starts_with('-')) return unknown_option(word, command);
        if (&command == &program) return unknown_command(word, program);
        return "'" + word + "' was not expected by '" + command.get_name() + "'";
    }
    if (&command == &program) {
        return "a command is missing: one of " + listed(names_of_commands(program));
    }
    const bool value = dynamic_cast<const CLI::ConversionError*>(&error) != nullptr ||
                       dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr;
    return value ? wrong_value(error, command) : error.what();
}

void refuse_empty_lists(const CLI::App& program, std::span<const char* const> words) {
    for (const CLI::Option* option : given_command(program).get_options()) {
        const char comma = option->get_delimiter();
        if (comma == '\0') continue;
        const std::string name = option->get_name();
        for (const std::string& item : option->results()) {
            if (item.empty()) throw CLI::ConversionError("", name);
        }
        bool follows = false;
        for (const std::string word : words) {
            const bool joined = word.starts_with(name + "=");
            const std::string list = joined ? word.substr(name.size() + 1) : word;
            const std::string between = comma + list + comma;
            if ((joined || follows) && between.find(std::string(2, comma)) != std::string::npos) {
                throw CLI::ValidationError(
                    name, "nothing is between two commas, or beside one, in '" + list + "'");
            }
            follows = option->check_name(word);
        }
    }
}
