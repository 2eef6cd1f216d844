// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include <json/value.h>
#include <json/writer.h>

namespace {

constexpr std::size_t most_columns = 80;

std::string formatted(const char* format, double number) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), format, number);
    return text.data();
}

std::string text_of(const Cell& cell) {
    if (std::holds_alternative<std::monostate>(cell)) return "-";
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return std::to_string(*count);
    if (const auto* number = std::get_if<double>(&cell)) return formatted("%.6g", *number);
    if (const auto* exact = std::get_if<Digits>(&cell)) {
        std::array<char, 40> text{};
        std::snprintf(text.data(), text.size(), "%.*g", exact->digits, exact->number);
        return text.data();
    }
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    std::string list;
    for (const double number : std::get<std::vector<double>>(cell)) {
        list += (list.empty() ? "" : " ") + formatted("%.9g", number);
    }
    return list;
}

/// JSON has no infinities: they are null.
Json::Value json_of(double number) {
    return std::isfinite(number) ? Json::Value(number) : Json::Value();
}

Json::Value json_of(const Cell& cell) {
    if (std::holds_alternative<std::monostate>(cell)) return {};
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return Json::UInt64{*count};
    if (const auto* number = std::get_if<double>(&cell)) return json_of(*number);
    if (const auto* exact = std::get_if<Digits>(&cell)) return json_of(exact->number);
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    Json::Value list(Json::arrayValue);
    for (const double number : std::get<std::vector<double>>(cell)) list.append(json_of(number));
    return list;
}

Json::Value json_of(const Row& row) {
    Json::Value object(Json::objectValue);
    for (const auto& [name, cell] : row.cells()) object[name] = json_of(cell);
    return object;
}

const Cell* cell_in(const Row& row, const std::string& column) {
    for (const auto& [name, cell] : row.cells()) {
        if (name == column) return &cell;
    }
    return nullptr;
}

/// One column, below its name; a row that has no such cell has a dash there.
std::vector<std::string> column_of(const std::vector<Row>& rows, const std::string& name) {
    std::vector<std::string> texts{name};
    bool words = true;
    for (const Row& row : rows) {
        const Cell* const cell = cell_in(row, name);
        words = words && cell != nullptr && std::holds_alternative<std::string>(*cell);
        texts.push_back(cell == nullptr ? "-" : text_of(*cell));
    }
    std::size_t width = 0;
    for (const std::string& text : texts) width = std::max(width, text.size());
    // Words begin below each other, numbers end so.
    for (std::string& text : texts) {
        text.insert(words ? text.size() : 0, width - text.size(), ' ');
    }
    return texts;
}

void print_columns(const std::vector<std::vector<std::string>>& columns, std::FILE* to) {
    std::fprintf(to, "\n");
    for (std::size_t line = 0; line < columns.front().size(); ++line) {
        std::string text;
        for (const auto& column : columns) text += (text.empty() ? "" : "  ") + column[line];
        text.erase(text.find_last_not_of(' ') + 1);
        std::fprintf(to, "%s\n", text.c_str());
    }
}

void print_table(const std::vector<Row>& rows, std::size_t keys, std::FILE* to) {
    std::vector<std::string> names;
    for (const Row& row : rows) {
        for (const auto& [name, cell] : row.cells()) {
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
        }
    }
    std::vector<std::vector<std::string>> block;
    std::size_t width = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        std::vector<std::string> column = column_of(rows, names[i]);
        if (i > keys && width + 2 + column.front().size() > most_columns) {
            print_columns(block, to);
            block.resize(keys);
            width = 0;
            for (const auto& key : block) width += key.front().size() + 2;
        }
        width += column.front().size() + (block.empty() ? 0 : 2);
        block.push_back(std::move(column));
    }
    print_columns(block, to);
}

/// "3.1 MB"
std::string size_text(std::uint64_t bytes) {
    constexpr std::array units{"bytes", "kB", "MB", "GB", "TB"};
    auto number = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (number >= 1000 && unit + 1 < units.size()) {
        number /= 1000;
        ++unit;
    }
    return formatted(unit == 0 || number >= 100 ? "%.0f " : "%.1f ", number) + units[unit];
}

}  // namespace

std::vector<std::string> distinct_texts(const std::vector<double>& numbers) {
    std::vector<std::string> texts;
    for (const char* format : {"%.6g", "%.9g", "%.17g"}) {
        texts.clear();
        for (const double number : numbers) texts.push_back(formatted(format, number));
        const std::set<double> different(numbers.begin(), numbers.end());
        if (std::set(texts.begin(), texts.end()).size() == different.size()) break;
    }
    return texts;
}

std::string grouped(std::uint64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
    return text;
}

void Report::add_row(const std::string& table, Row row, std::size_t keys) {
    auto found = std::ranges::find(tables_, table, &Table::name);
    if (found == tables_.end()) found = tables_.insert(found, {table, keys, {}});
    found->rows.push_back(std::move(row));
}

void Report::wrote(const std::filesystem::path& path,
                   std::vector<std::pair<std::string, std::uint64_t>> what) {
    std::error_code none;
    const std::uintmax_t bytes = std::filesystem::file_size(path, none);
    wrote(path, std::move(what), none ? 0 : bytes);
}

void Report::wrote(const std::filesystem::path& path,
                   std::vector<std::pair<std::string, std::uint64_t>> what, std::uint64_t bytes) {
    files_.push_back({path.string(), std::move(what), bytes});
}

void Report::print_text() const {
    for (const auto& [name, cell] : facts_.cells()) {
        std::fprintf(to_, "%-22s %s\n", name.c_str(), text_of(cell).c_str());
    }
    for (const Table& table : tables_) print_table(table.rows, table.keys, to_);
    if (!tables_.empty() && !(notes_.empty() && files_.empty())) std::fprintf(to_, "\n");
    for (const std::string& note : notes_) std::fprintf(to_, "%s\n", note.c_str());
    for (const File& file : files_) {
        std::string what;
        for (const auto& [name, count] : file.what) what += grouped(count) + " " + name + ", ";
        std::fprintf(to_, "wrote %s (%s%s)\n", file.path.c_str(), what.c_str(),
                     size_text(file.bytes).c_str());
    }
}

void Report::print_json() const {
    Json::Value document = json_of(facts_);
    for (const Table& table : tables_) {
        Json::Value& list = document[table.name] = Json::Value(Json::arrayValue);
        for (const Row& row : table.rows) list.append(json_of(row));
    }
    Json::Value& notes = document["notes"] = Json::Value(Json::arrayValue);
    for (const std::string& note : notes_) notes.append(note);
    Json::Value& files = document["files"] = Json::Value(Json::arrayValue);
    for (const File& file : files_) {
        Json::Value entry(Json::objectValue);
        entry["path"] = file.path;
        entry["bytes"] = Json::UInt64{file.bytes};
        for (const auto& [name, count] : file.what) entry[name] = Json::UInt64{count};
        files.append(entry);
    }
    Json::StreamWriterBuilder builder;
    builder["indentation"] = "  ";
    std::fprintf(to_, "%s\n", Json::writeString(builder, document).c_str());
}

void Report::print() {
    if (!printed_) json_ ? print_json() : print_text();
    std::fflush(to_);
    printed_ = true;
}
