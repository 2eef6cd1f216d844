// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Corrections of surface files before CGAL parses them: variants that its readers misread, and
// headers that they do not check. Included by cgal_files.hpp.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <nestgrid/error.hpp>

namespace nestgrid::detail {

/// A file as CGAL is given it, and how much it must find there.
struct SurfaceText {
    std::string content{};
    std::optional<std::size_t> vertices{};  ///< that the file declares
    std::optional<std::size_t> faces{};
};

inline std::vector<std::string> words_of(const std::string& line) {
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
}

inline std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// \throw IoError unless the text is that of a number of things
inline std::size_t count_in(const std::string& text, const std::string& name) {
    const bool digits = !text.empty() && text.size() < 19 &&
                        text.find_first_not_of("0123456789") == std::string::npos;
    if (!digits) {
        throw IoError(name + " has no complete header: '" + text.substr(0, 20) + "' is no count");
    }
    return std::stoull(text);
}

/// CGAL wants the keyword of an .off in a line of its own and three counts; in many files the
/// keyword is missing or joined to the first count, and the count of edges is left out.
inline SurfaceText off_text(const std::string& content, const std::string& name) {
    std::istringstream lines(content);
    std::vector<std::string> head;
    std::string keyword;
    std::size_t counts = 0;
    const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    while (counts == 0 || head.size() < counts) {
        std::string line;
        if (!std::getline(lines, line)) throw IoError(name + " has no complete header");
        line.erase(std::min(line.find('#'), line.size()));
        std::vector<std::string> words = words_of(line);
        if (words.empty()) continue;
        if (keyword.empty()) {
            // 4OFF and nOFF have points of other dimensions.
            const std::string& first = words.front();
            const std::size_t four = first.starts_with('4') && first.size() > 1 ? 1 : 0;
            const auto end = std::find_if_not(first.begin() + static_cast<std::ptrdiff_t>(four),
                                              first.end(), is_letter);
            keyword = std::string(first.begin(), end);
            if (keyword == "4") keyword.clear();
            if (keyword.find_first_of("4n") != std::string::npos) {
                throw InvalidInput(name + " has points of other dimensions than three (" + keyword +
                                   ")");
            }
            if (!keyword.empty() && !keyword.ends_with("OFF")) {
                throw IoError(name + " has no complete header of the format .off");
            }
            words.front().erase(0, keyword.size());
            if (words.front().empty()) words.erase(words.begin());
            if (keyword.empty()) keyword = "OFF";
            if (words.empty()) continue;
            if (words.front() == "BINARY") {
                throw InvalidInput(name + " is a binary .off, which is not read: save it as text");
            }
        }
        head.insert(head.end(), words.begin(), words.end());
        if (counts == 0) counts = head.size() == 2 ? 2 : 3;
    }
    SurfaceText text;
    text.vertices = count_in(head[0], name);
    text.faces = count_in(head[1], name);
    text.content = keyword + "\n" + head[0] + " " + head[1] + " 0\n";
    if (head.size() > 3) throw IoError(name + " has more than counts in its header");
    const auto rest = lines.tellg();
    if (rest != std::istringstream::pos_type(-1)) {
        text.content += content.substr(static_cast<std::size_t>(rest));
    }
    return text;
}

/// CGAL knows no lines of an .obj that go on in the next one, takes a tab for a part of a number,
/// and believes to have failed after a line of anything but points and faces.
inline SurfaceText obj_text(std::string content, const std::string& name) {
    for (std::size_t at = 0; (at = content.find('\\', at)) != std::string::npos;) {
        const bool windows = content.compare(at + 1, 2, "\r\n") == 0;
        const bool continued = windows || content.compare(at + 1, 1, "\n") == 0;
        content.replace(at, windows ? 3 : continued ? 2 : 1, " ");
    }
    SurfaceText text{.vertices = 0, .faces = 0};
    std::istringstream lines(content);
    for (std::string line; std::getline(lines, line);) {
        const std::vector<std::string> words = words_of(line);
        if (words.empty() || (words[0] != "v" && words[0] != "f")) continue;
        std::string clean = words[0];
        for (std::size_t i = 1; i < words.size() && !words[i].starts_with('#'); ++i) {
            // A corner is point/texture/normal, of which the point is kept.
            clean +=
                " " + words[i].substr(0, words[0] == "f" ? words[i].find('/') : words[i].size());
            if (clean.back() == ' ') {
                throw IoError(name + " is damaged: face " + std::to_string(*text.faces) +
                              " has a corner without a vertex");
            }
        }
        ++*(words[0] == "v" ? text.vertices : text.faces);
        text.content += clean + "\n";
    }
    return text;
}

/// The header of a .ply is checked, since CGAL believes what it says; types of indices that CGAL
/// does not know are widened where the file is text.
inline SurfaceText ply_text(const std::string& content, const std::string& name) {
    static constexpr std::string_view types =
        " char uchar short ushort int uint float double int8 uint8 int16 uint16 int32 uint32 "
        "float32 float64 ";
    static constexpr std::string_view narrow = " char uchar short ushort int8 uint8 int16 uint16 ";
    const auto is_one_of = [](const std::string& word, std::string_view all) {
        return all.find(" " + word + " ") != std::string_view::npos;
    };
    const auto incomplete = [&](const std::string& line) {
        return IoError(name + " has no complete header of the format .ply" +
                       (line.empty() ? "" : ": '" + line.substr(0, 60) + "'"));
    };
    SurfaceText text;
    std::istringstream lines(content);
    std::string format;
    std::string element;
    bool has_corners = false;
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        std::vector<std::string> word = words_of(line);
        if (word.empty()) throw incomplete("");
        const bool list = word.size() == 5 && word[1] == "list";
        if (word[0] == "element") {
            if (format.empty() || word.size() != 3) throw incomplete(line);
            element = word[1];
            const std::size_t count = count_in(word[2], name);
            if (element == "vertex") text.vertices = count;
            if (element == "face") text.faces = count;
            if (element == "tristrips" && count > 0) {
                throw InvalidInput(name + " holds strips of triangles, which are not read");
            }
        } else if (word[0] == "format") {
            if (!format.empty() || word.size() != 3 || word[2] != "1.0") throw incomplete(line);
            format = word[1];
        } else if (word[0] == "property") {
            if (element.empty() || (word.size() != 3 && !list)) throw incomplete(line);
            if (!is_one_of(word[list ? 2 : 1], types)) throw incomplete(line);
            if (list && !is_one_of(word[3], types)) throw incomplete(line);
            const bool corners = list && element == "face" &&
                                 (word[4] == "vertex_indices" || word[4] == "vertex_index");
            has_corners = has_corners || corners;
            if (corners && is_one_of(word[3], narrow)) {
                if (format != "ascii") {
                    throw InvalidInput(name + " numbers corners in " + word[3] +
                                       ", which is read in text only: save it with int");
                }
                line = "property list uchar int " + word[4];
            }
        } else if (word[0] == "end_header") {
            text.content += line + "\n";
            const auto rest = lines.tellg();
            if (rest != std::istringstream::pos_type(-1)) {
                text.content += content.substr(static_cast<std::size_t>(rest));
            }
            if (text.faces.value_or(0) > 0 && !has_corners) {
                throw InvalidInput(name + " has faces without a list 'vertex_indices'");
            }
            return text;
        } else if (word[0] != "ply" && word[0] != "comment" && word[0] != "obj_info") {
            throw incomplete(line);
        }
        text.content += line + "\n";
    }
    throw incomplete("");
}

