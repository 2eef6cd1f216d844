// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "help.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <sstream>

namespace {

using Lines = std::vector<std::string>;

constexpr std::size_t most_lines = 45;
constexpr std::size_t left_column = 26;

std::size_t columns() {
    winsize size{};
    if (isatty(STDOUT_FILENO) != 1 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 80;
    return std::clamp<std::size_t>(size.ws_col == 0 ? 80 : size.ws_col, 40, 100);
}

/// Breaks a text between words.
/// \param first what the first line begins with; the others are indented by as many blanks as
///        `indent`
Lines wrapped(const std::string& first, const std::string& text, std::size_t indent,
              std::size_t width) {
    Lines lines;
    std::string line = first;
    bool empty = true;
    std::istringstream words(text);
    for (std::string word; words >> word; empty = false) {
        if (!empty && line.size() + 1 + word.size() > width) {
            lines.push_back(line);
            line = std::string(indent, ' ');
            empty = true;
        }
        line += (empty ? "" : " ") + word;
    }
    lines.push_back(line);
    return lines;
}

void append(Lines& to, const Lines& lines) { to.insert(to.end(), lines.begin(), lines.end()); }

/// A term on the left, what it means on the right, or below where the term is long.
Lines entry(const std::string& term, const std::string& meaning, std::size_t width) {
    std::string left = "  " + term;
    if (left.size() + 2 <= left_column) {
        left.resize(left_column, ' ');
        return wrapped(left, meaning, left_column, width);
    }
    Lines lines{left};
    append(lines, wrapped(std::string(left_column, ' '), meaning, left_column, width));
    return lines;
}

Lines described(const OptionGroup& group, std::size_t width) {
    Lines lines{"", group.title + ":"};
    for (const OptionText& o : group.options) {
        append(lines, entry(o.usage(), o.description, width));
    }
    return lines;
}

Lines named(const OptionGroup& group, std::size_t width) {
    std::string names;
    for (const OptionText& o : group.options) {
        for (const std::string& name : o.names) {
            if (name.starts_with("--") || &name == &o.names.back()) names += name + " ";
        }
    }
    return entry(group.title, names, width);
}

std::size_t rows(const std::vector<Lines>& parts) {
    std::size_t count = 0;
    for (const Lines& part : parts) count += part.size();
    return count;
}

/// Describes groups as long as there are lines, and names the others.
Lines fitted(const std::vector<OptionGroup>& groups, const std::string& command, std::size_t used,
             std::size_t width, bool all) {
    std::vector<Lines> full;
    std::vector<Lines> short_form;
    for (const OptionGroup& group : groups) {
        full.push_back(described(group, width));
        short_form.push_back(named(group, width));
    }
    Lines result;
    if (all || used + rows(full) <= most_lines) {
        for (const Lines& lines : full) append(result, lines);
        return result;
    }
    const Lines heading{"", "More options, described by '" + command + " --help-all':"};
    std::size_t total = used + heading.size() + rows(short_form);
    Lines folded = heading;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const std::size_t more = total + full[i].size() - short_form[i].size();
        if (more <= most_lines) {
            append(result, full[i]);
            total = more;
        } else {
            append(folded, short_form[i]);
        }
    }
    append(result, folded);
    return result;
}

class Help final : public CLI::FormatterBase {
public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override {
        const std::size_t width = columns();
        const bool all = mode == CLI::AppFormatMode::All;
        Lines lines = wrapped("Usage: ", usage_line(*app, name), 7, width);
        lines.emplace_back();
        append(lines, wrapped("", sentence(app->get_description()), 0, width));
        for (const FooterPart& part : footer_parts(*app)) {
            if (part.title == "Prints") {
                for (const std::string& line : part.lines)
                    append(lines, wrapped("", line, 0, width));
                continue;
            }
            if (!all && part.title != "Examples") continue;
            lines.emplace_back();
            lines.push_back(part.title + ":");
            append(lines, part.lines);
        }
        const auto commands = listed_commands(*app);
        if (!commands.empty()) append(lines, {"", "Commands:"});
        for (const CLI::App* command : commands) {
            append(lines, entry(command->get_name(), command->get_description(), width));
        }
        append(lines, fitted(option_groups(*app), name, lines.size(), width, all));
        std::string text;
        for (const std::string& line : lines) text += line + "\n";
        return text;
    }
};

/// The words of a check like "{red,green}" behind the name of a type.
std::vector<std::string> choices_in(const std::string& type) {
    const std::size_t open = type.find('{');
    const std::size_t close = type.find('}');
    if (open == std::string::npos || close == std::string::npos) return {};
    return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

OptionText text_of(const CLI::Option& option) {
    OptionText text{.option = &option, .positional = option.get_positional()};
    for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
    if (text.positional) text.names.push_back(option.get_name(true, false));
    const std::string type = option.get_type_name();
    text.choices = choices_in(type);
    const bool takes = !text.positional && option.get_type_size_max() != 0;
    if (takes) text.value = type.substr(0, type.find(':'));
    text.description = option.get_description();
    const std::string standard = option.get_default_str();
    if (!standard.empty()) text.description += " [" + standard + "]";
    return text;
}

}  // namespace

std::string OptionText::usage() const {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
    return value.empty() ? text : text + " " + value;
}

std::string sentence(std::string description) {
    if (!description.empty()) description[0] = static_cast<char>(std::toupper(description[0]));
    return description + ".";
}

std::vector<OptionGroup> option_groups(const CLI::App& command) {
    std::vector<OptionGroup> groups;
    const auto group_called = [&](const std::string& title) -> OptionGroup& {
        const auto found = std::ranges::find(groups, title, &OptionGroup::title);
        return found != groups.end() ? *found : groups.emplace_back(title);
    };
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_group().empty() && option->get_positional()) {
            group_called("Options").options.push_back(text_of(*option));
        }
    }
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_group().empty() || option->get_positional()) continue;
        group_called(option->get_group()).options.push_back(text_of(*option));
    }
    std::ranges::stable_partition(groups, [](const auto& g) { return g.title == "Options"; });
    std::ranges::stable_partition(groups, [](const auto& g) { return g.title != "Further"; });
    return groups;
}

std::vector<const CLI::App*> listed_commands(const CLI::App& program) {
    return program.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); });
}

std::string usage_line(const CLI::App& command, const std::string& name) {
    std::string usage = name;
    if (!listed_commands(command).empty()) usage += " COMMAND";
    for (const OptionGroup& group : option_groups(command)) {
        for (const OptionText& o : group.options) {
            const bool several = o.option->get_expected_max() > 1;
            const std::string word = o.positional ? o.names.back() + (several ? "..." : "")
                                                  : o.names.back() + " " + o.value;
            if (o.option->get_required()) usage += " " + word;
            if (o.positional && !o.option->get_required()) usage += " [" + word + "]";
        }
    }
    return usage + " [OPTIONS]";
}

std::vector<FooterPart> footer_parts(const CLI::App& command) {
    std::vector<FooterPart> parts;
    std::istringstream text(command.get_footer());
    for (std::string line; std::getline(text, line);) {
        if (line.ends_with(':') && !line.starts_with(' ')) {
            parts.push_back({line.substr(0, line.size() - 1), {}});
        } else if (!line.empty() && !parts.empty()) {
            parts.back().lines.push_back(line);
        }
    }
    return parts;
}

void set_help(CLI::App& program) {
    program.formatter(std::make_shared<Help>());
    program.set_help_flag("-h,--help", "print the help on the most important options");
    program.set_help_all_flag("--help-all", "print the help on all options");
}
