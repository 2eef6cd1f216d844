// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A field in space, or several frames of one, as an Explorer takes it.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "../frame_field.hpp"

namespace nestgrid::view {

/// How often values occur, in bins of equal width from the least value to the greatest one.
struct Histogram {
    static constexpr std::size_t bins = 128;

    double least = 0;
    double greatest = 0;
    std::array<double, bins> counts{};

    /// A value that parts the data in two, so that values vary little within both parts (Otsu
    /// 1979); the middle of the range where the data are constant or not known.
    double dividing_value() const;
};

/// \param at at(i) is value i; of many values every n-th is counted
template <class At>
Histogram histogram_of(std::size_t count, const At& at) {
    constexpr std::size_t most = 4000000;
    Histogram h;
    if (count == 0) return h;
    h.least = h.greatest = static_cast<double>(at(std::size_t{0}));
    const std::size_t step = (count + most - 1) / most;
    for (std::size_t i = 0; i < count; i += step) {
        const auto value = static_cast<double>(at(i));
        h.least = std::min(h.least, value);
        h.greatest = std::max(h.greatest, value);
    }
    const double width = h.greatest - h.least;
    if (!(width > 0)) return h;
    for (std::size_t i = 0; i < count; i += step) {
        const double part = (static_cast<double>(at(i)) - h.least) / width;
        const auto bin = static_cast<std::size_t>(part * Histogram::bins);
        ++h.counts[std::min(bin, Histogram::bins - 1)];
    }
    return h;
}

struct ExploredField : FrameField {
    std::string title = "field";  ///< of the page: the name of a file, say
    std::array<Point, 2> box{};   ///< the least and the greatest coordinates of the domain
    Histogram histogram{};        ///< of the first frame
};

/// The box around the coarse grid.
template <class Real>
std::array<Point, 2> box_of(const Hierarchy<Real>& hierarchy);

/// Fields on a grid as the frames of one. Box and histogram are for the caller to set: those of the
/// coarse grid, and none.
/// \param times one for each field, ascending
/// \param memory that the grid and the fields borrow from; may be null
template <class Grid, class Field>
ExploredField moving_field(std::shared_ptr<const Grid> grid, std::vector<Field> fields,
                           std::vector<double> times,
                           std::shared_ptr<const void> memory = nullptr) {
    ExploredField f;
    set_frames(f, std::move(grid), std::move(fields), std::move(times), std::move(memory));
    f.box = std::visit([](const auto& first) { return box_of(*first); }, f.frames.front());
    return f;
}

/// The same for one field.
template <class Grid, class Field>
ExploredField still_field(std::shared_ptr<const Grid> grid, const Field& field,
                          std::shared_ptr<const void> memory = nullptr) {
    return moving_field(std::move(grid), std::vector{field}, {0}, std::move(memory));
}

}  // namespace nestgrid::view
