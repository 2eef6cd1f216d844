// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_reply.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace nestgrid::view {

JsonText& JsonText::append(std::string_view value) {
    if (!first_) text_ += ',';
    first_ = false;
    text_ += value;
    return *this;
}

JsonText& JsonText::key(std::string_view name) {
    string(name);
    text_ += ':';
    first_ = true;
    return *this;
}

JsonText& JsonText::string(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            quoted += '\\';
            quoted += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            std::array<char, 8> code{};
            std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(c));
            quoted += code.data();
        } else {
            quoted += c;
        }
    }
    return append(quoted + '"');
}

JsonText& JsonText::number(double x) {
    if (!std::isfinite(x)) return append("null");
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), "%.17g", x);
    return append(digits.data());
}

JsonText& JsonText::boolean(bool x) { return append(x ? "true" : "false"); }

JsonText& JsonText::numbers(std::span<const double> list) {
    open('[');
    for (const double x : list) number(x);
    return close(']');
}

JsonText& JsonText::open(char bracket) {
    append(std::string_view(&bracket, 1));
    first_ = true;
    return *this;
}

JsonText& JsonText::close(char bracket) {
    text_ += bracket;
    first_ = false;
    return *this;
}

std::vector<std::byte> FrameReply::bytes() const {
    std::string text = header.text();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto length = static_cast<std::uint32_t>(text.size());
    std::vector<std::byte> result(sizeof length + text.size() + 4 * arrays_.size());
    std::memcpy(result.data(), &length, sizeof length);
    std::memcpy(result.data() + sizeof length, text.data(), text.size());
    if (!arrays_.empty()) {
        std::memcpy(result.data() + sizeof length + text.size(), arrays_.data(),
                    4 * arrays_.size());
    }
    return result;
}

}  // namespace nestgrid::view
