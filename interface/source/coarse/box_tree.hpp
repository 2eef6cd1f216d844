// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boxes that are found by place.
#pragma once

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#define BOOST_ALLOW_DEPRECATED_HEADERS  // which Boost 1.74 itself includes
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::detail {

/// Boxes along the axes, by their numbers.
class BoxTree {
    using Corner = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;

public:
    using Box = boost::geometry::model::box<Corner>;

    /// The box around some points, larger by the slack on each side.
    static Box around(std::span<const Point> points, double slack) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        Point lo{infinity, infinity, infinity};
        Point hi{-infinity, -infinity, -infinity};
        for (const Point& x : points) {
            for (std::size_t d = 0; d < 3; ++d) {
                lo[d] = std::min(lo[d], x[d] - slack);
                hi[d] = std::max(hi[d], x[d] + slack);
            }
        }
        return {Corner{lo[0], lo[1], lo[2]}, Corner{hi[0], hi[1], hi[2]}};
    }

    explicit BoxTree(const std::vector<Box>& boxes) : tree_{numbered(boxes)} {}

    /// The numbers of the boxes that meet a box, ascending; valid until the next call.
    std::span<const std::size_t> near(const Box& box) {
        found_.clear();
        tree_.query(boost::geometry::index::intersects(box), std::back_inserter(found_));
        numbers_.clear();
        for (const Entry& entry : found_) numbers_.push_back(entry.second);
        std::sort(numbers_.begin(), numbers_.end());
        return numbers_;
    }

private:
    using Entry = std::pair<Box, std::size_t>;

    static std::vector<Entry> numbered(const std::vector<Box>& boxes) {
        std::vector<Entry> entries;
        for (std::size_t i = 0; i < boxes.size(); ++i) entries.emplace_back(boxes[i], i);
        return entries;
    }

    boost::geometry::index::rtree<Entry, boost::geometry::index::linear<16>> tree_;
    std::vector<Entry> found_;
    std::vector<std::size_t> numbers_;
};

}  // namespace nestgrid::detail
