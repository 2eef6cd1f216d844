// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// The walk of a preroll over any hierarchy, with one thread or several. Several threads walk parts
// of the hierarchy and log what they meet, while the executor repeats finished logs in order.
#pragma once

#include <indicators/sweeps.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// What a preroll computes beside offsets.
struct PrerollRequest {
    const LeafErrors* leaf_errors;  ///< empty where leaves have none
    bool measures = false;          ///< distances count; the walk must carry positions then
    bool deviations = false;        ///< of elements
};

/// Tells `sweeps` of all splits of a hierarchy, and of its leaves where leaves have errors, else of
/// its coarse leaves.
/// \param walk must carry values and keys
/// \throw InvalidInput where a value or an error is not usable
template <class Real>
detail::PrerollFacts walk_preroll(const Walk<Real>& walk, const PrerollRequest& request,
                                  Sweeps& sweeps, const Executor& executor);

}  // namespace nestgrid::engine
