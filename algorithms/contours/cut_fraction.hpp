// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace nestgrid {

/// Where an edge is cut, seen from its lower end: nowhere nearer than this to an end, in edges.
inline constexpr double least_cut_fraction = 0x1p-20;

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

}  // namespace nestgrid
