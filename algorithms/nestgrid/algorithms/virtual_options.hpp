// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a virtual refinement of leaves of higher degree is asked for (high_order.hpp).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <nestgrid/algorithms/level_function.hpp>
#include <nestgrid/algorithms/projection.hpp>

namespace nestgrid {

/// How finely leaves are divided.
struct VirtualOptions {
    double tolerance = 0;  ///< in the units of the data; at least 1e-12 of their range
    int depth = 8;         ///< leaves are halved at most this many times, 1 to 16
    /// Elements stop only where they are as small as the lens asks, too, or at the depth limit. Its
    /// `finest` is positive.
    std::optional<LensRequest> lens{};
    /// Elements in the region, or as near to it as three times their size, stop only within its
    /// threshold, which is another tolerance, too.
    std::optional<RegionRequest> region{};
    /// How far points of curved leaves may be from where they are drawn, in units of length; 0: the
    /// same share of the diameter of the domain as the tolerance is of the range of the data.
    double position_tolerance = 0;
    /// Level sets of component 0 that are drawn, each from a least to a greatest value: leaves that
    /// none passes through are not looked at. What is drawn in them all the same counts as met by
    /// the depth limit, with an error of the whole range. A cap takes all values from its isovalue
    /// on. Default: everything is drawn.
    std::optional<std::vector<std::array<double, 2>>> values{};
    /// With `values`: the functions whose zeros are drawn beside these, borrowed until the
    /// refinement is made, and whether the boundary of the domain is, all of it or in a part.
    std::vector<const LevelFunction*> functions{};
    bool boundary = false;
};

}  // namespace nestgrid
