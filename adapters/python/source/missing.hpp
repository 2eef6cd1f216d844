// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Holes around missing values, found in calls that Ctrl-C ends.
#pragma once

#include <vector>

#include <nestgrid/algorithms/holes.hpp>

#include "call.hpp"

namespace nestgrid::python {

/// The elements of a grid that any of several fields on it hides.
/// \throw Stopped where the call is to end
template <class Real>
std::shared_ptr<const HiddenElements> find_hidden(const std::vector<const Hierarchy<Real>*>& fields,
                                                  const Call& call) {
    std::vector<std::unique_ptr<const Hierarchy<Real>>> stoppable;
    std::vector<const Hierarchy<Real>*> asked;
    for (const Hierarchy<Real>* field : fields) {
        stoppable.push_back(call.stoppable(*field));
        asked.push_back(stoppable.back().get());
    }
    return HiddenElements::of_all<Real>(asked);
}

}  // namespace nestgrid::python
