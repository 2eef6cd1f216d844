// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The text of a request, key=value between &, and the values in it.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace nestgrid::view {

/// \throw InvalidInput "KEY is WHAT: 'TEXT'"
[[noreturn]] void refuse(std::string_view key, const std::string& what, std::string_view text);

/// Finite numbers between commas.
/// \throw InvalidInput where they are not so many
std::vector<double> numbers_of(std::string_view key, std::string_view text, std::size_t count);
/// Any number of them, from one to \p most.
std::vector<double> number_list_of(std::string_view key, std::string_view text, std::size_t most);
double number_of(std::string_view key, std::string_view text);
double number_at_least_0(std::string_view key, std::string_view text);

template <class Value>
struct Choice {
    const char* name;
    Value value;
};

/// \throw InvalidInput where the text is the name of no choice
template <class Value, std::size_t count>
Value choice_of(std::string_view key, std::string_view text,
                const std::array<Choice<Value>, count>& choices) {
    std::string names;
    for (const Choice<Value>& choice : choices) {
        if (text == choice.name) return choice.value;
        names += (names.empty() ? "" : ", ") + std::string(choice.name);
    }
    refuse(key, "none of " + names, text);
}

/// The keys and values of a request; each is asked for once.
class Entries {
public:
    /// \throw InvalidInput where the text is too long, no list of entries, or has a key twice
    explicit Entries(std::string_view text);

    /// Calls take(key, text) with the value of a key, where there is one.
    template <class Take>
    bool take(const char* key, Take&& take) {
        const auto found = values_.find(key);
        if (found == values_.end()) return false;
        take(std::string_view(key), found->second);
        values_.erase(found);
        return true;
    }
    /// \param known the keys there are, for readers
    /// \throw InvalidInput where a key is left that nobody took
    void require_empty(const std::string& known) const;

private:
    std::map<std::string_view, std::string_view> values_;
};

}  // namespace nestgrid::view
