// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The headers of MetaImage and NRRD.
#include "sample_layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <nestgrid/error.hpp>

#include "samples.hpp"
#include "text_header.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::IoError;
using nestgrid::Point;

using Names = std::map<std::string, std::string>;

std::string known_type(const TextHeader& header, const std::string& name, const Names& types) {
    const auto type = types.find(name);
    if (type == types.end()) {
        throw IoError(header.path.string() + " has the sample type '" + name +
                      "', which is not read");
    }
    return type->second;
}

/// Samples along three directions, of which a header may leave out the last.
std::array<int, 3> sample_counts(const TextHeader& header, const std::string& key) {
    std::array<int, 3> counts{1, 1, 1};
    std::vector<double> numbers = header.numbers(key);
    while (numbers.size() > 3 && std::find(numbers.begin(), numbers.end(), 1) != numbers.end()) {
        numbers.erase(std::find(numbers.begin(), numbers.end(), 1));
    }
    bool known = !numbers.empty() && numbers.size() <= 3;
    for (std::size_t d = 0; known && d < numbers.size(); ++d) {
        known = numbers[d] >= 1 && numbers[d] <= 1048576 && numbers[d] == std::floor(numbers[d]);
        if (known) counts[d] = static_cast<int>(numbers[d]);
    }
    if (!known) {
        throw IoError(header.path.string() + " has the size '" + header.value(key) +
                      "', not that of a volume");
    }
    return counts;
}

void set_point(const std::vector<double>& numbers, Point& point) {
    for (std::size_t d = 0; d < std::min<std::size_t>(3, numbers.size()); ++d) {
        if (std::isfinite(numbers[d])) point[d] = numbers[d];
    }
}

/// The numbers of the first key that is there.
std::vector<double> first_numbers(const TextHeader& header,
                                  std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
        std::vector<double> numbers = header.numbers(key);
        if (!numbers.empty()) return numbers;
    }
    return {};
}

bool is_true(const std::string& value) {
    const std::string first = lower(value.substr(0, 1));
    return first == "t" || first == "y" || first == "1";
}

void set_meta_geometry(const TextHeader& header, nestgrid::LatticeGeometry<3>& geometry) {
    geometry.samples = sample_counts(header, "dimsize");
    set_point(first_numbers(header, {"elementspacing", "elementsize"}), geometry.spacing);
    set_point(first_numbers(header, {"offset", "position", "origin"}), geometry.origin);
    const auto axes = first_numbers(header, {"transformmatrix", "rotation", "orientation"});
    if (axes.size() != 9) return;
    // MetaImage lists the axes one after the other.
    for (std::size_t i = 0; i < 9; ++i) geometry.direction[i % 3][i / 3] = axes[i];
}

void set_nrrd_geometry(const TextHeader& header, nestgrid::LatticeGeometry<3>& geometry) {
    geometry.samples = sample_counts(header, "sizes");
    set_point(header.numbers("spacings"), geometry.spacing);
    set_point(first_numbers(header, {"space origin", "axis mins", "axismins"}), geometry.origin);
    const auto axes = header.numbers("space directions");
    if (axes.size() != 9) return;
    for (std::size_t d = 0; d < 3; ++d) {
        const Point axis{axes[3 * d], axes[3 * d + 1], axes[3 * d + 2]};
        geometry.spacing[d] = nestgrid::norm(axis);
        for (std::size_t r = 0; r < 3; ++r) {
            geometry.direction[r][d] = axis[r] / geometry.spacing[d];
        }
    }
}

/// The one word that all words of a value are, quotes aside; empty where they differ.
std::string common_word(const std::string& value) {
    std::string text = value;
    std::replace(text.begin(), text.end(), '"', ' ');
    std::istringstream words(text);
    std::string word;
    words >> word;
    for (std::string other; words >> other;) {
        if (other != word) return "";
    }
    return word;
}

/// The first number of a list, at least `least`; 0 where there is none.
std::intmax_t skipped(const std::vector<double>& numbers, std::intmax_t least) {
    if (numbers.empty()) return 0;
    // False for what is no number, too.
    const bool in_range = numbers[0] >= static_cast<double>(least) && numbers[0] < 1e15;
    return in_range ? static_cast<std::intmax_t>(numbers[0]) : least;
}

