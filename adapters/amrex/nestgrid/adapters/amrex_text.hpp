// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <nestgrid/error.hpp>

namespace nestgrid::detail {

/// Cells, in up to three dimensions; the others have 0 to 0.
struct AmrexBox {
    std::array<int, 3> lower{};
    std::array<int, 3> upper{};
};

/// Reads the texts of a plotfile, word after word, and refuses what is none of them with the place.
class AmrexText {
public:
    /// \param name of what the text is, for sentences
    /// \param text that outlives this object
    AmrexText(std::string name, std::string_view text) : name_{std::move(name)}, text_{text} {}

    std::size_t left() const { return text_.size() - at_; }
    std::size_t place() const { return at_; }

    [[noreturn]] void fail(const std::string& what) const {
        const auto lines = std::count(text_.begin(), text_.end(), '\n');
        const auto before =
            std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
        const std::string place = lines == 0 ? "" : ", line " + std::to_string(1 + before);
        throw IoError(name_ + place + ": " + what);
    }
    /// The rest of the line, without blanks at its end.
    std::string_view line(const char* what) {
        if (left() == 0) fail(std::string("the file ends before ") + what);
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        const std::string_view rest = text_.substr(at_, end - at_);
        at_ = std::min(end + 1, text_.size());
        return rest.substr(0, rest.find_last_not_of(" \t\r") + 1);
    }
    std::int64_t integer(const char* what, std::int64_t least, std::int64_t most) {
        const auto value = number<std::int64_t>(what);
        if (value < least || value > most) {
            fail(std::string(what) + " is " + std::to_string(value) + ", not from " +
                 std::to_string(least) + " to " + std::to_string(most));
        }
        return value;
    }
    /// How many things follow that take some characters each.
    std::size_t count(const char* what, std::size_t characters) {
        return static_cast<std::size_t>(
            integer(what, 0, static_cast<std::int64_t>(left() / characters)));
    }
    double real(const char* what) {
        const auto value = number<double>(what);
        if (!std::isfinite(value)) fail(std::string(what) + " is not finite");
        return value;
    }
    std::string_view word(const char* what) {
        skip_blanks();
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
        if (end == at_) fail(std::string(what) + " is missing");
        const std::string_view word = text_.substr(at_, end - at_);
        at_ = end;
        return word;
    }
    bool has_next(char c) {
        skip_blanks();
        return at_ < text_.size() && text_[at_] == c;
    }
    /// Whether nothing but blanks is left.
    bool is_at_end() {
        skip_blanks();
        return left() == 0;
    }
    /// To the next c, or to the end.
    void skip_to(char c) { at_ = std::min(text_.find(c, at_), text_.size()); }
    void expect(char c, const char* what) {
        if (!has_next(c)) fail(std::string(what) + ": '" + c + "' is missing");
        ++at_;
    }
    /// A box of cells, such as ((0,0,0) (7,7,7) (0,0,0)).
    AmrexBox box(std::size_t dim) {
        AmrexBox result;
        expect('(', "a box");
        result.lower = place_of(dim);
        result.upper = place_of(dim);
        if (has_next('(') && place_of(dim) != std::array<int, 3>{}) {
            fail("a box is one of nodes or faces, not of cells");
        }
        expect(')', "a box");
        for (std::size_t d = 0; d < dim; ++d) {
            if (result.lower[d] > result.upper[d]) fail("a box is empty");
        }
        return result;
    }
    std::array<int, 3> place_of(std::size_t dim) {
        constexpr std::int64_t most = 1 << 30;
        std::array<int, 3> place{};
        expect('(', "a place");
        for (std::size_t d = 0; d < dim; ++d) {
            if (d > 0) expect(',', "a place");
            place[d] = static_cast<int>(integer("a coordinate of a box", -most, most));
        }
        expect(')', "a place");
        return place;
    }

private:
    void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
    template <class Number>
    Number number(const char* what) {
        skip_blanks();
        Number value{};
        const char* const begin = text_.data() + at_;
        const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (error != std::errc{}) fail(std::string(what) + " is no number");
        at_ += static_cast<std::size_t>(end - begin);
        return value;
    }

    std::string name_;
    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace nestgrid::detail
