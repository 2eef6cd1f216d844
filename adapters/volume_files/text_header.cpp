// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "text_header.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <nestgrid/error.hpp>

namespace {

namespace fs = std::filesystem;
using nestgrid::IoError;

std::string trimmed(std::string text) {
    text.erase(text.find_last_not_of(" \t\r=:") + 1);
    return text.erase(0, text.find_first_not_of(" \t=:"));
}

/// The names in the lines behind a header.
std::vector<std::string> names_behind(const TextHeader& header) {
    std::ifstream file(header.path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(header.length));
    std::vector<std::string> names;
    for (std::string line; std::getline(file, line);) {
        if (!trimmed(line).empty()) names.push_back(trimmed(line));
    }
    return names;
}

/// The names that a pattern stands for; empty where it is none.
std::vector<std::string> names_of_pattern(const std::string& text) {
    const std::size_t start = text.find('%');
    const std::size_t stop = text.find_first_not_of("0123456789", start + 1);
    if (stop == std::string::npos || text[stop] != 'd') return {};
    const std::string width = text.substr(start + 1, stop - start - 1);
    const std::size_t behind = std::min(text.find_first_of(" \t", stop), text.size());
    const std::string tail = text.substr(stop + 1, behind - stop - 1);
    std::istringstream numbers(text.substr(behind));
    int first = 0;
    int last = 0;
    int step = 1;
    if (!(numbers >> first >> last) || width.size() > 2) return {};
    numbers >> step;
    if (first < 0 || last < first || last > 1000000 || step < 1) return {};
    const auto digits = static_cast<std::size_t>(width.empty() ? 0 : std::stoi(width));
    std::vector<std::string> names;
    for (int i = first; i <= last; i += step) {
        std::string number = std::to_string(i);
        if (number.size() < digits) {
            number.insert(0, digits - number.size(), width[0] == '0' ? '0' : ' ');
        }
        names.push_back(text.substr(0, start) + number + tail);
    }
    return names;
}

}  // namespace

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::vector<double> TextHeader::numbers(const std::string& key) const {
    std::vector<double> result;
    std::string text = value(key);
    for (char& c : text) {
        if (c == '(' || c == ')' || c == ',') c = ' ';
    }
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        char* end = nullptr;
        result.push_back(std::strtod(word.c_str(), &end));
        if (*end == '\0') continue;
        throw IoError(path.string() + " has " + described(key) + ", of which '" + word +
                      "' is no number");
    }
    return result;
}

std::vector<double> TextHeader::numbers(const std::string& key, std::size_t count) const {
    std::vector<double> result = numbers(key);
    if (result.empty() || result.size() == count) return result;
    throw IoError(path.string() + " has " + described(key) + ", not " + std::to_string(count) +
                  (count == 1 ? " number" : " numbers"));
}

std::string TextHeader::described(const std::string& key) const {
    const auto spelled = spelling.find(key);
    return "the " + (spelled == spelling.end() ? key : spelled->second) + " '" + value(key) + "'";
}

std::string TextHeader::value(const std::string& key) const {
    const auto at = field.find(key);
    return at == field.end() ? "" : at->second;
}

TextHeader read_text_header(const fs::path& path, char separator, const std::string& last,
                            const std::string& last_value) {
    std::ifstream file(path, std::ios::binary);
    TextHeader header;
    header.path = path;
    std::string line;
    for (int i = 0; i < 1000 && !header.ended && std::getline(file, line); ++i) {
        header.length += line.size() + (file.eof() ? 0 : 1);
        header.ended = line.find_first_not_of('\r') == std::string::npos && !file.eof();
        const std::size_t at = line.find(separator);
        // NRRD writes comments behind # and what users add as key:=value.
        if (at == std::string::npos || line[0] == '#' || line.compare(at, 2, ":=") == 0) continue;
        const std::string key = trimmed(lower(line.substr(0, at)));
        header.field[key] = trimmed(line.substr(at + 1));
        header.spelling[key] = trimmed(line.substr(0, at));
        header.ended = key == last && header.field[key].starts_with(last_value);
    }
    return header;
}

std::vector<fs::path> data_files(const TextHeader& header, const std::string& names) {
    std::vector<std::string> list{names};
    if (names.starts_with("LIST")) {
        list = names_behind(header);
    } else if (names.find('%') != std::string::npos) {
        list = names_of_pattern(names);
    }
    if (list.empty()) {
        throw IoError(header.path.string() + " names no data files by '" + names + "'");
    }
    std::vector<fs::path> files;
    for (const std::string& name : list) {
        files.push_back(header.path.parent_path() / name);
        if (!fs::is_regular_file(files.back())) {
            throw IoError(header.path.string() + " names the data file " + files.back().string() +
                          ", which does not exist");
        }
    }
    return files;
}
