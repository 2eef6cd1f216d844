// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which points lie in which coarse elements. The points are sorted into bins, so that one look at
// each coarse element finds those in its box, and nothing is kept of coarse elements.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <nestgrid/hierarchy.hpp>
#include <probes/point_box.hpp>

namespace nestgrid::engine {

/// A point in an element.
struct PointInElement {
    Point at;             ///< in the reference coordinates of the element
    std::uint32_t point;  ///< its number
    /// Number of the coarse element; below it, number of the child in its family.
    std::uint32_t element;
};

/// Some of many points, in the cells of a box, about one in each.
class PointBins {
public:
    /// \param which the numbers of the points that are to be found
    PointBins(std::span<const Point> points, std::span<const std::uint32_t> which);

    /// Calls function(number, point) for the points in a box, ends included.
    template <class Function>
    void for_each_in(const PointBox& box, Function&& function) const {
        const auto& [low, high] = box;
        for (std::size_t d = 0; d < 3; ++d) {
            if (!(low[d] <= high_[d] && high[d] >= low_[d])) return;
        }
        const auto from = cell_of(low);
        const auto to = cell_of(high);
        for (std::size_t z = from[2]; z <= to[2]; ++z) {
            for (std::size_t y = from[1]; y <= to[1]; ++y) {
                const std::size_t row = (z * cells_[1] + y) * cells_[0];
                for (std::size_t i = first_[row + from[0]]; i < first_[row + to[0] + 1]; ++i) {
                    const Point& x = points_[sorted_[i]];
                    if (box.contains(x)) function(sorted_[i], x);
                }
            }
        }
    }

private:
    std::array<std::size_t, 3> cell_of(const Point& x) const;
    std::size_t bin_of(const Point& x) const;

    std::span<const Point> points_;
    Point low_{};
    Point high_{};
    std::array<std::size_t, 3> cells_{1, 1, 1};
    std::vector<std::uint32_t> sorted_;  // numbers of points, by bin
    std::vector<std::uint32_t> first_;   // of each bin, in sorted_
};

struct CoarseSearch {
    std::vector<PointInElement> found;  ///< by coarse element
    bool any_deformed = false;          ///< the map of some coarse element is not affine
};

/// Finds for each point the coarse element that it is deepest in, where one is shown.
template <class Real>
CoarseSearch search_coarse(const Hierarchy<Real>& hierarchy, std::span<const Point> points,
                           std::span<const std::uint32_t> which);

/// A point that lies in the box of a coarse element.
struct Candidate {
    std::uint32_t point;
    std::uint32_t element;
};

/// The box of coarse element i.
using CoarseBox = std::function<PointBox(std::size_t i, std::span<const Point> corners)>;

/// Finds all coarse elements in whose boxes points lie, where they are shown. \return by element
template <class Real>
std::vector<Candidate> search_coarse_boxes(const Hierarchy<Real>& hierarchy,
                                           std::span<const Point> points,
                                           std::span<const std::uint32_t> which,
                                           const CoarseBox& box_of);

/// Calls function(first, last) for each run of coarse elements, without gaps, in which points lie.
/// \param found in ascending order of their elements
template <class Found, class Function>
void for_each_run(const Found& found, const Function& function) {
    for (std::size_t i = 0; i < found.size();) {
        const std::size_t first = found[i].element;
        std::size_t last = first;
        while (i < found.size() && found[i].element <= last) {
            last = std::size_t{found[i++].element} + 1;
        }
        function(first, last);
    }
}

}  // namespace nestgrid::engine
