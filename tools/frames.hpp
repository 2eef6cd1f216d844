// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of one field, in several files of one layout, and the times between them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/region.hpp>

#include "command_line.hpp"

/// The frames behind the first one, and which times are drawn.
struct TimeOptions {
    std::vector<std::filesystem::path> more;
    std::vector<double> times;   ///< of all frames; empty for 0, 1, 2, ...
    std::optional<double> time;  ///< the one that is drawn
    std::optional<int> frames;   ///< or so many, from the first to the last
    bool cubic = false;          ///< interpolated by cubic polynomials

    /// Whether anything is drawn between frames.
    bool in_use() const { return time || frames; }
    std::vector<double> frame_times() const;
    std::vector<double> drawn_times() const;
    std::vector<float> weights(double t) const;
};

void add_time_options(CLI::App& command, TimeOptions& options);

/// \throw nestgrid::InvalidInput unless there are several inputs if and only if there is a time or
///        a film, at times that ascend, and a film has one threshold and a .vtp file to go to
void check(const TimeOptions& time, const SurfaceOptions& surface);

/// Frames on their grid, with their prerolls.
class Frames {
public:
    using Inside = std::function<bool(const nestgrid::Point&)>;

    virtual ~Frames() = default;
    Frames(const Frames&) = delete;
    Frames& operator=(const Frames&) = delete;

    /// Calls take(hierarchy, indicator) with the field at the time of some weights, a
    /// nestgrid::Hierarchy<float> or <double>.
    template <class Taken>
    void at(std::span<const float> weights, const Taken& take) const {
        at_weights(weights, take, take);
    }
    virtual nestgrid::Region region(const Inside& inside) const = 0;

    std::string name;  ///< of the field
    int dimension = 3;
    std::size_t nodes = 0;
    std::size_t leaf_elements = 0;
    double least = 0;  ///< of all frames
    double greatest = 0;
    double preroll_seconds = 0;
    std::size_t preroll_bytes = 0;

protected:
    template <class Real>
    using Take = std::function<void(const nestgrid::Hierarchy<Real>&, const nestgrid::KeyFrames&)>;

    Frames() = default;
    virtual void at_weights(std::span<const float> weights, const Take<float>& as_float,
                            const Take<double>& as_double) const = 0;
};

/// Reads the frames, makes their prerolls and calls function(frames).
/// \throw nestgrid::IoError, nestgrid::InvalidInput as with_field(), and where the files have not
///        one layout
void with_frames(Input& input, const TimeOptions& time, int threads,
                 const std::function<void(const Frames&)>& function);
