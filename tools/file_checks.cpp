// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "file_checks.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include <nestgrid/error.hpp>

namespace fs = std::filesystem;
using nestgrid::IoError;

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

void truncated(const fs::path& path, std::uintmax_t found, std::uintmax_t expected) {
    throw IoError(path.string() + " is truncated: " + std::to_string(found) +
                  " bytes, but its header asks for " + std::to_string(expected));
}

std::vector<double> TextHeader::numbers(const std::string& key) const {
    std::vector<double> result;
    const auto at = field.find(key);
    if (at == field.end()) return result;
    std::string text = at->second;
    for (char& c : text) {
        if (c == '(' || c == ')' || c == ',') c = ' ';
    }
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        char* end = nullptr;
        const double number = std::strtod(word.c_str(), &end);
        if (*end == '\0') result.push_back(number);
    }
    return result;
}

std::string TextHeader::value(const std::string& key) const {
    const auto at = field.find(key);
    return at == field.end() ? "" : at->second;
}

TextHeader read_text_header(const fs::path& path, char separator, const std::string& last) {
    std::ifstream file(path, std::ios::binary);
    TextHeader header;
    std::string line;
    const auto trim = [](std::string text) {
        text.erase(text.find_last_not_of(" \t\r=:") + 1);
        return text.erase(0, text.find_first_not_of(" \t=:"));
    };
    for (int i = 0; i < 1000 && std::getline(file, line); ++i) {
        header.length += line.size() + 1;
        header.ended = line.find_first_not_of('\r') == std::string::npos && !file.eof();
        if (header.ended) break;
        const std::size_t at = line.find(separator);
        if (at == std::string::npos) continue;
        const std::string key = trim(lower(line.substr(0, at)));
        header.field[key] = trim(line.substr(at + 1));
        if (key == last) break;
    }
    return header;
}

void check_meta_sizes(const fs::path& path) {
    const TextHeader header = read_text_header(path, '=', "elementdatafile");
    const std::string data = header.value("elementdatafile");
    if (data.empty()) throw IoError(path.string() + " is no MetaImage: it names no data file");
    if (data == "LIST" || data.find('%') != std::string::npos) {
        throw IoError(path.string() + " spreads its samples over several files, which is not read");
    }
    const bool local = lower(data) == "local";
    const fs::path file = local ? path : path.parent_path() / data;
    if (!fs::is_regular_file(file)) {
        throw IoError(path.string() + " names the data file " + file.string() +
                      ", which does not exist");
    }
    const double found = static_cast<double>(fs::file_size(file)) -
                         (local ? static_cast<double>(header.length) : 0.0);
    if (lower(header.value("compresseddata")) == "true") {
        const auto size = header.numbers("compresseddatasize");
        if (size.empty()) {
            throw IoError(path.string() +
                          " is compressed but does not say CompressedDataSize, which is not read");
        }
        if (!(size[0] <= found)) {
            truncated(file, static_cast<std::uintmax_t>(std::max(found, 0.0)),
                      static_cast<std::uintmax_t>(size[0]));
        }
        return;
    }
    static const std::map<std::string, double> bytes{
        {"MET_CHAR", 1},  {"MET_UCHAR", 1},     {"MET_SHORT", 2},      {"MET_USHORT", 2},
        {"MET_INT", 4},   {"MET_UINT", 4},      {"MET_LONG", 4},       {"MET_ULONG", 4},
        {"MET_FLOAT", 4}, {"MET_LONG_LONG", 8}, {"MET_ULONG_LONG", 8}, {"MET_DOUBLE", 8}};
    const auto size = bytes.find(header.value("elementtype"));
    if (size == bytes.end()) {
        throw IoError(path.string() + " has the sample type '" + header.value("elementtype") +
                      "', which is not read");
    }
    double expected = size->second;
    for (const double n : header.numbers("dimsize")) expected *= n;
    if (!(expected <= found)) {
        truncated(file, static_cast<std::uintmax_t>(std::max(found, 0.0)),
                  static_cast<std::uintmax_t>(std::min(expected, 1e18)));
    }
}

std::uintmax_t unpacked_size(const fs::path& path) {
    gzFile file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw IoError(path.string() + " cannot be opened");
    std::vector<char> buffer(1U << 20U);
    std::uintmax_t total = 0;
    int count = 0;
    while ((count = gzread(file, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0) {
        total += static_cast<std::uintmax_t>(count);
    }
    const int error = gzclose(file);
    if (count < 0 || error != Z_OK) {
        throw IoError(path.string() + " is truncated or damaged: it cannot be unpacked to its end");
    }
    return total;
}

std::uintmax_t nifti_offset(const fs::path& path) {
    std::array<char, 352> header{};
    gzFile file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw IoError(path.string() + " cannot be opened");
    const int count = gzread(file, header.data(), header.size());
    gzclose(file);
    if (count < static_cast<int>(header.size())) return header.size();
    const bool swapped = header[0] != 0x5C && header[0] != 0x1C;  // 348 or 540, low byte first
    const auto load = [&]<class Number>(std::size_t at, Number number) {
        std::array<char, sizeof(Number)> bytes{};
        std::copy_n(header.begin() + static_cast<std::ptrdiff_t>(at), bytes.size(), bytes.begin());
        if (swapped) std::reverse(bytes.begin(), bytes.end());
        std::memcpy(&number, bytes.data(), bytes.size());
        return number;
    };
    const bool second = load(0, std::int32_t{}) == 540;
    const double offset =
        second ? static_cast<double>(load(168, std::int64_t{})) : load(108, float{});
    return offset > 0 && offset < 1e12 ? static_cast<std::uintmax_t>(offset) : header.size();
}

void check_xml_end(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const auto size = static_cast<std::streamoff>(fs::file_size(path));
    file.seekg(std::max<std::streamoff>(0, size - 64));
    const std::string tail((std::istreambuf_iterator<char>(file)), {});
    if (tail.find("</VTKFile>") == std::string::npos) {
        throw IoError(path.string() + " is truncated: it does not end with </VTKFile>");
    }
}

void check_nrrd_sizes(const fs::path& path, const TextHeader& header) {
    if (!header.ended) {  // VTK would look for its end for ever
        throw IoError(path.string() +
                      " is truncated or no NRRD file: its header does not "
                      "end");
    }
    if (lower(header.value("encoding")) == "raw" && header.value("data file").empty()) {
        const std::string type = header.value("type");
        double bytes = 1;  // at least
        for (const auto& [name, size] : std::map<std::string, double>{{"short", 2},
                                                                      {"int16", 2},
                                                                      {"int32", 4},
                                                                      {"float", 4},
                                                                      {"double", 8},
                                                                      {"int64", 8},
                                                                      {"long long", 8}}) {
            if (type.find(name) != std::string::npos) bytes = size;
        }
        if (type == "int" || type == "unsigned int" || type == "uint") bytes = 4;
        double expected = bytes;
        for (const double n : header.numbers("sizes")) expected *= n;
        const double found =
            static_cast<double>(fs::file_size(path)) - static_cast<double>(header.length);
        if (!(expected <= found)) {
            truncated(path, static_cast<std::uintmax_t>(std::max(found, 0.0)),
                      static_cast<std::uintmax_t>(std::min(expected, 1e18)));
        }
    }
}
