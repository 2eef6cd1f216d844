// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Ranges and jumps of the polynomials of all leaves, which stay when the polynomials themselves are
// gone: 12 bytes a leaf for the field, 8 for positions.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <high_order/leaf_functions.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>

namespace nestgrid::engine {

struct LeafSummary {
    /// An interval that component 0 stays in, in a leaf and on its records, whatever a criterion
    /// makes of corner values. Numbers are above the least value of all leaves, rounded outwards.
    struct Range {
        float least;
        float greatest;
    };

    std::size_t components = 0;
    /// How many components are drawn: beta and jumps are norms of these together, ranges are those
    /// of component 0.
    std::size_t drawn = 0;
    int greatest_degree = 1;
    double greatest_beta = 0;
    std::vector<double> least;  ///< of each component
    std::vector<double> greatest;
    std::vector<Range> ranges;  ///< of the leaves in the order of the walk; none for positions
    std::vector<float> jumps;   ///< how far leaves are from the records and nodes around
    /// Of positions: how far what is drawn in leaves may leave the hull of their corners, which is
    /// made of the values at nodes.
    std::vector<float> beyond_hull;

    explicit LeafSummary(const LeafFunction& function)
        : components{function.components()},
          drawn{function.drawn()},
          least(components, std::numeric_limits<double>::infinity()),
          greatest(components, -std::numeric_limits<double>::infinity()) {}

    /// From the least to the greatest of what is drawn, and its greatest magnitude.
    double extent() const {
        return norm_of(drawn, [&](std::size_t c) { return greatest[c] - least[c]; });
    }
    double magnitude() const {
        return norm_of(drawn, [&](std::size_t c) {
            return std::max(std::abs(least[c]), std::abs(greatest[c]));
        });
    }
    /// More than what rounding moves values by.
    double rounding() const { return 1e-14 * magnitude(); }
    double jump() const {
        return jumps.empty() ? 0
                             : static_cast<double>(*std::max_element(jumps.begin(), jumps.end()));
    }
    void reserve(std::size_t leaves) {
        jumps.reserve(leaves);
        drawn == 1 ? ranges.reserve(leaves) : beyond_hull.reserve(leaves);
    }
    void add_range(double low, double high) {
        ranges.push_back({detail::float_below(low - rounding() - least[0]),
                          detail::float_above(high + rounding() - least[0])});
    }
    /// Whether a level set of a value from low to high may pass through a leaf.
    bool may_take(std::size_t leaf, double low, double high) const {
        const Range& range = ranges[leaf];
        return low - least[0] <= static_cast<double>(range.greatest) &&
               high - least[0] >= static_cast<double>(range.least);
    }
    std::size_t memory_bytes() const {
        return ranges.capacity() * sizeof(Range) +
               (jumps.capacity() + beyond_hull.capacity()) * sizeof(float);
    }
};

}  // namespace nestgrid::engine
