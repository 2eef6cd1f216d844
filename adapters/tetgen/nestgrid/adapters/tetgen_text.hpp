// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The lines of TetGen's text files, as numbers; included by tetgen_files.hpp.
#pragma once

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include <nestgrid/adapters/coarse.hpp>

namespace nestgrid::detail {

class TetgenText {
public:
    using Row = std::vector<double>;

    explicit TetgenText(const std::string& path) : path_{path}, file_{path, std::ios::ate} {
        if (!file_) throw IoError("'" + path + "' cannot be opened");
        bytes_ = file_.tellg();
        file_.seekg(0);
    }

    /// The next line that is no comment, continued on further lines up to `least` numbers; `what`
    /// is said where the file ends before.
    Row row(const std::string& what, std::size_t least = 1) {
        Row numbers;
        read_row(numbers, what, least);
        return numbers;
    }
    void read_row(Row& numbers, const std::string& what, std::size_t least) {
        std::string text;
        while (numbers.size() < least) {
            if (!std::getline(file_, text)) {
                if (line_ == 0) throw IoError("'" + path_ + "' is empty");
                throw IoError("'" + path_ + "' is truncated: " + what + " missing after line " +
                              std::to_string(line_));
            }
            ++line_;
            std::istringstream words(text.substr(0, text.find('#')));
            for (std::string word; words >> word;) numbers.push_back(number(word));
        }
    }
    /// The next line, empty at the end of the file.
    Row row_if_any() { return (file_ >> std::ws).eof() ? Row{} : row("a number"); }
    /// Number i of a row, one of `least` ... `most`; `absent` where the row is shorter.
    int integer(const Row& row, std::size_t i, int least, int most, int absent) const {
        if (i >= row.size()) return absent;
        if (!(row[i] >= least && row[i] <= most) || row[i] != std::floor(row[i])) {
            throw error("number " + std::to_string(i + 1) + " must be an integer from " +
                        std::to_string(least) + " to " + std::to_string(most));
        }
        return static_cast<int>(row[i]);
    }
    /// Number i of a row as how many of something follow; each takes two bytes at least.
    int count(const Row& row, std::size_t i, const std::string& what) const {
        const int n = integer(row, i, 0, 0x7FFFFFFF, 0);
        if (n > bytes_ / 2) {
            throw IoError("'" + path_ + "' is truncated: it is too short for " + std::to_string(n) +
                          " " + what);
        }
        return n;
    }
    IoError error(const std::string& what) const {
        IoError result("'" + path_ + "', line " + std::to_string(line_) + ": " + what);
        return result;
    }

private:
    double number(std::string_view word) const {
        const std::string_view digits = word.substr(word.starts_with('+') ? 1 : 0);
        const char* end = digits.data() + digits.size();
        double value = 0;
        const auto [stop, status] = std::from_chars(digits.data(), end, value);
        if (status != std::errc() || stop != end || !std::isfinite(value)) {
            throw error("'" + std::string(word) + "' is no number");
        }
        return value;
    }

    std::string path_;
    std::ifstream file_;
    std::streamoff bytes_ = 0;
    std::size_t line_ = 0;
};

}  // namespace nestgrid::detail
