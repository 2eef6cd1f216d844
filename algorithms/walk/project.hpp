// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The adaptive projection P_S U as a function on the adaptive grid (paper, sections 2 and 3).
#pragma once

#include <functional>
#include <type_traits>

#include <nestgrid/algorithms/criterion.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

template <class Real>
using ExtractFunction = std::type_identity_t<std::function<void(const ElementView<Real>&)>>;

/// Calls a function for every element of the adaptive grid, in order; view.value holds P_S U at its
/// corners.
/// \param walk must carry values and keys, and positions where the criterion wants them, and must
///        know the indicator's hanging nodes
template <class Real>
void project(const Walk<Real>& walk, const Criterion& criterion,
             const ExtractFunction<Real>& function);

}  // namespace nestgrid::engine
