// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isosurface_within.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <distances/closest_points.hpp>
#include <distances/curve_order.hpp>
#include <distances/far_points.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>
#include <nestgrid/error.hpp>
#include <projection/by_criterion.hpp>

namespace nestgrid {

namespace {

using engine::Box;

/// Points, and how large the elements that contain them may be.
class FinePoints {
public:
    void add(std::span<const Point> points, double size) {
        for (const Point& x : points) points_.push_back({x, size});
    }
    std::size_t size() const { return points_.size(); }
    /// Makes the tree; to be called before is_in().
    void finish() {
        std::vector<Point> x;
        x.reserve(points_.size());
        for (const FinePoint& point : points_) x.push_back(point.x);
        std::vector<FinePoint> sorted;
        sorted.reserve(points_.size());
        tree_ = {};
        for (const std::uint32_t i : engine::order_on_curve(x)) {
            sorted.push_back(points_[i]);
            tree_.add(Box::around({&x[i], 1}));
        }
        points_ = std::move(sorted);
        tree_.finish();
    }
    /// Whether there is a point in the box of an element that is larger than it may be.
    bool is_in(const Box& box, double size) const {
        return !tree_.for_each(
            [&](const Box& b) { return box.meets(b); },
            [&](std::size_t i) { return size <= points_[i].size || !box.contains(points_[i].x); });
    }

private:
    struct FinePoint {
        Point x;
        double size;
    };
    std::vector<FinePoint> points_;
    engine::BoxTree tree_;
};

/// Thrown where progress ends the work.
struct Cancelled {};

/// 1 where elements that are split are larger than points in them allow, else 0.
/// \throw Cancelled
template <class Real, class Progress>
SweptIndicator fine_indicator(const Hierarchy<Real>& hierarchy, const FinePoints& points,
                              const Progress& progress) {
    constexpr std::uint64_t now_and_then = 1U << 14U;
    TraversalCounts counts;
    return measured_indicator(hierarchy, [&](const MeasuredSplit& split, std::span<double> eta) {
        const bool tells = ++counts.calls % now_and_then == 0 && progress;
        if (tells && !progress(counts)) throw Cancelled{};
        const double size = split.diameter();
        // The children of curved elements lie around the new nodes, too.
        Box box = Box::around(split.positions);
        box.widen(1e-6 * size);
        if (points.is_in(box, size)) std::fill(eta.begin(), eta.end(), 1.0);
    });
}

}  // namespace

template <class Real>
IsosurfaceWithin isosurface_within(const Hierarchy<Real>& hierarchy, double isovalue,
                                   const Nearness& nearness, const AnyCriterion& criterion,
                                   const Bounds& bounds, const IsosurfaceOptions& options,
                                   const Executor& executor) {
    const Surface<3>& whole = nearness.whole;
    const double distance = nearness.distance;
    hierarchy.facts().require_one_process("an isosurface within a distance");
    nearness.require();
    IsosurfaceOptions searched = options;
    searched.normals = searched.cap = searched.elements = searched.reference = false;
    const engine::ClosestPoints to_whole(whole);
    IsosurfaceWithin result;
    FinePoints points;
    std::vector<Point> before;
    /// Draws once. Returns whether that is the result.
    const auto draws_within = [&] {
        points.finish();
        const SweptIndicator fine = points.size() > 0
                                        ? fine_indicator(hierarchy, points, options.progress)
                                        : SweptIndicator({}, {}, hierarchy.epoch());
        const auto draw = [&](const IsosurfaceOptions& how) {
            return engine::isosurface<3>(hierarchy, isovalue, criterion && Threshold(&fine, 0.5),
                                         bounds, how, executor);
        };
        const Isosurface<3> drawn = draw(searched);
        if (drawn.cancelled) throw Cancelled{};
        std::vector<Point> far = engine::far_points(drawn.surface, to_whole, distance, executor);
        const std::vector<Point> back =
            engine::far_points(whole, engine::ClosestPoints(drawn.surface), distance, executor);
        far.insert(far.end(), back.begin(), back.end());
        if (far.empty()) {
            result.isosurface = draw(options);
            return true;
        }
        if (result.rounds > 1 && far == before) {
            throw InvalidInput(
                "the distance cannot be kept: it is from another surface than that of all data");
        }
        // In elements as small as the distance, both surfaces are near; or one of them is not
        // there.
        points.add(far, result.rounds == 0 ? distance : 0);
        result.points += far.size();
        ++result.rounds;
        before = std::move(far);
        return false;
    };
    try {
        while (!draws_within()) {
        }
    } catch (const Cancelled&) {
        result.isosurface.cancelled = true;
    }
    return result;
}

template IsosurfaceWithin isosurface_within<float>(const Hierarchy<float>&, double, const Nearness&,
                                                   const AnyCriterion&, const Bounds&,
                                                   const IsosurfaceOptions&, const Executor&);
template IsosurfaceWithin isosurface_within<double>(const Hierarchy<double>&, double,
                                                    const Nearness&, const AnyCriterion&,
                                                    const Bounds&, const IsosurfaceOptions&,
                                                    const Executor&);

}  // namespace nestgrid
