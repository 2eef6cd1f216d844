// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ranks/shared_nodes.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// The nodes of this rank that hang, on leaves of any rank: it probes the edges and faces of its
/// own leaves, and those that others tell it of theirs (hanging_probe.hpp). Collective, one
/// exchange.
///
/// \throw GridError on all ranks, as derive_hanging_nodes() of the whole grid
HangingNodes hanging_across(const Hierarchy<float>& grid, const SharedNodes& shared);

}  // namespace nestgrid::engine
