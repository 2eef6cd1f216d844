// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces that C codes own.
#pragma once

#include <memory>
#include <string>

#include <nestgrid/algorithms/isosurface.h>
#include <nestgrid/algorithms/drawing.hpp>

#include "ranks_in_c.hpp"

namespace nestgrid {

/// A surface that a C code owns, by the pointer `owner` of its nestgrid_surface.
template <int dimension>
struct Drawn {
    Projected<Isosurface<dimension>> result;
    std::string budget_text;
    std::shared_ptr<const PartOnRanks> part;  ///< where ranks have drawn it
};

/// Hands a surface to a C code, which frees it.
/// \param part what ranks share that have drawn it; null without ranks
template <int dimension>
void hand_over(Projected<Isosurface<dimension>> result, std::shared_ptr<const PartOnRanks> part,
               nestgrid_surface& out) {
    const std::string reason = result.budget_reason();
    auto drawn = std::make_unique<Drawn<dimension>>(
        Drawn<dimension>{std::move(result), reason, std::move(part)});
    const Isosurface<dimension>& kept = drawn->result;
    out.vertex_count = kept.surface.vertices.size();
    out.simplex_count = kept.surface.simplices.size();
    if (out.vertex_count > 0) out.vertices = kept.surface.vertices.front().data();
    if (out.simplex_count > 0) out.simplices = kept.surface.simplices.front().data();
    out.dimension = dimension;
    out.error_bound = kept.error_bound;
    out.range_bound = kept.range_bound;
    out.bound_says_nothing = kept.bound_says_nothing() ? 1 : 0;
    out.visited = kept.counts.visited;
    out.extracted = kept.counts.extracted;
    out.owner = drawn.release();
}

}  // namespace nestgrid
