// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "options/command_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/input_file.hpp"
#include "input/standard_input.hpp"
#include "joined.hpp"
#include "output/surface_file.hpp"
#include "suggestion.hpp"
#include "text_header.hpp"

namespace fs = std::filesystem;

std::string positive_number(const std::string& text) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (*end == '\0' && number > 0 && std::isfinite(number)) return "";
    return "'" + text + "' is no positive finite number";
}

CLI::Validator one_of(std::vector<std::string> words, std::map<std::string, std::string> synonyms) {
    std::string known;
    for (const std::string& word : words) known += (known.empty() ? "" : ",") + word;
    const auto check = [words = std::move(words),
                        synonyms = std::move(synonyms)](const std::string& text) -> std::string {
        if (std::ranges::find(words, text) != words.end()) return "";
        const auto synonym = synonyms.find(lower(text));
        return "'" + text + "' is none of " + listed(words) +
               (synonym == synonyms.end() ? did_you_mean(text, words)
                                          : ": did you mean '" + synonym->second + "'?");
    };
    return {check, "{" + known + "}"};
}

void add_read_limit(CLI::App& command, double& seconds) {
    command
        .add_option("--read-limit", seconds,
                    "refuse a file that takes longer to read [60 and one for each MB; ten times "
                    "that for .poly and .smesh]")
        ->type_name("SECONDS")
        ->group("Input")
        ->check(positive_number);
}

void add_input(CLI::App& command, Input& input) {
    input.command = &command;
    command
        .add_option("INPUT", input.path,
                    "a volume, a picture, a mesh or a hierarchy: .nii.gz, .nrrd, .mha, .vti, .raw, "
                    ".tif, .vtu, .nestgrid, a plotfile of AMReX and others ('nestgrid formats' "
                    "lists them); - is standard input")
        ->required();
}

void add_read_options(CLI::App& command, Input& input) {
    command.add_option("--input-format", input.format, "what standard input is, like nii.gz")
        ->type_name("ENDING")
        ->group("Input");
    command
        .add_option(
            "--array,--field", input.array,
            "the array of a .vti, the field of a .vtu, a .nestgrid, a plotfile or other files "
            "of boxes")
        ->type_name("NAME")
        ->group("Input");
    command
        .add_option("--cells", input.cells,
                    "values at nodes of the cells of a plotfile or other files of boxes: smooth "
                    "means, or sharper ones, "
                    "which take those of cells for values at centres or for means over cells")
        ->type_name("RULE")
        ->group("Input")
        ->check(one_of({"smooth", "centres", "means"}))
        ->capture_default_str();
    command
        .add_option("--frame", input.choice.frame,
                    "one of several volumes in a file, from 0 [the first]")
        ->type_name("NUMBER")
        ->group("Input");
    command
        .add_option("--component", input.choice.component,
                    "one of several numbers per sample, from 0")
        ->type_name("NUMBER")
        ->group("Input");
    command.add_flag("--magnitude", input.choice.magnitude, "or the norm of all of them")
        ->group("Input");
    command
        .add_option("--label", input.labels,
                    "take samples for 1 where they have this value, else for 0: the surface of 0.5 "
                    "is that of a segmented part; isosurface takes several, one surface each")
        ->type_name("NUMBER")
        ->group("Input")
        ->take_all();
    command
        .add_option("--missing", input.choice.missing,
                    "samples with this value have none, as those that are not a number (NaN): "
                    "nothing is drawn beside them; again for several values")
        ->type_name("VALUE")
        ->group("Input")
        ->take_all();
    command
        .add_option("--mask", input.choice.mask,
                    "a file of as many samples: where they are 0, those of the input have no value")
        ->type_name("FILE")
        ->group("Input");
    command
        .add_option("--space", input.choice.space,
                    "turn places to the right, front and top of a patient (ras), or to the left, "
                    "back and top (lps) [as in the file]")
        ->type_name("SPACE")
        ->group("Input")
        ->check(one_of({"ras", "lps"}));
    command.add_option("--dims", input.raw.dims, "samples of a .raw file in each direction")
        ->type_name("NX,NY,NZ")
        ->group("Input")
        ->delimiter(',');
    command.add_option("--type", input.raw.type, "their type: uint8 ... int64, float32 or float64")
        ->type_name("TYPE")
        ->group("Input")
        ->check(one_of({"uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64",
                        "float32", "float64"},
                       {{"float", "float32"},
                        {"double", "float64"},
                        {"uchar", "uint8"},
                        {"byte", "uint8"},
                        {"char", "int8"},
                        {"ushort", "uint16"},
                        {"short", "int16"},
                        {"uint", "uint32"},
                        {"int", "int32"},
                        {"ulong", "uint64"},
                        {"long", "int64"}}));
    command.add_option("--endian", input.endian, "their byte order, little or big")
        ->type_name("ORDER")
        ->group("Input")
        ->check(one_of({"little", "big"}))
        ->capture_default_str();
    command.add_option("--spacing", input.raw.spacing, "their distances [1,1,1]")
        ->type_name("X,Y,Z")
        ->group("Input")
        ->delimiter(',');
    add_read_limit(command, input.read_limit);
}

