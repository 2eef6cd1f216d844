// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The hierarchical indicator of fields with several components (paper, section 5.1): the norm of
// their offsets |U_i - sum omega U_i| / scale_i, rounded up.
//
// The norm is taken first and the sweep after it: that is one number a node instead of one for each
// component, and refines less than the norm of swept numbers. Vectors, tensors and colours are
// projected by one S, so all components are within the threshold, or the threshold times their
// scale. At threshold 0 the projection is U, in all components with a finite scale.
#pragma once

#include <vector>

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// How the offsets of several components become one number.
enum class OffsetNorm : std::uint8_t {
    sum,       ///< of the absolute values
    euclid,    ///< the root of the sum of squares: of a tensor Frobenius' norm
    greatest,  ///< of the absolute values
};

/// Which components norm_indicator counts, and how.
struct NormOptions {
    /// One for each component, above 0, in its units; infinite for components that do not count.
    /// By default all are 1, so that thresholds are in the units of the data.
    std::vector<double> scales{};
    OffsetNorm norm = OffsetNorm::euclid;
    Spread spread{};
};

/// \throw InvalidInput where there is not one scale above 0 for each component, a value of a
///        component that counts is not finite, and for a spread as in measured_indicator()
SweptIndicator norm_indicator(const FieldOnGrid& field, const NormOptions& options = {});

}  // namespace nestgrid
