// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <type_traits>

#include <walk/walk.hpp>

namespace nestgrid::engine {

/// Takes an element and its refinement.
template <class Real>
using ElementFunction =
    std::type_identity_t<std::function<void(const ElementView<Real>&, const Split&)>>;

/// Calls a function for every element, depth first, leaves (split.rule is null there) and hidden
/// ones included, with the true values at the corners, hanging nodes interpolated.
/// \param splits_only leaves out leaves below the coarse grid
template <class Real>
void for_each_element(const Walk<Real>& walk, bool splits_only,
                      const ElementFunction<Real>& function);

/// Calls a function in the same way for every element on one level.
template <class Real>
void for_each_on_level(const Walk<Real>& walk, int level, const ElementFunction<Real>& function);

/// The number of levels of a hierarchy, 1 for a coarse grid alone.
template <class Real>
int count_levels(const Walk<Real>& walk);

}  // namespace nestgrid::engine
