// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The subcommands of the program, and the options that several of them have.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "projection.hpp"
#include "volume.hpp"

/// A subcommand: its options, and what it does once they are parsed.
struct Command {
    CLI::App* options;
    std::function<void()> run;
};

// Each adds one subcommand to the program.
Command add_isosurface(CLI::App& program);
Command add_slice(CLI::App& program);
Command add_boundary(CLI::App& program);
Command add_isolines(CLI::App& program);
Command add_height(CLI::App& program);
Command add_surface(CLI::App& program);
Command add_probe(CLI::App& program);
Command add_info(CLI::App& program);
Command add_mesh(CLI::App& program);
Command add_pack(CLI::App& program);
Command add_view(CLI::App& program);

/// A check for options: what is wrong with the text of a positive finite number, or nothing.
std::string positive_number(const std::string& text);

/// A file with a field.
struct Input {
    std::filesystem::path path;
    std::string array;
    std::string by{};  ///< where it names another field of a .nestgrid, that is component 1
    RawFormat raw;
    std::string endian = "little";
    double read_limit = 0;
};
void add_input_options(CLI::App& command, Input& input);
void add_read_limit(CLI::App& command, double& seconds);
Volume read_volume(Input& input);

/// How finely a surface is drawn, and where it goes.
struct SurfaceOptions {
    std::vector<std::string> thresholds;
    std::vector<std::int64_t> budgets;
    ProjectionChoice projection;
    int threads = 0;
    std::filesystem::path output;
    std::filesystem::path image;
};
void add_surface_options(CLI::App& command, SurfaceOptions& options);
/// \throw nestgrid::InvalidInput for a number that is out of range, and for options that exclude
///        each other
/// \throw nestgrid::IoError where a file cannot be written
void check(const SurfaceOptions& options);

/// Overwrites one line on a terminal; does nothing elsewhere.
class ProgressLine {
public:
    ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine();
    void show(const std::string& text);

private:
    bool terminal_;
};

/// out.vtp for one surface; out-1.vtp, out-2.vtp, ... for several.
std::filesystem::path numbered(const std::filesystem::path& path, std::size_t number,
                               std::size_t count);
