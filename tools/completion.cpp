// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "help.hpp"

namespace {

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

std::vector<OptionText> options_of(const CLI::App& command) {
    std::vector<OptionText> options;
    for (const OptionGroup& group : option_groups(command)) {
        std::ranges::copy_if(group.options, std::back_inserter(options),
                             [](const OptionText& option) { return !option.positional; });
    }
    return options;
}

std::string names_of(const std::vector<const CLI::App*>& commands) {
    std::vector<std::string> names;
    for (const CLI::App* command : commands) names.push_back(command->get_name());
    return joined(names, " ");
}

std::string option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const OptionText& option : options_of(command)) {
        names.insert(names.end(), option.names.begin(), option.names.end());
    }
    return joined(names, " ");
}

/// What follows an option, as one case of bash.
std::string bash_values(const std::string& command, const OptionText& option) {
    if (option.value.empty()) return "";
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back(command + ":" + name);
    std::string reply = "return";
    if (!option.choices.empty()) {
        reply =
            "COMPREPLY=($(compgen -W '" + joined(option.choices, " ") + "' -- \"$cur\")); return";
    }
    if (option.value == "FILE") reply = "COMPREPLY=($(compgen -f -- \"$cur\")); return";
    return "    " + joined(patterns, " | ") + ") " + reply + " ;;\n";
}

/// A text between single quotes in a specification for _arguments of zsh.
std::string zsh_text(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\'') {
            result += "'\\''";
            continue;
        }
        if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
        result += c;
    }
    return result;
}

/// An option as an argument of _arguments.
std::string zsh_option(const OptionText& option) {
    std::string value;
    if (!option.value.empty()) {
        std::string reply = " ";
        if (!option.choices.empty()) reply = "(" + joined(option.choices, " ") + ")";
        if (option.value == "FILE") reply = "_files";
        value = ":" + zsh_text(option.value) + ":" + reply;
    }
    const std::string text = "'[" + zsh_text(option.description) + "]" + value + "'";
    const bool again = option.option->get_expected_max() > 1;
    if (option.names.size() == 1) {
        return std::string(again ? "'*'" : "") + option.names.front() + text;
    }
    return "'(" + joined(option.names, " ") + ")'{" + joined(option.names, ",") + "}" + text;
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
    const auto commands = listed_commands(program);
    std::string values;
    std::string options;
    for (const CLI::App* command : commands) {
        const std::string& name = command->get_name();
        for (const OptionText& option : options_of(*command)) values += bash_values(name, option);
        options += "    " + name + ") words='" + option_names(*command) + "' ;;\n";
    }
    return "# Completion of nestgrid for bash.\n"
           "_nestgrid() {\n"
           "    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} words=\n"
           "    COMPREPLY=()\n"
           "    # Bash takes --name=value apart.\n"
           "    if [ \"$cur\" = = ]; then cur=; elif [ \"$prev\" = = ]; then "
           "prev=${COMP_WORDS[COMP_CWORD - 2]}; fi\n"
           "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
           "        COMPREPLY=($(compgen -W '" +
           names_of(commands) + " " + option_names(program) +
           "' -- \"$cur\"))\n"
           "        return\n"
           "    fi\n"
           "    case \"${COMP_WORDS[1]}:$prev\" in\n" +
           values +
           "    esac\n"
           "    case \"${COMP_WORDS[1]}\" in\n" +
           options +
           "    esac\n"
           "    case \"$cur\" in\n"
           "    -*) COMPREPLY=($(compgen -W \"$words\" -- \"$cur\")) ;;\n"
           "    *) COMPREPLY=($(compgen -f -- \"$cur\")) ;;\n"
           "    esac\n"
           "}\n"
           "complete -o filenames -F _nestgrid nestgrid\n";
}

std::string zsh_completion(const CLI::App& program) {
    std::string described;
    std::string cases;
    for (const CLI::App* command : listed_commands(program)) {
        const std::string& name = command->get_name();
        described += "        '" + name + ":" + zsh_text(command->get_description()) + "'\n";
        cases += "    " + name + ")\n        _arguments -s";
        for (const OptionText& option : options_of(*command)) {
            cases += " \\\n            " + zsh_option(option);
        }
        cases += " \\\n            '*:file:_files'\n        ;;\n";
    }
    return "#compdef nestgrid\n"
           "# Completion of nestgrid for zsh.\n"
           "_nestgrid() {\n"
           "    local -a commands\n"
           "    commands=(\n" +
           described +
           "    )\n"
           "    if ((CURRENT == 2)); then\n"
           "        _describe command commands\n"
           "        return\n"
           "    fi\n"
           "    shift words\n"
           "    ((CURRENT--))\n"
           "    case $words[1] in\n" +
           cases +
           "    esac\n"
           "}\n"
           "_nestgrid \"$@\"\n";
}
