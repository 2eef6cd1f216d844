// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The samples of a volume as a field to explore.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <nestgrid/adapters/bisection.hpp>

#include "explored_field.hpp"

namespace nestgrid::view {

/// The box around a lattice.
inline std::array<Point, 2> box_of(const LatticeGeometry<3>& g) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<Point, 2> box{Point{infinity, infinity, infinity},
                             Point{-infinity, -infinity, -infinity}};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        for (std::size_t r = 0; r < 3; ++r) {
            double x = g.origin[r];
            for (std::size_t d = 0; d < 3; ++d) {
                const int cells = (corner >> d & 1U) != 0 ? g.samples[d] - 1 : 0;
                x += g.direction[r][d] * g.spacing[d] * cells;
            }
            box[0][r] = std::min(box[0][r], x);
            box[1][r] = std::max(box[1][r], x);
        }
    }
    return box;
}

/// Hides elements beside samples that are not a number, where there are any.
template <class Sample>
void hide_missing_samples(ExploredField& field,
                          const std::vector<std::span<const Sample>>& frames) {
    if constexpr (std::is_floating_point_v<Sample>) {
        const auto has_missing = [](std::span<const Sample> frame) {
            return std::ranges::any_of(frame, [](Sample value) { return std::isnan(value); });
        };
        if (std::ranges::any_of(frames, has_missing)) field.frames = field.frames.without_missing();
    }
}

/// The samples of a volume, x fastest.
/// \param memory that holds the samples, or null where they outlive the field
/// \throw InvalidInput as LatticeBisection and LatticeField
template <class Sample>
ExploredField explored_samples(const LatticeGeometry<3>& geometry, std::span<const Sample> samples,
                               const std::shared_ptr<const void>& memory = nullptr) {
    using Grid = LatticeBisection<3>;
    const auto grid = std::make_shared<const Grid>(geometry);
    ExploredField f = still_field(grid, LatticeField<Grid, Sample>(*grid, samples), memory);
    hide_missing_samples(f, std::vector{samples});
    f.box = box_of(geometry);
    describe_samples(f, std::vector{samples});
    return f;
}

/// Frames of a volume, one after the other in time.
/// \param times one for each frame, ascending
template <class Sample>
ExploredField explored_samples(const LatticeGeometry<3>& geometry,
                               const std::vector<std::span<const Sample>>& frames,
                               std::vector<double> times,
                               const std::shared_ptr<const void>& memory = nullptr) {
    using Grid = LatticeBisection<3>;
    const auto grid = std::make_shared<const Grid>(geometry);
    std::vector<LatticeField<Grid, Sample>> fields;
    for (const auto& samples : frames) fields.emplace_back(*grid, samples);
    ExploredField f = moving_field(grid, std::move(fields), std::move(times), memory);
    hide_missing_samples(f, frames);
    f.box = box_of(geometry);
    describe_samples(f, frames);
    return f;
}

}  // namespace nestgrid::view
