// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn beside the data, by probing them.
#pragma once

#include <nestgrid/algorithms/probe.hpp>

#include "closedness.hpp"

namespace nestgrid_test {

/// |U - isovalue| at those of some points that lie in the domain.
inline std::vector<double> differences(const Hierarchy<double>& h, std::span<const Point> points,
                                       double isovalue) {
    const ProbeResult found = probe(h, points);
    std::vector<double> off;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (found.found(i)) off.push_back(std::abs(found.values[i] - isovalue));
    }
    return off;
}

/// The greatest of them.
inline double greatest_difference(const Hierarchy<double>& h, std::span<const Point> points,
                                  double isovalue) {
    double greatest = 0;
    for (const double off : differences(h, points, isovalue)) greatest = std::max(greatest, off);
    return greatest;
}

}  // namespace nestgrid_test
