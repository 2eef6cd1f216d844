// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The gradient of the linear function that fits values around a place best, near ones most.
#pragma once

#include <vector>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

/// A value and where it is, seen from the place.
struct FitSample {
    Point offset;
    double value;

    bool operator==(const FitSample&) const = default;
    bool operator<(const FitSample& other) const {
        return offset != other.offset ? offset < other.offset : value < other.value;
    }
};

struct LinearFit {
    Point gradient{0, 0, 0};
    int rank = 0;  ///< of the directions in which the samples tell how the function changes
};

/// The order of the samples decides the last bits.
/// \param dimension the greatest rank
LinearFit fit_linear(const std::vector<FitSample>& samples, int dimension);

}  // namespace nestgrid::engine
