// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The headers of MetaImage and NRRD.
#include "sample_layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
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

int whole_number(const TextHeader& header, const std::string& key, double number) {
    if (number >= 1 && number <= 1048576 && number == std::floor(number)) {
        return static_cast<int>(number);
    }
    throw IoError(header.path.string() + " has the size '" + header.value(key) +
                  "', not that of a volume");
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

/// Number i of a list, which must be finite; `otherwise` where the list is empty.
double finite(const TextHeader& header, const char* key, const std::vector<double>& numbers,
              std::size_t i, double otherwise) {
    if (numbers.empty()) return otherwise;
    if (std::isfinite(numbers[i])) return numbers[i];
    throw IoError(header.path.string() + " has " + header.described(key) + ", which is not finite");
}

/// The first of the keys that is there.
const char* first_key(const TextHeader& header, std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
        if (!header.value(key).empty()) return key;
    }
    return *keys.begin();
}

/// Multiplies a number of samples that are none of space.
void add_axis(const TextHeader& header, std::size_t count, std::size_t& product) {
    if (product > std::size_t{PTRDIFF_MAX} / count) {
        throw IoError(header.path.string() + " asks for more samples than any memory holds");
    }
    product *= count;
}

/// Sets samples, frames and the place. The axes behind the third one are frames.
void set_meta_geometry(const TextHeader& header, SampleLayout& layout) {
    const std::vector<double> sizes = header.numbers("dimsize");
    const auto dimensions = header.numbers("ndims", 1);
    const std::size_t n =
        dimensions.empty() ? sizes.size()
                           : static_cast<std::size_t>(whole_number(header, "ndims", dimensions[0]));
    if (sizes.empty() || sizes.size() != n || n > 10) {
        throw IoError(header.path.string() + " has the size '" + header.value("dimsize") + "' of " +
                      std::to_string(n) + " dimensions, not that of a volume");
    }
    auto& geometry = layout.geometry;
    const char* const spacing = first_key(header, {"elementspacing", "elementsize"});
    const char* const origin = first_key(header, {"offset", "position", "origin"});
    const char* const matrix = first_key(header, {"transformmatrix", "rotation", "orientation"});
    const auto spacings = header.numbers(spacing, n);
    const auto places = header.numbers(origin, n);
    const auto axes = header.numbers(matrix, n * n);
    geometry.samples = {1, 1, 1};
    for (std::size_t d = 0; d < n; ++d) {
        const auto count = whole_number(header, "dimsize", sizes[d]);
        if (d >= 3) {
            add_axis(header, static_cast<std::size_t>(count), layout.frames);
            const double step = finite(header, spacing, spacings, d, 1);
            if (count > 1 && step > 0) layout.time_step = step;
            continue;
        }
        geometry.samples[d] = count;
        geometry.spacing[d] = finite(header, spacing, spacings, d, 1);
        geometry.origin[d] = finite(header, origin, places, d, 0);
        for (std::size_t r = 0; r < std::min<std::size_t>(n, 3); ++r) {
            // MetaImage lists the axes one after the other.
            geometry.direction[r][d] = finite(header, matrix, axes, d * n + r, r == d ? 1 : 0);
        }
    }
}

/// The words of a value, of which each may be a list in brackets; `count` of them, or none.
std::vector<std::string> words_of(const TextHeader& header, const std::string& key,
                                  std::size_t count) {
    std::vector<std::string> words;
    std::istringstream text(header.value(key));
    for (std::string word; text >> word;) {
        std::string more;
        while (word.front() == '(' && word.find(')') == std::string::npos && text >> more) {
            word += " " + more;
        }
        words.push_back(word);
    }
    if (words.empty() || words.size() == count) return words;
    throw IoError(header.path.string() + " has " + header.described(key) +
                  ", not one for each of its " + std::to_string(count) + " axes");
}

enum class Role { components, space, frames };

/// An axis of an array in a NRRD file.
struct NrrdAxis {
    std::size_t size = 0;
    Role role = Role::space;
    std::vector<double> direction{};  ///< empty where there is none
    std::optional<double> spacing{}, min{}, max{};
    bool nodes = false;  ///< whether samples are at both ends
};

