// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/box_descent.hpp>

#include <algorithm>

#include <nestgrid/detail/shape_functions.hpp>
#include <probes/inverse_map.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

namespace {

/// The box around what lies in an element and below it.
PointBox box_around(std::span<const Point> corners, double reach) {
    PointBox box = PointBox::around(corners);
    const double rounding = std::max(face_tolerance(corners), off_surface) * extent(corners);
    box.widen(reach + rounding);
    return box;
}

/// A drawn element, and the one whose corners lie where the grid has them.
template <class Real>
class DrawnElement {
public:
    DrawnElement(const Walk<Real>& walk, const ElementView<Real>& view)
        : drawn_{map_of(walk, view, false)},
          placed_{map_of(walk, view, walk.places_corners())},
          differ_{!std::equal(drawn_.corners().begin(), drawn_.corners().end(),
                              placed_.corners().begin())},
          tolerance_{face_tolerance(drawn_.corners())},
          most_off_{off_surface * extent(drawn_.corners())} {}

    /// Offers what the element has at a point.
    void offer(const ElementView<Real>& view, std::uint32_t point, const Point& x,
               FoundPoints<Real>& found) const {
        constexpr double outside = 2;  // below the depth of every point that is drawn
        Point s;
        if (is_in(drawn_, x, s)) {
            found.offer(view, point, s, shape_functions(view.shape, s),
                        face_distance(view.shape, s));
        } else if (differ_ && is_in(placed_, x, s)) {
            found.offer(view, point, s, weights_near(view.shape, drawn_.corners(), s, x),
                        face_distance(view.shape, s) - outside);
        }
    }

private:
    static InverseMap map_of(const Walk<Real>& walk, const ElementView<Real>& view, bool placed) {
        std::array<Point, max_corners> x;
        if (placed) {
            walk.placed_corners(view, x.data());
        } else {
            walk.corners(view, nullptr, x.data());
        }
        return {view.shape, std::span<const Point>(x).first(view.corner_count())};
    }
    bool is_in(const InverseMap& map, const Point& x, Point& s) const {
        return map.find(x, tolerance_, s) &&
               norm(x - place_of(map.shape(), map.corners(), s)) <= most_off_;
    }

    InverseMap drawn_;
    InverseMap placed_;
    bool differ_;
    double tolerance_;
    double most_off_;
};

}  // namespace

template <class Real>
void BoxDescent<Real>::run(std::span<const std::uint32_t> which) {
    coarse_ = search_coarse_boxes(walk_->hierarchy(), points_, which,
                                  [&](std::size_t i, std::span<const Point> corners) {
                                      return box_around(corners, reach_->beyond(i, 0));
                                  });
    for_each_run(coarse_,
                 [&](std::size_t first, std::size_t last) { walk_->run(*this, first, last); });
}

template <class Real>
Decision BoxDescent<Real>::inspect(const View& view, const Split& split) {
    found_->counts().calls += counted(view);
    arrive(view);
    if (group_on(view.level).empty()) return {Visit::skip};
    found_->counts().visited += counted(view);
    if (split.rule == nullptr) return {Visit::stop};
    return question_.ask(*walk_, *criterion_, view, split);
}

template <class Real>
void BoxDescent<Real>::extract(const View& view) {
    ++found_->counts().extracted;
    found_->begin_element();
    const DrawnElement<Real> element(*walk_, view);
    for (const std::uint32_t p : group_on(view.level)) {
        element.offer(view, p, points_[p], *found_);
    }
}

template <class Real>
NodeMask BoxDescent<Real>::children(const View& view) {
    if (view.member->rule->new_nodes.empty()) arrive(view);  // inspect() was not called
    return group_on(view.level).empty() ? NodeMask{0} : ~NodeMask{0};
}

template <class Real>
auto BoxDescent<Real>::group_on(int level) -> Group& {
    const auto at = static_cast<std::size_t>(level);
    while (groups_.size() <= at) groups_.emplace_back();
    return groups_[at];
}

/// Sets the group of an element: of the father's points those in its box.
template <class Real>
void BoxDescent<Real>::arrive(const View& view) {
    Group& group = group_on(view.level);
    group.clear();
    if (view.father == nullptr) {
        const auto coarse = static_cast<std::uint32_t>(view.coarse);
        auto in = std::ranges::lower_bound(coarse_, coarse, {}, &Candidate::element);
        for (; in != coarse_.end() && in->element == coarse; ++in) group.push_back(in->point);
        return;
    }
    std::array<Point, max_corners> x;
    walk_->corners(view, nullptr, x.data());
    const PointBox box = box_around(std::span(x).first(view.corner_count()), reach_->beyond(view));
    for (const std::uint32_t p : group_on(view.level - 1)) {
        if (box.contains(points_[p])) group.push_back(p);
    }
}

template class BoxDescent<float>;
template class BoxDescent<double>;

}  // namespace nestgrid::engine