enum class StlKind { incomplete, text, binary };

/// An .stl is binary if it has 84 bytes and 50 for each of the triangles that it declares, and a
/// complete text if its last line starts with "endsolid".
inline StlKind stl_kind(const std::string& content) {
    const std::size_t begin = content.find_first_not_of(" \t\r\n");
    const auto has_word = [&](std::size_t at, std::string_view word) {
        return lower_case(content.substr(at, word.size())) == word;
    };
    const bool text = has_word(begin, "solid");
    if (content.size() >= 84) {
        std::uint32_t triangles = 0;
        std::memcpy(&triangles, content.data() + 80, sizeof triangles);
        const std::size_t size = 84 + 50 * std::size_t{triangles};
        if (content.size() == size || (!text && content.size() > size)) return StlKind::binary;
    }
    const std::size_t end = content.find_last_not_of(" \t\r\n");
    const std::size_t line = content.find_last_of('\n', end) + 1;
    const std::size_t word = content.find_first_not_of(" \t", line);
    return text && has_word(word, "endsolid") ? StlKind::text : StlKind::incomplete;
}

/// CGAL wants lower case and stumbles over the names of solids; it takes a binary file for text
/// that begins with "solid".
/// \return nothing where the file is neither text nor binary to its end
inline std::optional<SurfaceText> stl_text(std::string content) {
    SurfaceText text;
    const StlKind kind = stl_kind(content);
    if (kind == StlKind::incomplete) return std::nullopt;
    if (kind == StlKind::binary) {
        std::fill_n(content.begin(), 80, ' ');
        std::uint32_t triangles = 0;
        std::memcpy(&triangles, content.data() + 80, sizeof triangles);
        text.faces = triangles;
        text.content = std::move(content);
        return text;
    }
    text.faces = 0;
    std::istringstream lines(content);
    for (std::string line; std::getline(lines, line);) {
        const std::vector<std::string> words = words_of(lower_case(line));
        const bool named = !words.empty() && (words[0] == "solid" || words[0] == "endsolid");
        if (!words.empty() && words[0] == "facet") ++*text.faces;
        for (std::size_t i = 0; i < (named ? 1 : words.size()); ++i) {
            text.content += words[i] + " ";
        }
        text.content += "\n";
    }
    return text;
}

}  // namespace nestgrid::detail