void refuse_options(const CLI::App& command, const std::vector<std::string>& names,
                    const std::string& why) {
    for (const std::string& name : names) {
        const CLI::Option* option = command.get_option_no_throw(name);
        if (option == nullptr || option->count() == 0) continue;
        throw nestgrid::InvalidInput(name + " " + why);
    }
}

namespace {

/// Options that apply to all files of samples.
constexpr std::array sample_options{"--frame",   "--component", "--magnitude", "--label",
                                    "--missing", "--mask",      "--space",     "--read-limit"};

bool applies(const std::string& option, const Format& format) {
    if (std::ranges::find(format.options, option) != format.options.end()) return true;
    return format.read_samples != nullptr &&
           std::ranges::find(sample_options, option) != sample_options.end();
}

/// The formats that an option applies to, each by its usual ending: ".nrrd and .vti".
std::string formats_with(const std::string& option) {
    std::vector<std::string> endings;
    for (const Format& format : formats()) {
        if (!applies(option, format)) continue;
        endings.push_back(format.endings.empty() ? format.name : format.endings.front());
    }
    return joined(endings, "and");
}

}  // namespace

void open(Input& input) {
    if (is_standard_stream(input.path)) {
        input.path = keep_standard_input(input.format);
    } else if (!input.format.empty()) {
        throw nestgrid::InvalidInput("--input-format is for standard input, -: the name of '" +
                                     input.path.string() + "' tells its format");
    }
    if (is_standard_stream(input.choice.mask)) {
        throw nestgrid::InvalidInput("a mask has a name: only the INPUT can be standard input");
    }
    input.format.clear();
    const Format* const format = format_of(input.path);
    if (input.command == nullptr || format == nullptr) return;
    for (const CLI::Option* option : input.command->get_options()) {
        if (option->count() == 0 || option->get_group() != "Input") continue;
        if (option->get_name() != "--input-format" && !applies(option->get_name(), *format)) {
            throw nestgrid::InvalidInput(option->get_name() + " is for " +
                                         formats_with(option->get_name()) + " files, not for '" +
                                         input.path.string() + "'");
        }
    }
}

std::vector<Volume> read_volumes(Input& input, bool all_frames) {
    input.raw.big_endian = input.endian == "big";
    VolumeChoice choice = input.choice;
    choice.array = input.array;
    if (input.labels.size() > 1) {
        throw nestgrid::InvalidInput(
            "--label is given several times: only an isosurface of one "
            "moment is drawn of several parts");
    }
    if (!input.labels.empty()) choice.label = input.labels.front();
    choice.all_frames = all_frames && !choice.frame;
    return read_volumes(input.path, choice, input.raw, input.read_limit);
}

