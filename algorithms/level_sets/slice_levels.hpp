// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Functions of position as level functions of a walk, in front of isosurfaces of the field.
#pragma once

#include <level_sets/draw.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

/// Calls draw(levels) with the levels of a request.
template <class Real, class Draw>
auto with_levels(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                 const IsosurfaceOptions& options, Draw&& draw) {
    const std::size_t functions = request.functions.size();
    const WidenedHierarchy<Real> widened(hierarchy, functions);
    std::optional<PositionFunctions> placed;
    Levels<double> levels{&widened, {}};
    together(hierarchy.facts().shared, "slices", [&] {
        hierarchy.facts().require_dimension(3);
        placed.emplace(request.functions, widened, options.position_bounds);
        levels = isosurface_levels<double>(widened, request.isovalues);
    });
    for (auto& level : levels.levels) level = Level<double>(level.value, functions);
    for (std::size_t i = functions; i-- > 0;) {
        levels.levels.insert(levels.levels.begin(), Level<double>(0, i, 0));
    }
    levels.first_attribute = functions;
    levels.functions = &*placed;
    return draw(levels);
}

}  // namespace nestgrid::engine
