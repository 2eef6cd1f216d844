// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Times between frames, on the command line.
#pragma once

#include <optional>
#include <vector>

#include "input/input_field.hpp"
#include "options/command_line.hpp"

/// The frames behind the first one, and which times are drawn.
struct TimeOptions {
    std::vector<std::filesystem::path> more;
    std::vector<double> times;   ///< of all frames; empty for those of the file, or 0, 1, 2, ...
    std::optional<double> time;  ///< the one that is drawn
    std::optional<int> frames;   ///< or so many, from the first to the last
    bool cubic = false;          ///< interpolated by cubic polynomials

    /// Whether anything is drawn between frames.
    bool in_use() const { return time || frames; }
    /// The frames of a file that are needed.
    WantedFrames wanted() const { return in_use() ? WantedFrames::all : WantedFrames::one; }
    /// \param of_frames times of the frames
    std::vector<double> drawn_times(const std::vector<double>& of_frames) const;
    /// \throw nestgrid::InvalidInput where t does not lie between the first and the last frame
    std::vector<float> weights(const std::vector<double>& of_frames, double t) const;
};

void add_time_options(CLI::App& command, TimeOptions& options);

/// Checks what can be checked before frames are read.
/// \throw nestgrid::InvalidInput where there are several inputs without a time or a film, or a time
///        without several frames, and for times that do not ascend
void check(const TimeOptions& time);

/// \throw nestgrid::InvalidInput where a film has no .vtp file to go to, or several thresholds
void check_film(const TimeOptions& time, const SurfaceOptions& surface);

/// \throw nestgrid::InvalidInput unless a time is in use if and only if there are several frames
void require_frames(const TimeOptions& time, const std::vector<double>& of_frames,
                    const std::filesystem::path& input);
