// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/algorithms/surface.hpp>
#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

/// Brings each connected part of the segments of all ranks to the least rank that has any of it.
/// Collective, four exchanges and one gathering of pairs of parts.
/// \param segments of this rank; elements are dropped
/// \param names of their vertices, the same on all ranks
void join_lines(Surface<2>& segments, std::span<const std::array<NodeKey, 2>> names,
                const SharedNodes& shared);

}  // namespace nestgrid::engine
