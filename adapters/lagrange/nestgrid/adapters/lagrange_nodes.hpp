// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points at one place as one node. Included by lagrange.hpp.
#pragma once

#include <cmath>
#include <unordered_map>

#include <nestgrid/adapters/lagrange_cells.hpp>

namespace nestgrid::detail {

/// Nodes no two of which are nearer to each other than a distance.
class NodeMerger {
public:
    explicit NodeMerger(double distance)
        : distance_{distance}, size_{std::max(1024 * distance, 1e-300)} {}

    /// The number of the node at a place: an earlier one, or the next.
    std::uint32_t number(const Point& x) {
        const std::array<std::int64_t, 3> low = box(x, -distance_);
        const std::array<std::int64_t, 3> high = box(x, distance_);
        for (std::int64_t i = low[0]; i <= high[0]; ++i) {
            for (std::int64_t j = low[1]; j <= high[1]; ++j) {
                for (std::int64_t k = low[2]; k <= high[2]; ++k) {
                    const auto [begin, end] = nodes_in_.equal_range(hash({i, j, k}));
                    for (auto at = begin; at != end; ++at) {
                        if (norm(nodes_[at->second] - x) <= distance_) return at->second;
                    }
                }
            }
        }
        const auto fresh = static_cast<std::uint32_t>(nodes_.size());
        nodes_in_.emplace(hash(box(x, 0)), fresh);
        nodes_.push_back(x);
        return fresh;
    }
    std::vector<Point> take() { return std::move(nodes_); }

private:
    std::array<std::int64_t, 3> box(const Point& x, double moved) const {
        std::array<std::int64_t, 3> at{};
        for (std::size_t d = 0; d < 3; ++d) {
            at[d] = static_cast<std::int64_t>(std::floor((x[d] + moved) / size_));
        }
        return at;
    }
    static std::uint64_t hash(const std::array<std::int64_t, 3>& at) {
        std::uint64_t sum = 0;
        for (const std::int64_t x : at) {
            sum = (sum ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ULL;
            sum ^= sum >> 29;
        }
        return sum;
    }

    double distance_;
    double size_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> nodes_in_;  // by box
    std::vector<Point> nodes_;
};

}  // namespace nestgrid::detail
