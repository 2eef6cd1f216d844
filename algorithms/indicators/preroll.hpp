// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The walk of a preroll over any hierarchy, by one thread or several. Several threads walk parts of
// the hierarchy and log what they meet; the logs are repeated one after the other, beside the walks
// that go on.
#pragma once

#include <indicators/sweeps.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// Tells sweeps of all splits of a hierarchy, and of its leaves where leaves have errors; else of
/// its coarse leaves.
/// \param walk with values and keys
/// \param leaf_errors empty where leaves have none
/// \param measures whether distances count; then the walk must have positions
/// \throw InvalidInput where a value or an error is not usable
template <class Real>
detail::PrerollFacts walk_preroll(const Walk<Real>& walk, const LeafErrors& leaf_errors,
                                  bool measures, Sweeps& sweeps, const Executor& executor);

}  // namespace nestgrid::engine