void add_surface_options(CLI::App& command, SurfaceOptions& options, bool of_isosurface) {
    options.command = &command;
    command
        .add_option("--threshold", options.thresholds,
                    "leave out detail up to this, in units of the data or in percent of their "
                    "range; again for several surfaces [0]")
        ->type_name("NUMBER[%]")
        ->take_all();
    command
        .add_option("--max-triangles", options.budgets,
                    "or so much detail that the surface keeps within this; again for several")
        ->type_name("COUNT")
        ->take_all()
        ->excludes("--threshold");
    command
        .add_option_function<std::vector<std::string>>(
            "--error",
            [&options](const std::vector<std::string>& errors) {
                options.thresholds = errors;
                options.projection.indicator = "deviation";
            },
            "or let the data and what is drawn of them differ by at most this, in units of the "
            "data or in percent of their range")
        ->type_name("NUMBER[%]")
        ->take_all()
        ->excludes("--threshold")
        ->excludes("--max-triangles");
    command
        .add_option(
            "--position-error", options.projection.position_error,
            "let points of curved cells be drawn at most this far from their places, in the "
            "unit of the grid [the same share of the domain as the error is of the range]")
        ->type_name("LENGTH")
        ->group("Detail")
        ->check(positive_number)
        ->excludes("--threshold");
    command
        .add_option(
            "-o,--output", options.output,
            "write " + joined(endings_for(&Format::write_surface), "or") + "; - is standard output")
        ->type_name("FILE");
    command
        .add_option("--output-format", options.output_format,
                    "what standard output is, while the table goes to standard error [ply]")
        ->type_name("ENDING")
        ->group("Further");
    command
        .add_option_function<std::string>(
            "--compress",
            [&options](const std::string& word) {
                using Compression = SurfaceEncoding::Compression;
                options.encoding.compression = word == "zlib"   ? Compression::zlib
                                               : word == "none" ? Compression::none
                                                                : Compression::lz4;
            },
            "how a .vtp is packed: zlib is smallest, none is fastest [lz4]")
        ->type_name("WORD")
        ->group("Further")
        ->check(one_of({"zlib", "lz4", "none"}));
    command
        .add_flag("--double", options.encoding.doubles,
                  "write points in double precision, also where single precision suffices")
        ->group("Further");
    add_projection_options(command, options.projection, of_isosurface);
    command.get_option("--error")->excludes("--indicator");
    command
        .add_option("--threads", options.threads,
                    "how many to use; the surface is the same with any [all]")
        ->type_name("COUNT")
        ->group("Further");
    add_picture_options(command, options.picture);
}

void add_elements_option(CLI::App& command, SurfaceOptions& options) {
    command
        .add_flag("--elements", options.elements,
                  "write the number and the level of the element that each triangle comes from")
        ->group("Further");
}

std::string SurfaceOptions::output_ending() const {
    if (!is_standard_stream(output)) return ending_of(output);
    if (output_format.empty()) return ".ply";
    return lower(output_format.front() == '.' ? output_format : "." + output_format);
}

namespace {

/// Refuses an option where the format of the output does not do what it asks for.
void require_format(const SurfaceOptions& options, const std::string& name, bool Format::*does) {
    const Format* const format = format_of("x" + options.output_ending());
    if (!options.output.empty() && format != nullptr && format->*does) return;
    std::vector<std::string> endings;
    for (const Format& other : formats()) {
        if (other.*does) endings.push_back(other.endings.front());
    }
    refuse_options(*options.command, {name}, "is for an --output as " + joined(endings, "or"));
}

/// \throw nestgrid::InvalidInput, nestgrid::IoError where standard output takes no surface
void check_stream(const SurfaceOptions& options) {
    const std::vector<std::string> known = endings_for(&Format::write_surface);
    if (std::ranges::find(known, options.output_ending()) == known.end()) {
        throw nestgrid::InvalidInput("the output format '" + options.output_format +
                                     "' is none of " + listed(known) +
                                     did_you_mean(options.output_ending(), known));
    }
    if (options.thresholds.size() + options.budgets.size() > 1) {
        throw nestgrid::InvalidInput(
            "standard output takes one surface: give -o a name for several");
    }
    if (isatty(STDOUT_FILENO) == 1) {
        throw nestgrid::IoError("standard output is a terminal: send it to a file or a program");
    }
}

}  // namespace

