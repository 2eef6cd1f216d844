// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "options/time_options.hpp"

#include <algorithm>
#include <cstdio>

#include <nestgrid/algorithms/frame_weights.hpp>
#include <nestgrid/error.hpp>

#include "input/frame_files.hpp"
#include "input/input_file.hpp"
#include "input/standard_input.hpp"

using nestgrid::InvalidInput;

namespace {

/// \throw InvalidInput unless there are several frames, and three where cubic polynomials differ
///        from lines
void require_several_frames(const TimeOptions& time, std::size_t count) {
    if (count < 2) {
        throw InvalidInput("--time and --frames need several inputs, or one with several frames");
    }
    if (time.cubic && count < 3) {
        throw InvalidInput("--cubic needs at least three frames: between two it is the line");
    }
}

/// \throw InvalidInput where a time is drawn that does not lie between the frames
void check_times(const TimeOptions& time, const std::vector<double>& of_frames) {
    for (const double t : time.drawn_times(of_frames)) time.weights(of_frames, t);
}

}  // namespace

std::vector<double> TimeOptions::drawn_times(const std::vector<double>& of_frames) const {
    if (time) return {*time};
    std::vector<double> drawn;
    for (int i = 0; i < *frames; ++i) {
        drawn.push_back(of_frames.front() +
                        i * (of_frames.back() - of_frames.front()) / (*frames - 1));
    }
    drawn.back() = of_frames.back();
    return drawn;
}

std::vector<float> TimeOptions::weights(const std::vector<double>& of_frames, double t) const {
    return cubic ? nestgrid::catmull_rom_weights(of_frames, t)
                 : nestgrid::linear_weights(of_frames, t);
}

void add_time_options(CLI::App& command, TimeOptions& options) {
    command.add_option("FRAMES", options.more,
                       "later frames of the same field, for --time or --frames");
    CLI::Option* time =
        command.add_option("--time", options.time, "draw at this time between the frames")
            ->type_name("TIME")
            ->group("Time");
    command
        .add_option("--frames", options.frames,
                    "draw so many times from the first frame to the last, as a film: "
                    "OUTPUT_0000.vtp, OUTPUT_0001.vtp, ... and OUTPUT.pvd")
        ->type_name("COUNT")
        ->group("Time")
        ->excludes(time);
    command
        .add_option("--times", options.times,
                    "times of all frames, ascending [those of the file, or 0,1,2,...]")
        ->type_name("T,T,...")
        ->group("Time")
        ->delimiter(',');
    command
        .add_flag("--cubic", options.cubic,
                  "interpolate by cubic polynomials (Catmull and Rom) instead of lines")
        ->group("Time");
}

void check(const TimeOptions& time) {
    if (!time.in_use()) {
        if (!time.more.empty()) {
            throw InvalidInput("several inputs need a --time between them, or --frames for a film");
        }
        if (!time.times.empty() || time.cubic) {
            throw InvalidInput("--times and --cubic need --time or --frames");
        }
        return;
    }
    if (time.frames && *time.frames < 2) throw InvalidInput("--frames is below 2");
    if (std::ranges::any_of(time.more, is_standard_stream)) {
        throw InvalidInput("only the first input can be standard input");
    }
    if (time.more.empty()) return;
    require_several_frames(time, time.more.size() + 1);
    // Files may tell other times than 0, 1, 2, ...: require_frames() has them.
    if (time.times.empty()) return;
    check_times(time, times_of_frames(time.times, times_of_files(time.more.size() + 1)));
}

void check_film(const TimeOptions& time, const SurfaceOptions& surface) {
    if (!time.frames) return;
    if (ending_of(surface.output) != ".vtp") {
        throw InvalidInput("a film needs an --output with the name of a .vtp file");
    }
    if (!surface.picture.image.empty()) throw InvalidInput("--image draws no films");
    if (surface.thresholds.size() > 1) throw InvalidInput("a film has one --threshold");
    if (surface.budgets.size() > 1) throw InvalidInput("a film has one --max-triangles");
}

void require_frames(const TimeOptions& time, const std::vector<double>& of_frames,
                    const std::filesystem::path& input) {
    if (time.in_use()) {
        require_several_frames(time, of_frames.size());
        check_times(time, of_frames);
    } else if (of_frames.size() > 1) {
        std::array<char, 120> text{};
        std::snprintf(text.data(), text.size(), "' has %zu frames, from time %.6g to %.6g",
                      of_frames.size(), of_frames.front(), of_frames.back());
        throw InvalidInput("'" + input.string() + text.data() +
                           ": give a --time between them, or --frames for a film");
    }
}
