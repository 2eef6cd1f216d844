// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a command has to say on standard output, once it has done its work.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// A number that is printed for people with so many digits.
struct Digits {
    double number;
    int digits;
};

/// A number, a text, numbers, or nothing: "-" or null.
using Cell =
    std::variant<std::monostate, std::uint64_t, double, Digits, std::string, std::vector<double>>;

/// One row of a table: cells with the names of their columns.
class Row {
public:
    Row& add(std::string column, Cell cell) {
        cells_.emplace_back(std::move(column), std::move(cell));
        return *this;
    }
    Row& append(const Row& more) {
        cells_.insert(cells_.end(), more.cells_.begin(), more.cells_.end());
        return *this;
    }
    const std::vector<std::pair<std::string, Cell>>& cells() const { return cells_; }

private:
    std::vector<std::pair<std::string, Cell>> cells_;
};

/// Facts, tables, sentences and the names of the files that were written, in this order: for people
/// as lines and columns, or as one JSON document.
class Report {
public:
    /// \param json whether print() writes JSON; looked at whenever it is needed
    explicit Report(const bool& json) : json_{json} {}

    bool json() const { return json_; }
    /// Adds a fact: one line, a key of the document.
    void add(const std::string& name, Cell cell) { facts_.add(name, std::move(cell)); }
    /// Adds a row to a table, which begins with the first one. In the document, a table is a list
    /// of objects. A table that is too wide for 80 columns goes on below, with its first columns
    /// again.
    /// \param keys how many columns come again
    void add_row(const std::string& table, Row row, std::size_t keys = 1);
    /// Adds a sentence.
    void say(std::string sentence) { notes_.push_back(std::move(sentence)); }
    /// Adds the line of a file that was written.
    /// \param what it holds: "triangles" and how many
    void wrote(const std::filesystem::path& path,
               std::vector<std::pair<std::string, std::uint64_t>> what);
    void wrote(const std::filesystem::path& path,
               std::vector<std::pair<std::string, std::uint64_t>> what, std::uint64_t bytes);
    /// Has everything printed to standard error, because a file goes to standard output.
    void leave_standard_output() { to_ = stderr; }
    /// Prints everything, once.
    void print();

private:
    struct Table {
        std::string name;
        std::size_t keys = 1;
        std::vector<Row> rows;
    };
    struct File {
        std::string path;
        std::vector<std::pair<std::string, std::uint64_t>> what;
        std::uint64_t bytes = 0;
    };

    void print_text() const;
    void print_json() const;

    const bool& json_;
    std::FILE* to_ = stdout;
    bool printed_ = false;
    Row facts_;
    std::vector<Table> tables_;
    std::vector<std::string> notes_;
    std::vector<File> files_;
};

/// Numbers with so many digits that different ones have different texts, at least six where they
/// have as many.
std::vector<std::string> distinct_texts(const std::vector<double>& numbers);

/// 57120 as "57,120".
std::string grouped(std::uint64_t number);
