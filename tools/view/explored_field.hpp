// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A field in space, or several frames of one, as an Explorer takes it.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drawing/first_isovalue.hpp"
#include "drawing/frame_field.hpp"

namespace nestgrid::view {

/// How often values occur, in bins of equal width.
struct Histogram {
    static constexpr std::size_t bins = 128;

    double least = 0;
    double greatest = 0;
    std::array<double, bins> counts{};
};

/// \param at at(i) is value i; of many values every n-th is counted
/// \param range of the bins; values outside are not counted
template <class At>
Histogram histogram_of(std::size_t count, const At& at, const std::array<double, 2>& range) {
    constexpr std::size_t most = 4000000;
    Histogram h;
    h.least = range[0];
    h.greatest = range[1];
    const double width = h.greatest - h.least;
    if (!(width > 0)) return h;
    const std::size_t step = (count + most - 1) / most;
    for (std::size_t i = 0; i < count; i += step) {
        const double part = (static_cast<double>(at(i)) - h.least) / width;
        if (!(part >= 0 && part <= 1)) continue;
        const auto bin = static_cast<std::size_t>(part * Histogram::bins);
        ++h.counts[std::min(bin, Histogram::bins - 1)];
    }
    return h;
}

struct ExploredField : FrameField {
    std::string title = "field";  ///< of the page: the name of a file, say
    std::array<Point, 2> box{};   ///< the least and the greatest coordinates of the domain
    std::string length_unit{};    ///< such as mm; empty where it is not known
    std::string note{};           ///< a sentence on what of the file is left out; mostly empty
    std::size_t samples = 0;      ///< of a frame; 0 where the field has nodes
    /// The range of the values of all frames, if known without the nodes beyond the data.
    std::optional<std::array<double, 2>> range{};
    std::optional<std::array<double, 2>> usual_range{};  ///< of nearly all, where few lie far off
    Histogram histogram{};                               ///< of the first frame
    std::optional<double> isovalue{};  ///< to begin with (first_isovalue.hpp), where it is known
};

/// Sets what a page tells of the values of the first frame.
/// \param at at(i) is value i, neighbours mostly one after the other
template <class At>
void describe_values(ExploredField& field, std::size_t count, const At& at) {
    if (count == 0) return;
    const ValueSample sample = value_sample_of(count, at);
    field.usual_range = usual_range(sample);
    const std::array all{sample.least, sample.greatest};
    field.histogram = histogram_of(count, at, field.usual_range.value_or(all));
    field.isovalue = first_isovalue(sample);
}

/// Sets what a page tells of the samples of frames. The grid of a volume has more nodes than these.
template <class Sample>
void describe_samples(ExploredField& field, const std::vector<std::span<const Sample>>& frames) {
    const std::span<const Sample> first = frames.front();
    describe_values(field, first.size(), [&](std::size_t i) { return first[i]; });
    field.samples = first.size();
    std::array<double, 2> range{std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
    for (const auto& frame : frames) {
        for (const Sample sample : frame) {
            // Comparisons with what is not a number are false.
            const auto value = static_cast<double>(sample);
            range = {value < range[0] ? value : range[0], value > range[1] ? value : range[1]};
        }
    }
    field.range = range;
}

/// The box around the coarse grid.
template <class Real>
std::array<Point, 2> box_of(const Hierarchy<Real>& hierarchy);

/// Fields on a grid as the frames of one. Box and values are for the caller to describe: the box is
/// that of the coarse grid. \param times one for each field, ascending \param memory that the grid
/// and the fields borrow from; may be null
template <class Grid, class Field>
ExploredField moving_field(const std::shared_ptr<const Grid>& grid, std::vector<Field> fields,
                           std::vector<double> times,
                           const std::shared_ptr<const void>& memory = nullptr) {
    ExploredField f;
    f.frames = shared_frames(grid, std::move(fields), std::move(times), memory);
    f.box = f.first().visit([](const auto& first) { return box_of(first); });
    return f;
}

/// The same for one field.
template <class Grid, class Field>
ExploredField still_field(const std::shared_ptr<const Grid>& grid, const Field& field,
                          const std::shared_ptr<const void>& memory = nullptr) {
    return moving_field(grid, std::vector{field}, {0}, memory);
}

}  // namespace nestgrid::view
