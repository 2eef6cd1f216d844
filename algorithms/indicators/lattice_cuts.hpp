// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <indicators/path_cuts.hpp>
#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid::engine {

/// The numbers that PathCuts reports, as bfloat16 by key, on lattices of bisected simplices
/// (lattice_walk.hpp). Requires bisects_by_keys().
template <class Real>
std::vector<std::uint16_t> lattice_cuts(const Hierarchy<Real>& hierarchy, const CutRequest& request,
                                        const Executor& executor);

}  // namespace nestgrid::engine