Encoding nrrd_encoding(const TextHeader& header) {
    static const std::map<std::string, Encoding> encodings{
        {"raw", Encoding::raw},  {"gzip", Encoding::deflated}, {"gz", Encoding::deflated},
        {"txt", Encoding::text}, {"text", Encoding::text},     {"ascii", Encoding::text}};
    const auto encoding = encodings.find(lower(header.value("encoding")));
    if (encoding == encodings.end()) {
        throw IoError(header.path.string() + " has the encoding '" + header.value("encoding") +
                      "', which is not read");
    }
    return encoding->second;
}

}  // namespace

SampleLayout meta_layout(const fs::path& path) {
    static const Names types{
        {"MET_CHAR", "int8"},     {"MET_UCHAR", "uint8"},       {"MET_SHORT", "int16"},
        {"MET_USHORT", "uint16"}, {"MET_INT", "int32"},         {"MET_UINT", "uint32"},
        {"MET_LONG", "int32"},    {"MET_ULONG", "uint32"},      {"MET_LONG_LONG", "int64"},
        {"MET_FLOAT", "float32"}, {"MET_ULONG_LONG", "uint64"}, {"MET_DOUBLE", "float64"}};
    const TextHeader header = read_text_header(path, '=', "elementdatafile");
    const std::string names = header.value("elementdatafile");
    if (names.empty()) throw IoError(path.string() + " is no MetaImage: it names no data file");
    const auto channels = header.numbers("elementnumberofchannels");
    if (!channels.empty() && channels[0] != 1) {
        throw IoError(path.string() + " has " + header.value("elementnumberofchannels") +
                      " numbers per sample, not one");
    }
    SampleLayout layout{.path = path};
    layout.type = known_type(header, header.value("elementtype"), types);
    set_meta_geometry(header, layout.geometry);
    layout.name = header.value("name");
    layout.unit = header.value("distanceunits");
    const bool local = lower(names) == "local";
    layout.files = local ? std::vector{path} : data_files(header, names);
    layout.header_bytes = local ? header.length : 0;
    if (!local) layout.skipped_bytes = skipped(header.numbers("headersize"), -1);
    const std::string binary = header.value("binarydata");
    if (!binary.empty() && !is_true(binary)) layout.encoding = Encoding::text;
    if (is_true(header.value("compresseddata"))) layout.encoding = Encoding::deflated;
    for (const char* key : {"binarydatabyteordermsb", "elementbyteordermsb"}) {
        layout.big_endian = layout.big_endian || is_true(header.value(key));
    }
    return layout;
}

SampleLayout nrrd_layout(const fs::path& path) {
    static const Names types = [] {
        Names names{{"float", "float32"}, {"double", "float64"}};
        for (const auto& [type, synonyms] : std::map<std::string, std::vector<std::string>>{
                 {"int8", {"signed char", "int8", "int8_t"}},
                 {"uint8", {"unsigned char", "uchar", "uint8", "uint8_t"}},
                 {"int16",
                  {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
                 {"uint16",
                  {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
                 {"int32", {"int", "signed int", "int32", "int32_t"}},
                 {"uint32", {"uint", "unsigned int", "uint32", "uint32_t"}},
                 {"int64",
                  {"longlong", "long long", "long long int", "signed long long",
                   "signed long long int", "int64", "int64_t"}},
                 {"uint64",
                  {"ulonglong", "unsigned long long", "unsigned long long int", "uint64",
                   "uint64_t"}}}) {
            for (const std::string& synonym : synonyms) names[synonym] = type;
        }
        return names;
    }();
    const TextHeader header = read_text_header(path, ':', "data file", "LIST");
    if (!header.ended) {
        throw IoError(path.string() + " is truncated or no NRRD file: its header does not end");
    }
    SampleLayout layout{.path = path};
    layout.type = known_type(header, lower(header.value("type")), types);
    set_nrrd_geometry(header, layout.geometry);
    layout.name = header.value("content");
    layout.unit = common_word(header.value("space units"));
    if (layout.unit.empty()) layout.unit = common_word(header.value("units"));
    layout.encoding = nrrd_encoding(header);
    layout.big_endian = lower(header.value("endian")) == "big";
    std::string names = header.value("data file");
    if (names.empty()) names = header.value("datafile");
    layout.files = names.empty() ? std::vector{path} : data_files(header, names);
    layout.header_bytes = names.empty() ? header.length : 0;
    layout.skipped_lines =
        static_cast<std::uintmax_t>(skipped(first_numbers(header, {"line skip", "lineskip"}), 0));
    layout.skipped_bytes = skipped(first_numbers(header, {"byte skip", "byteskip"}), -1);
    if (layout.encoding != Encoding::raw && layout.skipped_bytes != 0) {
        throw IoError(path.string() + " skips bytes of packed samples, which is not read");
    }
    return layout;
}
