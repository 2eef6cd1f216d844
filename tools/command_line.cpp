// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <nestgrid/error.hpp>

#include "surface_file.hpp"

namespace fs = std::filesystem;

std::string positive_number(const std::string& text) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (*end == '\0' && number > 0 && std::isfinite(number)) return "";
    return "'" + text + "' is no positive finite number";
}

void add_read_limit(CLI::App& command, double& seconds) {
    command
        .add_option("--read-limit", seconds,
                    "seconds after which a file is refused that is still being read; default: 60 "
                    "and one for each MB, ten times that for .poly and .smesh")
        ->check(positive_number);
}

void add_input_options(CLI::App& command, Input& input) {
    command
        .add_option("INPUT", input.path,
                    ".vti, .mhd, .mha, .nrrd, .nhdr, .nii, .nii.gz, .raw or .nestgrid")
        ->required();
    command.add_option("--array", input.array,
                       "point data array of a .vti file, field of a .nestgrid");
    command.add_option("--dims", input.raw.dims, "samples of a .raw file along x,y,z")
        ->delimiter(',');
    command.add_option("--type", input.raw.type,
                       "their type: uint8, int8, uint16, int16, uint32, int32, uint64, int64, "
                       "float32, float64");
    command.add_option("--endian", input.endian, "their byte order")
        ->check(CLI::IsMember({"little", "big"}))
        ->capture_default_str();
    command.add_option("--spacing", input.raw.spacing, "their distances along x,y,z")
        ->delimiter(',');
    add_read_limit(command, input.read_limit);
}

Volume read_volume(Input& input) {
    input.raw.big_endian = input.endian == "big";
    return read_volume(input.path, input.array, input.raw, input.read_limit);
}

void add_surface_options(CLI::App& command, SurfaceOptions& options) {
    command
        .add_option("--threshold", options.thresholds,
                    "detail up to this is projected away: in units of --indicator, or in percent "
                    "of the range of the data (2%); give it again for several")
        ->take_all();
    command
        .add_option(
            "--max-triangles", options.budgets,
            "in the place of a threshold: the least one, in units of --indicator, that gives "
            "no more triangles, or segments of lines in the plane; give it again for "
            "several")
        ->take_all()
        ->excludes("--threshold");
    add_projection_options(command, options.projection);
    command.add_option("--threads", options.threads,
                       "how many to use; default: all. The surface does not depend on it");
    command.add_option("-o,--output", options.output, ".vtp, .ply, .stl, .obj or .gltf");
    command.add_option("--image", options.image, "a picture, .png");
}

void check(const SurfaceOptions& options) {
    for (const std::int64_t budget : options.budgets) {
        if (budget <= 0) throw nestgrid::InvalidInput("--max-triangles is not positive");
    }
    check(options.projection);
    if (options.threads < 0) throw nestgrid::InvalidInput("--threads is negative");
    if (!options.output.empty()) check_output(options.output);
    if (options.image.empty()) return;
    check_output(options.image);
    if (options.image.extension() != ".png") {
        throw nestgrid::IoError("'" + options.image.string() + "' is no name of a .png picture");
    }
}

ProgressLine::ProgressLine() : terminal_{isatty(STDERR_FILENO) == 1} {}
ProgressLine::~ProgressLine() {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
}
void ProgressLine::show(const std::string& text) {
    if (!terminal_) return;
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    std::fflush(stderr);
}

fs::path numbered(const fs::path& path, std::size_t number, std::size_t count) {
    if (count == 1) return path;
    return path.parent_path() /
           (path.stem().string() + "-" + std::to_string(number + 1) + path.extension().string());
}
