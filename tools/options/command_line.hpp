// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The options that several subcommands have.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "commands/command.hpp"
#include "drawing/projection.hpp"
#include "formats.hpp"
#include "input/volume.hpp"
#include "output/report.hpp"
#include "picture/picture_options.hpp"

/// \throw nestgrid::InvalidInput where one of the options is given: "--name why"
void refuse_options(const CLI::App& command, const std::vector<std::string>& names,
                    const std::string& why);

/// A check for options: what is wrong with the text of a positive finite number, or nothing.
std::string positive_number(const std::string& text);

/// A check for options: the text must be one of these words.
/// \param synonyms words that others use, each with the one that it means here
CLI::Validator one_of(std::vector<std::string> words,
                      std::map<std::string, std::string> synonyms = {});

/// A file with a field.
struct Input {
    std::filesystem::path path;
    std::string array;
    std::string by{};  ///< where it names another field of the file, that is component 1
    std::string cells = "smooth";  ///< the rule of values at nodes, where cells have them
    VolumeChoice choice{};         ///< its array and its label aside
    std::vector<double> labels{};  ///< of parts; at most one where a field is read
    std::string format{};          ///< of standard input: an ending
    RawFormat raw;
    std::string endian = "little";
    double read_limit = 0;
    const CLI::App* command = nullptr;  ///< that it is an option of
};
/// Adds INPUT; the options that say how it is read follow at the end of a command.
void add_input(CLI::App& command, Input& input);
/// Adds the options that say how it is read.
void add_read_options(CLI::App& command, Input& input);
void add_read_limit(CLI::App& command, double& seconds);
/// Keeps standard input in a file where it is the input.
/// \throw nestgrid::InvalidInput for an option that means nothing for a file of this format
/// \throw nestgrid::IoError, nestgrid::InvalidInput as keep_standard_input()
void open(Input& input);
/// \param all_frames whether all of them are read, unless one is chosen
/// \throw nestgrid::InvalidInput for several labels
std::vector<Volume> read_volumes(Input& input, bool all_frames);

/// How finely a surface is drawn, and where it goes.
struct SurfaceOptions {
    std::vector<std::string> thresholds;
    std::vector<std::int64_t> budgets;
    nestgrid::Projection projection;
    int threads = 0;
    std::filesystem::path output;
    std::string output_format{};  ///< of standard output: an ending
    SurfaceEncoding encoding{};   ///< of files
    bool elements = false;        ///< files tell the element of each triangle
    PictureOptions picture;
    const CLI::App* command = nullptr;  ///< that they are options of

    /// The ending of the format of the output, with its dot.
    std::string output_ending() const;
};
/// \param of_isosurface whether indicators of one isosurface can be chosen, too
void add_surface_options(CLI::App& command, SurfaceOptions& options, bool of_isosurface = false);
void add_elements_option(CLI::App& command, SurfaceOptions& options);
/// \throw nestgrid::InvalidInput for a number that is out of range, and for options that exclude
///        each other
/// \throw nestgrid::IoError where a file cannot be written
void check(const SurfaceOptions& options);

/// Says that nothing was kept where there is neither an output nor a picture.
void say_what_was_kept(const SurfaceOptions& options, Report& report);

/// Overwrites one line on a terminal; does nothing elsewhere. Where the work is known, the line has
/// the share that is done of it and the time that the rest will take.
class ProgressLine {
public:
    ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine();
    /// Work whose share is not known.
    void show(const std::string& text);
    /// One of several like pieces of work.
    /// \param done of `total` pieces; the first call has 0
    void show(const std::string& text, std::size_t done, std::size_t total);
    /// How much of the piece at hand is done, from 0 to 1; nothing is shown where the last show()
    /// had no pieces.
    void part(double share);

private:
    using Clock = std::chrono::steady_clock;

    void print(const std::string& text);

    bool terminal_;
    std::string text_;
    std::size_t done_ = 0;
    std::size_t total_ = 0;  // 0: not known
    Clock::time_point start_;
    Clock::time_point printed_;
};

/// out.vtp for one surface; out-1.vtp, out-2.vtp, ... for several.
std::filesystem::path numbered(const std::filesystem::path& path, std::size_t number,
                               std::size_t count);
