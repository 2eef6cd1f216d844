// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/coarse_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <probes/inverse_map.hpp>

namespace nestgrid::engine {

PointBins::PointBins(std::span<const Point> points, std::span<const std::uint32_t> which)
    : points_{points}, sorted_(which.size()) {
    constexpr double most_cells = 1024;
    low_.fill(std::numeric_limits<double>::infinity());
    high_.fill(-std::numeric_limits<double>::infinity());
    for (const std::uint32_t p : which) {
        for (std::size_t d = 0; d < 3; ++d) {
            low_[d] = std::min(low_[d], points[p][d]);
            high_[d] = std::max(high_[d], points[p][d]);
        }
    }
    int extended = 0;
    for (std::size_t d = 0; d < 3; ++d) extended += high_[d] > low_[d] ? 1 : 0;
    const double count = std::pow(static_cast<double>(which.size()), 1.0 / std::max(extended, 1));
    for (std::size_t d = 0; d < 3; ++d) {
        if (high_[d] > low_[d]) cells_[d] = static_cast<std::size_t>(std::min(count, most_cells));
    }
    first_.assign(cells_[0] * cells_[1] * cells_[2] + 1, 0);
    for (const std::uint32_t p : which) ++first_[bin_of(points[p]) + 1];
    for (std::size_t bin = 1; bin < first_.size(); ++bin) first_[bin] += first_[bin - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const std::uint32_t p : which) sorted_[next[bin_of(points[p])]++] = p;
}

std::array<std::size_t, 3> PointBins::cell_of(const Point& x) const {
    std::array<std::size_t, 3> cell{};
    for (std::size_t d = 0; d < 3; ++d) {
        const auto cells = static_cast<double>(cells_[d]);
        const double at = (x[d] - low_[d]) / (high_[d] - low_[d]) * cells;
        cell[d] = static_cast<std::size_t>(std::min(std::max(0.0, at), cells - 1));  // 0 for NaN
    }
    return cell;
}

std::size_t PointBins::bin_of(const Point& x) const {
    const auto [i, j, k] = cell_of(x);
    return (k * cells_[1] + j) * cells_[0] + i;
}

namespace {

/// Calls function(number, reference coordinates, face distance) for the points in an element.
template <class Function>
void for_each_point_in(const PointBins& bins, const InverseMap& inverse, Function&& function) {
    const Shape shape = inverse.shape();
    const std::span<const Point> corners = inverse.corners();
    const double tolerance = face_tolerance(corners);
    const double size = extent(corners);
    PointBox box = PointBox::around(corners);
    box.widen(tolerance * size);
    const bool on_surface = topology(shape).dimension < 3;
    bins.for_each_in(box, [&](std::uint32_t p, const Point& x) {
        Point s;
        if (!inverse(x, s)) return;
        const double distance = face_distance(shape, s);
        if (!(distance >= -tolerance)) return;
        if (on_surface && !(norm(x - place_of(shape, corners, s)) <= off_surface * size)) return;
        function(p, s, distance);
    });
}

/// Calls function(i, coarse) for the coarse elements that are shown, at least in part, here or on
/// other ranks.
template <class Real, class Function>
void for_each_shown(const Hierarchy<Real>& hierarchy, Function&& function) {
    const std::unique_ptr<Task> task = hierarchy.open();
    Coarse coarse;
    Family family;
    for (std::size_t i = 0; i < hierarchy.coarse_count(); ++i) {
        hierarchy.coarse(task.get(), i, coarse, family);
        const bool elsewhere = family.members[0].presence == Presence::elsewhere;
        if (elsewhere || ((family.split | family.leaves) & ~family.hidden) != 0) {
            function(i, coarse);
        }
    }
}

/// Keeps one element for each point.
class DeepestElements {
public:
    explicit DeepestElements(std::size_t points) : of_(points) {}

    void add(const PointInElement& in, double distance, std::vector<PointInElement>& found) {
        Deepest& deepest = of_[in.point];
        if (!deepest.any) {
            deepest = {found.size(), distance, true};
            found.push_back(in);
        } else if (distance > deepest.distance) {
            found[deepest.at] = in;
            deepest.distance = distance;
        }
    }

private:
    struct Deepest {
        std::size_t at = 0;  // in `found`
        double distance = 0;
        bool any = false;
    };
    std::vector<Deepest> of_;  // by number of the point
};

}  // namespace

template <class Real>
CoarseSearch search_coarse(const Hierarchy<Real>& hierarchy, std::span<const Point> points,
                           std::span<const std::uint32_t> which) {
    CoarseSearch result;
    if (which.empty()) return result;
    DeepestElements deepest(points.size());
    const PointBins bins(points, which);
    for_each_shown(hierarchy, [&](std::size_t i, const Coarse& coarse) {
        const auto corners = std::span(coarse.corners).first(topology(coarse.shape).corners);
        const InverseMap inverse(coarse.shape, corners);
        result.any_deformed = result.any_deformed || !inverse.affine();
        for_each_point_in(bins, inverse, [&](std::uint32_t p, const Point& s, double distance) {
            deepest.add({s, p, static_cast<std::uint32_t>(i)}, distance, result.found);
        });
    });
    std::ranges::stable_sort(result.found, {}, &PointInElement::element);
    return result;
}

template <class Real>
std::vector<Candidate> search_coarse_boxes(const Hierarchy<Real>& hierarchy,
                                           std::span<const Point> points,
                                           std::span<const std::uint32_t> which,
                                           const CoarseBox& box_of) {
    std::vector<Candidate> found;
    if (which.empty()) return found;
    const PointBins bins(points, which);
    for_each_shown(hierarchy, [&](std::size_t i, const Coarse& coarse) {
        const auto corners = std::span(coarse.corners).first(topology(coarse.shape).corners);
        bins.for_each_in(box_of(i, corners), [&](std::uint32_t p, const Point&) {
            found.push_back({p, static_cast<std::uint32_t>(i)});
        });
    });
    return found;
}

#define NESTGRID_INSTANTIATE(Real)                                                      \
    template CoarseSearch search_coarse(const Hierarchy<Real>&, std::span<const Point>, \
                                        std::span<const std::uint32_t>);                \
    template std::vector<Candidate> search_coarse_boxes(                                \
        const Hierarchy<Real>&, std::span<const Point>, std::span<const std::uint32_t>, \
        const CoarseBox&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
