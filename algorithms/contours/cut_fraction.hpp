// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace nestgrid::engine {

/// Cuts keep this distance from both ends of an edge, in lengths of the edge.
inline constexpr double least_cut_fraction = 0x1p-20;

/// The place of a cut on an edge, from 0 at its lower to 1 at its higher end.
/// \tparam Number double, or several at once
/// \param low, high U at the ends, low < isovalue <= high
/// \param least, most least_cut_fraction, and 1 less it
template <class Number>
constexpr Number cut_fraction(const Number& isovalue, const Number& low, const Number& high,
                              const Number& least, const Number& most) {
    using std::max;
    using std::min;
    return min(max((isovalue - low) / (high - low), least), most);
}

constexpr double cut_fraction(double isovalue, double low, double high) {
    return cut_fraction(isovalue, low, high, least_cut_fraction, 1 - least_cut_fraction);
}

}  // namespace nestgrid::engine
