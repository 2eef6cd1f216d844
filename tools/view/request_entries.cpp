// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "request_entries.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <nestgrid/error.hpp>

namespace nestgrid::view {

namespace {

constexpr std::size_t longest_request = 2000;

/// A text of the request in quotes, cut short, without characters that a terminal obeys.
std::string quoted(std::string_view text) {
    std::string result = "'";
    for (const char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
    return result + (text.size() > 40 ? "...'" : "'");
}

}  // namespace

void refuse(std::string_view key, const std::string& what, std::string_view text) {
    throw InvalidInput(std::string(key) + " is " + what + ": " + quoted(text));
}

/// Finite numbers between commas.
std::vector<double> numbers_of(std::string_view key, std::string_view text, std::size_t count) {
    const std::string what =
        count == 1 ? "no finite number" : "not " + std::to_string(count) + " finite numbers";
    if (text.find_first_not_of("+-.,0123456789eE") != std::string_view::npos) {
        refuse(key, what, text);
    }
    const std::string copy(text);
    const char* at = copy.c_str();
    std::vector<double> numbers;
    while (numbers.size() < count) {
        char* end = nullptr;
        numbers.push_back(std::strtod(at, &end));
        const char expected = numbers.size() == count ? '\0' : ',';
        if (end == at || !std::isfinite(numbers.back()) || *end != expected) {
            refuse(key, what, text);
        }
        at = end + 1;
    }
    return numbers;
}

std::vector<double> number_list_of(std::string_view key, std::string_view text, std::size_t most) {
    const auto commas = static_cast<std::size_t>(std::count(text.begin(), text.end(), ','));
    if (commas >= most) {
        refuse(key, "a list of more than " + std::to_string(most) + " numbers", text);
    }
    return numbers_of(key, text, commas + 1);
}

double number_of(std::string_view key, std::string_view text) {
    return numbers_of(key, text, 1).front();
}

double number_at_least_0(std::string_view key, std::string_view text) {
    const double number = number_of(key, text);
    if (number < 0) refuse(key, "negative", text);
    return number;
}

Entries::Entries(std::string_view text) {
    if (text.size() > longest_request) {
        throw InvalidInput("the request is longer than " + std::to_string(longest_request) +
                           " characters");
    }
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('&'), text.size());
        const std::string_view entry = text.substr(0, end);
        const std::size_t equals = entry.find('=');
        if (equals == std::string_view::npos) {
            throw InvalidInput("the request has " + quoted(entry) + " where key=value is expected");
        }
        const std::string_view key = entry.substr(0, equals);
        if (!values_.emplace(key, entry.substr(equals + 1)).second) {
            throw InvalidInput("the request has " + quoted(key) + " twice");
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

void Entries::require_empty(const std::string& known) const {
    if (values_.empty()) return;
    throw InvalidInput("the request has " + quoted(values_.begin()->first) + ", but knows only " +
                       known);
}

}  // namespace nestgrid::view
