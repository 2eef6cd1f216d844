// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What OpenMesh's readers do not check, or do not know, of the formats they read; included by
// openmesh_files.hpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace nestgrid::detail {

enum class StlKind { incomplete, text, binary };

/// An STL file is binary if it has 84 bytes and 50 for each of the triangles it declares, and a
/// complete text if its last line starts with "endsolid".
inline StlKind stl_kind(const std::string& content) {
    const bool text = content.compare(content.find_first_not_of(" \t\r\n"), 5, "solid") == 0;
    if (content.size() >= 84) {
        std::uint32_t triangles = 0;
        std::memcpy(&triangles, content.data() + 80, sizeof triangles);
        const std::size_t size = 84 + 50 * std::size_t{triangles};
        if (content.size() == size || (!text && content.size() > size)) return StlKind::binary;
    }
    const std::size_t end = content.find_last_not_of(" \t\r\n");
    const std::size_t line = content.find_last_of('\n', end) + 1;
    const std::size_t word = content.find_first_not_of(" \t", line);
    const bool complete = text && content.compare(word, 8, "endsolid") == 0;
    return complete ? StlKind::text : StlKind::incomplete;
}

/// OpenMesh's reader of .ply believes every word of a header, and looks for its end for ever.
inline bool is_ply_header(const std::string& content) {
    static constexpr std::string_view types =
        " char uchar short ushort int uint float double int8 uint8 int16 uint16 int32 uint32 "
        "float32 float64 ";
    const auto is_type = [](const std::string& word) {
        return types.find(" " + word + " ") != std::string_view::npos;
    };
    const auto is_count = [](const std::string& word) {
        return word.size() < 10 && word.find_first_not_of("0123456789") == std::string::npos;
    };
    std::istringstream lines(content);
    bool has_format = false;
    bool in_element = false;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::vector<std::string> word{std::istream_iterator<std::string>(words), {}};
        if (word.empty()) return false;
        const bool list = word.size() == 5 && word[1] == "list";
        if (word[0] == "end_header") return true;
        if (word[0] == "element") {
            if (!has_format || word.size() != 3 || !is_count(word[2])) return false;
            in_element = true;
        } else if (word[0] == "format") {
            if (has_format || word.size() != 3 || word[2] != "1.0") return false;
            has_format = true;
        } else if (word[0] == "property") {
            if (!in_element || (word.size() != 3 && !list)) return false;
            if (!is_type(word[list ? 2 : 1]) || (list && !is_type(word[3]))) return false;
        } else if (word[0] != "ply" && word[0] != "comment" && word[0] != "obj_info") {
            return false;
        }
    }
    return false;
}

/// OpenMesh's reader of .obj stops the program at a corner without a vertex, as in "f /1 2 3".
inline bool has_only_vertices(const std::string& content) {
    std::istringstream lines(content);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string word;
        if (!(words >> word) || word != "f") continue;
        while (words >> word) {
            if (word[0] == '/') return false;
        }
    }
    return true;
}

/// OpenMesh's reader of .off knows neither comments nor the colours behind the faces of a file
/// whose first word is a plain OFF; without them, such a file means the same.
inline std::string without_extras(const std::string& content) {
    std::istringstream lines(content);
    std::string result;
    std::size_t row = 0;
    std::size_t first_face = 0;
    for (std::string line; std::getline(lines, line);) {
        line.erase(std::min(line.find('#'), line.size()));
        std::istringstream words(line);
        const std::vector<std::string> word{std::istream_iterator<std::string>(words), {}};
        if (word.empty()) continue;
        if (row == 0 && (word.size() > 1 || word[0] != "OFF")) return content;
        if (row == 1) first_face = 2 + std::strtoull(word[0].c_str(), nullptr, 10);
        std::size_t count = word.size();
        if (row > 1 && row >= first_face) {
            count = std::min<std::size_t>(count, 1 + std::strtoull(word[0].c_str(), nullptr, 10));
        }
        for (std::size_t i = 0; i < count; ++i) result += word[i] + " ";
        result.back() = '\n';
        ++row;
    }
    return result;
}

}  // namespace nestgrid::detail
