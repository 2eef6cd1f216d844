// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A triangulation while it is drawn: its surface, recorded nodes and counts. The leader adds those
// of its tasks.
#pragma once

#include <cstdint>

#include <graphs/edge_nodes.hpp>
#include <nestgrid/algorithms/ranks.hpp>
#include <nestgrid/algorithms/shading_options.hpp>
#include <surfaces/level_surface.hpp>
#include <surfaces/simplex_tally.hpp>

namespace nestgrid::engine {

struct DrawnGraph {
    LevelSurface<3> surface;
    EdgeNodes nodes{};  ///< inside closed edges, recorded in the first of two walks
    TraversalCounts counts{};
    SimplexTally tally{};  ///< of triangles, where these are counted only

    /// Only counts triangles from now on. Adding throws OverLimit where there are more than `most`.
    void count_only(std::uint64_t most);
    /// Adds all but the counts of a task, the tasks in their order.
    /// \param part the surface that the task drew
    /// \throw OverLimit
    void add(const DrawnGraph& task, const SurfacePart<3>& part);
    /// Takes the counts and bounds of all ranks together. Collective.
    void agree(Ranks& ranks);
    /// Puts everything but the surface into a result.
    void report(Shading& result) const;
};

}  // namespace nestgrid::engine