void check(const SurfaceOptions& options) {
    for (const std::int64_t budget : options.budgets) {
        if (budget <= 0) throw nestgrid::InvalidInput("--max-triangles is not positive");
    }
    for (const std::string name : {"error", "distance"}) {
        if (options.command == nullptr) break;
        const CLI::Option* const option = options.command->get_option_no_throw("--" + name);
        if (option == nullptr || option->count() == 0) continue;
        for (const std::string& error : options.thresholds) require_error(error, name);
    }
    check(options.projection);
    for (const char* name : {"--output", "--image"}) {
        const CLI::Option* option =
            options.command == nullptr ? nullptr : options.command->get_option_no_throw(name);
        if (option != nullptr && option->count() > 0 && option->as<std::string>().empty()) {
            throw nestgrid::InvalidInput(std::string(name) + " has an empty name");
        }
    }
    if (options.threads < 0) throw nestgrid::InvalidInput("--threads is negative");
    if (is_standard_stream(options.output)) {
        check_stream(options);
    } else if (!options.output_format.empty()) {
        throw nestgrid::InvalidInput(
            "--output-format is for standard output, -o -: names of files tell their formats");
    } else if (!options.output.empty()) {
        check_output(options.output, endings_for(&Format::write_surface));
    }
    parse(options.picture);
    if (options.command == nullptr) return;
    require_format(options, "--elements", &Format::keeps_elements);
    require_format(options, "--compress", &Format::compresses);
    require_format(options, "--double", &Format::has_doubles);
    if (options.output.empty() && options.picture.image.empty()) {
        refuse_options(*options.command, {"--outlines"},
                       "is about what is kept: give an --output or an --image");
    }
    if (options.thresholds.empty() && options.budgets.empty()) {
        require_threshold(*options.command);
    }
}

void say_what_was_kept(const SurfaceOptions& options, Report& report) {
    if (!options.output.empty() || !options.picture.image.empty()) return;
    report.say("nothing was kept: give -o FILE or --image FILE");
}

ProgressLine::ProgressLine() : terminal_{isatty(STDERR_FILENO) == 1} {}
ProgressLine::~ProgressLine() {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::print(const std::string& text) {
    if (!terminal_) return;
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    std::fflush(stderr);
    printed_ = Clock::now();
}

void ProgressLine::show(const std::string& text) {
    total_ = 0;
    print(text);
}

void ProgressLine::show(const std::string& text, std::size_t done, std::size_t total) {
    if (done == 0) start_ = Clock::now();
    text_ = text;
    done_ = done;
    total_ = total;
    printed_ = {};
    part(0);
}

void ProgressLine::part(double share) {
    constexpr std::chrono::milliseconds often{100};
    const auto now = Clock::now();
    if (total_ == 0 || now - printed_ < often) return;
    std::string text = text_;
    if (total_ > 1) text += " " + std::to_string(done_ + 1) + " of " + std::to_string(total_);
    const double part = (static_cast<double>(done_) + share) / static_cast<double>(total_);
    if (part > 0) {
        const double left = std::chrono::duration<double>(now - start_).count() * (1 - part) / part;
        std::array<char, 40> known{};
        std::snprintf(known.data(), known.size(), ": %.0f %%, %.0f s left", 100 * part,
                      std::ceil(left));
        text += known.data();
    }
    print(text);
}

fs::path numbered(const fs::path& path, std::size_t number, std::size_t count) {
    if (count == 1) return path;
    return path.parent_path() /
           (path.stem().string() + "-" + std::to_string(number + 1) + path.extension().string());
}
