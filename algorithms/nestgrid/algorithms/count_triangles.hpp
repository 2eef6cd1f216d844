// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How many triangles a shading or a height field would have.
#pragma once

#include <cstdint>
#include <optional>

#include <nestgrid/algorithms/projected.hpp>
#include <nestgrid/algorithms/shading_options.hpp>

namespace nestgrid {

/// The number of triangles that a shading, or a height field of any scale, has, or nothing where
/// there are more than `most`. Counts up to there, and stores no triangle.
/// \param options only flatness and progress have an effect
/// \throw InvalidInput, GridError as shading()
std::optional<std::uint64_t> count_triangles(const Prerolls& prerolls, const Projection& projection,
                                             std::uint64_t most, const ShadingOptions& options = {},
                                             const Work& work = {});

}  // namespace nestgrid