Role role_of(const std::string& kind, const NrrdAxis& axis, bool has_space) {
    const auto& v = axis.direction;
    const bool along_time = v.size() == 4 && v[0] == 0 && v[1] == 0 && v[2] == 0;
    if (kind == "time" || kind == "list" || along_time) return Role::frames;
    if (kind == "domain" || kind == "space") return Role::space;
    if (!kind.empty() && kind != "???" && kind != "none") return Role::components;
    // The axes of space have directions where there is a space.
    return !has_space || !v.empty() ? Role::space : Role::frames;
}

std::vector<NrrdAxis> nrrd_axes(const TextHeader& header) {
    const std::vector<double> sizes = header.numbers("sizes");
    const std::size_t n = sizes.size();
    std::vector<NrrdAxis> axes(n);
    const auto kinds = words_of(header, "kinds", n);
    const auto directions = words_of(header, "space directions", n);
    const auto centers = words_of(header, first_key(header, {"centers", "centerings"}), n);
    const auto spacings = header.numbers("spacings", n);
    const auto mins = header.numbers(first_key(header, {"axis mins", "axismins"}), n);
    const auto maxs = header.numbers(first_key(header, {"axis maxs", "axismaxs"}), n);
    const auto known = [](const std::vector<double>& numbers, std::size_t i) {
        return i < numbers.size() && std::isfinite(numbers[i]) ? std::optional(numbers[i])
                                                               : std::nullopt;
    };
    for (std::size_t i = 0; i < n; ++i) {
        NrrdAxis& axis = axes[i];
        axis.size = static_cast<std::size_t>(whole_number(header, "sizes", sizes[i]));
        if (i < directions.size() && lower(directions[i]) != "none") {
            TextHeader one{.path = header.path, .field = {{"space directions", directions[i]}}};
            axis.direction = one.numbers("space directions");
        }
        axis.role = role_of(i < kinds.size() ? lower(kinds[i]) : "", axis, !directions.empty());
        axis.spacing = known(spacings, i);
        axis.min = known(mins, i);
        axis.max = known(maxs, i);
        axis.nodes = i < centers.size() && lower(centers[i]) == "node";
    }
    return axes;
}

/// Leaves three axes of space: those of one sample become none, then the slowest ones frames.
void limit_space(std::vector<NrrdAxis>& axes) {
    const auto of_space = [](const NrrdAxis& axis) { return axis.role == Role::space; };
    while (std::ranges::count_if(axes, of_space) > 3) {
        auto left_out = std::ranges::find_if(
            axes, [&](const NrrdAxis& axis) { return of_space(axis) && axis.size == 1; });
        if (left_out == axes.end()) {
            left_out = std::find_if(axes.rbegin(), axes.rend(), of_space).base() - 1;
        }
        left_out->role = Role::frames;
    }
}

/// The vector from one sample to the next along axis d of the volume. Sets the origin where the
/// axis has a minimum, which is that of the first cell unless samples are at both ends.
Point step_along(const NrrdAxis& axis, std::size_t d, Point& origin) {
    Point step{0, 0, 0};
    if (!axis.direction.empty()) {
        std::copy_n(axis.direction.begin(), std::min<std::size_t>(3, axis.direction.size()),
                    step.begin());
        return step;
    }
    step[d] = axis.spacing.value_or(1);
    const double steps = static_cast<double>(axis.size) - (axis.nodes ? 1 : 0);
    if (!axis.spacing && axis.min && axis.max && steps > 0) {
        step[d] = (*axis.max - *axis.min) / steps;
    }
    if (axis.min) origin[d] = *axis.min + (axis.nodes ? 0 : step[d] / 2);
    return step;
}

