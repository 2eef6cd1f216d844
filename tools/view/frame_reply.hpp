// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A frame as bytes, which a page reads without a copy. All numbers are little-endian:
//     uint32 length of the text in bytes, a multiple of 4
//     text   JSON, filled up with spaces; it names arrays by type, first byte behind the text,
//     count arrays each at a multiple of 4 bytes
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nestgrid::view {

/// Text in the syntax of JSON.
class JsonText {
public:
    JsonText& key(std::string_view name);
    JsonText& string(std::string_view text);
    /// A number of 17 digits; null where it is not finite.
    JsonText& number(double x);
    JsonText& boolean(bool x);
    JsonText& numbers(std::span<const double> list);
    JsonText& open(char bracket);
    JsonText& close(char bracket);
    const std::string& text() const { return text_; }

private:
    JsonText& append(std::string_view value);

    std::string text_;
    bool first_ = true;  // within its bracket, or behind a key
};

/// Collects a text and arrays.
class FrameReply {
public:
    JsonText header;

    /// Adds a member to the header, {"type": ..., "at": byte, "count": numbers}, and room for an
    /// array.
    /// \param type int8, uint32 or float32
    /// \return the room, of so many numbers, until the next array is added
    template <class Number>
    std::span<Number> array(std::string_view name, std::string_view type, std::size_t count) {
        const std::size_t at = arrays_.size();
        const std::size_t words = (count * sizeof(Number) + 3) / 4;
        arrays_.resize(at + words);
        header.key(name).open('{').key("type").string(type);
        header.key("at").number(static_cast<double>(4 * at));
        header.key("count").number(static_cast<double>(count)).close('}');
        return {reinterpret_cast<Number*>(arrays_.data() + at), count};
    }
    /// \return the frame, whose header is closed
    std::vector<std::byte> bytes() const;

private:
    std::vector<std::uint32_t> arrays_;
};

}  // namespace nestgrid::view
