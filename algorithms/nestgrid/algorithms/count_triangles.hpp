// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How many triangles a shading or a height field would have.
#pragma once

#include <cstdint>
#include <optional>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/shading_options.hpp>

namespace nestgrid {

/// The number of triangles that a shading, or a height field of any scale, has under a criterion,
/// or nothing where there are more than `most`. Counts up to there, and stores no triangle.
/// \param options only flatness and progress have an effect
/// \throw InvalidInput, GridError as shading()
template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const ShadingOptions& options = {},
                                             const Executor& executor = SequentialExecutor{});
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
std::optional<std::uint64_t> count_triangles(const Grid& grid, const Field& field,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const ShadingOptions& options = {},
                                             const Executor& executor = SequentialExecutor{}) {
    return count_triangles(erase(grid, field), criterion, bounds, most, options, executor);
}

}  // namespace nestgrid
