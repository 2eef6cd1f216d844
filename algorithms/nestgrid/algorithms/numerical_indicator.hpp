// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The numerical indicator (paper, section 4.2): the jumps of the gradient that estimators of finite
// element solvers measure.
//
// eta of a node is the greatest difference between the gradients at it of component 0 in the
// elements that make it, times the greatest diameter of these, so in units of the data: about 8
// times the offset |U - sum omega U| where the data are smooth. Inside an element and on the
// boundary there is one gradient, and no jump. Jumps predict what a split will show; they do not
// see a peak at one node. So eta is never below the offset, and at threshold 0 the projection is U.
// Memory, while it is made: 28 bytes a node more than swept_indicator.hpp says.
#pragma once

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// What numerical_indicator may be told.
struct NumericalOptions {
    Spread spread{};
};

/// \throw InvalidInput where a value of the field is not finite, and for a spread as in
///        measured_indicator()
SweptIndicator numerical_indicator(const FieldOnGrid& field, const NumericalOptions& options = {});

}  // namespace nestgrid
