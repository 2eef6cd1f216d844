// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>

#include "help.hpp"

namespace {

/// A text in the language of man(7).
std::string roff(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\\') {
            result += "\\e";
        } else if (c == '-') {
            result += "\\-";
        } else {
            result += c;
        }
    }
    const bool request = result.starts_with('.') || result.starts_with('\'');
    return request ? "\\&" + result : result;
}

/// The day on which the page is made, or that of SOURCE_DATE_EPOCH, so that a build can be
/// repeated.
std::string today() {
    const char* const epoch = std::getenv("SOURCE_DATE_EPOCH");
    const std::time_t seconds = epoch == nullptr ? std::time(nullptr) : std::atoll(epoch);
    std::array<char, 20> text{};
    std::tm day{};
    std::strftime(text.data(), text.size(), "%Y-%m-%d", gmtime_r(&seconds, &day));
    return text.data();
}

std::string text_of(const OptionGroup& group) {
    std::string text;
    for (const OptionText& option : group.options) {
        text +=
            ".TP\n.B " + roff(option.usage()) + "\n" + roff(sentence(option.description)) + "\n";
        if (option.choices.empty()) continue;
        std::string words;
        for (const std::string& word : option.choices) words += (words.empty() ? "" : ", ") + word;
        text += "One of " + roff(words) + ".\n";
    }
    return text;
}

/// A group of options that several commands have, word by word.
struct SharedGroup {
    std::string title;
    std::string text;
    std::vector<std::string> commands;
};

std::vector<SharedGroup> shared_groups(const std::vector<const CLI::App*>& commands) {
    std::vector<SharedGroup> groups;
    for (const CLI::App* command : commands) {
        for (const OptionGroup& group : option_groups(*command)) {
            const std::string text = text_of(group);
            auto same = std::ranges::find_if(groups, [&](const SharedGroup& each) {
                return each.title == group.title && each.text == text;
            });
            if (same == groups.end()) same = groups.insert(same, {group.title, text, {}});
            same->commands.push_back(command->get_name());
        }
    }
    std::erase_if(groups, [](const SharedGroup& each) { return each.commands.size() < 2; });
    return groups;
}

bool is_shared(const std::vector<SharedGroup>& groups, const OptionGroup& group) {
    return std::ranges::any_of(groups, [&](const SharedGroup& each) {
        return each.title == group.title && each.text == text_of(group);
    });
}

std::string command_section(const CLI::App& command, const std::vector<SharedGroup>& groups) {
    std::string page = ".SS " + command.get_name() + "\n.B " +
                       roff(usage_line(command, "nestgrid " + command.get_name())) + "\n.PP\n" +
                       roff(sentence(command.get_description())) + "\n";
    std::string elsewhere;
    for (const OptionGroup& group : option_groups(command)) {
        if (is_shared(groups, group)) {
            elsewhere += (elsewhere.empty() ? "" : ", ") + group.title;
        } else {
            page += text_of(group);
        }
    }
    if (!elsewhere.empty()) {
        page += ".PP\nOptions described below: " + roff(elsewhere) + ".\n";
    }
    for (const FooterPart& part : footer_parts(command)) {
        page += ".PP\n" + roff(part.title) + ":\n.PP\n.nf\n";
        for (const std::string& line : part.lines) page += roff(line) + "\n";
        page += ".fi\n";
    }
    return page;
}

}  // namespace

std::string manual_page(const CLI::App& program, const std::string& version) {
    const auto commands = listed_commands(program);
    const auto groups = shared_groups(commands);
    std::string page = ".TH NESTGRID 1 \"" + today() + "\" \"nestgrid " + version +
                       "\" \"User Commands\"\n"
                       ".SH NAME\nnestgrid \\- " +
                       roff(program.get_description()) + "\n.SH SYNOPSIS\n.B " +
                       roff(usage_line(program, "nestgrid")) + "\n.SH COMMANDS\n";
    for (const CLI::App* command : commands) page += command_section(*command, groups);
    page += ".SH OPTIONS OF SEVERAL COMMANDS\n";
    for (const SharedGroup& group : groups) {
        std::string names;
        for (const std::string& name : group.commands) names += (names.empty() ? "" : ", ") + name;
        page += ".SS " + group.title + "\nOf " + roff(names) + ".\n" + group.text;
    }
    page +=
        ".SH EXIT STATUS\n"
        ".TP\n.B 0\nThe command has done its work.\n"
        ".TP\n.B 1\nIt could not; one sentence on standard error says why, and no file was "
        "written.\n"
        ".TP\n.B 2\nThe command line makes no sense.\n";
    return page;
}