void set_nrrd_geometry(const TextHeader& header, SampleLayout& layout) {
    std::vector<NrrdAxis> axes = nrrd_axes(header);
    if (axes.empty()) throw IoError(header.path.string() + " has no sizes");
    limit_space(axes);
    auto& geometry = layout.geometry;
    geometry.samples = {1, 1, 1};
    std::size_t d = 0;
    Role last = Role::components;
    for (const NrrdAxis& axis : axes) {
        if (axis.role != Role::space && axis.size == 1) continue;
        if (axis.role < last) {
            throw IoError(header.path.string() +
                          " has axes of space that are not side by side, which is not read");
        }
        last = axis.role;
        if (axis.role == Role::components) add_axis(header, axis.size, layout.components);
        if (axis.role == Role::frames) add_axis(header, axis.size, layout.frames);
        if (axis.role != Role::space) continue;
        geometry.samples[d] = static_cast<int>(axis.size);
        const Point step = step_along(axis, d, geometry.origin);
        geometry.spacing[d] = nestgrid::norm(step);
        for (std::size_t r = 0; r < 3; ++r)
            geometry.direction[r][d] = step[r] / geometry.spacing[d];
        ++d;
    }
    const auto origin = header.numbers("space origin");
    for (std::size_t r = 0; r < std::min<std::size_t>(3, origin.size()); ++r) {
        if (std::isfinite(origin[r])) geometry.origin[r] = origin[r];
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
        {"txt", Encoding::text}, {"text", Encoding::text},     {"ascii", Encoding::text},
        {"hex", Encoding::hex}};
    const auto encoding = encodings.find(lower(header.value("encoding")));
    if (encoding == encodings.end()) {
        throw IoError(header.path.string() + " has the encoding '" + header.value("encoding") +
                      "', which is not read");
    }
    return encoding->second;
}

}  // namespace

// Fields of the header and what becomes of them:
//   NDims, DimSize                                  samples and frames
//   ElementType, ElementNumberOfChannels            type and components
//   ElementSpacing, else ElementSize; Offset, else Position, else Origin; TransformMatrix, else
//   Rotation, else Orientation                      the place
//   ElementDataFile, HeaderSize, BinaryData, CompressedData, BinaryDataByteOrderMSB,
//   ElementByteOrderMSB                             where the samples are and how they are packed
//   ElementToIntensityFunctionSlope, ...Offset      slope and intercept
//   AnatomicalOrientation, DistanceUnits, Name      whether axes are LPS; unit; name
//   CenterOfRotation, Comment, Color, CompressedDataSize, ElementMin, ElementMax, ElementNBits, ID,
//   Modality, ObjectType, ObjectSubType, ParentID, SequenceID, others           without effect
SampleLayout meta_layout(const fs::path& path) {
    static const Names types{
        {"MET_CHAR", "int8"},     {"MET_UCHAR", "uint8"},       {"MET_SHORT", "int16"},
        {"MET_USHORT", "uint16"}, {"MET_INT", "int32"},         {"MET_UINT", "uint32"},
        {"MET_LONG", "int32"},    {"MET_ULONG", "uint32"},      {"MET_LONG_LONG", "int64"},
        {"MET_FLOAT", "float32"}, {"MET_ULONG_LONG", "uint64"}, {"MET_DOUBLE", "float64"}};
    const TextHeader header = read_text_header(path, '=', "elementdatafile");
    const std::string names = header.value("elementdatafile");
    if (names.empty()) throw IoError(path.string() + " is no MetaImage: it names no data file");
    SampleLayout layout{.path = path};
    layout.type = known_type(header, header.value("elementtype"), types);
    set_meta_geometry(header, layout);
    const auto channels = header.numbers("elementnumberofchannels", 1);
    if (!channels.empty()) {
        layout.components =
            static_cast<std::size_t>(whole_number(header, "elementnumberofchannels", channels[0]));
    }
    for (const auto& [key, factor] :
         {std::pair{"elementtointensityfunctionslope", &layout.slope},
          std::pair{"elementtointensityfunctionoffset", &layout.intercept}}) {
        *factor = finite(header, key, header.numbers(key, 1), 0, *factor);
    }
    if (layout.slope == 0) throw IoError(path.string() + " has an intensity function of slope 0");
    layout.name = header.value("name");
    layout.unit = header.value("distanceunits");
    if (layout.unit == "?") layout.unit.clear();
    // Who knows where a patient lies writes places as ITK does.
    const std::string orientation = header.value("anatomicalorientation");
    if (orientation.size() >= 3 && orientation.find('?') == std::string::npos) {
        layout.space = "LPS";
    }
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
    const std::string names = header.value(first_key(header, {"data file", "datafile"}));
    if (!header.ended && names.empty()) {
        throw IoError(path.string() + " is truncated or no NRRD file: its header does not end");
    }
    SampleLayout layout{.path = path};
    layout.type = known_type(header, lower(header.value("type")), types);
    set_nrrd_geometry(header, layout);
    layout.name = header.value("content");
    layout.unit = common_word(header.value("space units"));
    if (layout.unit.empty()) layout.unit = common_word(header.value("units"));
    layout.encoding = nrrd_encoding(header);
    layout.big_endian = lower(header.value("endian")) == "big";
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
