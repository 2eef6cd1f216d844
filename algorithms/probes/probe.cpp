// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/probe_line.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include <levels/draw.hpp>
#include <probes/descent.hpp>
#include <walk/hanging_nodes.hpp>

namespace nestgrid::detail {

namespace {

/// Points that go down together: a bound on the memory of a descent.
constexpr std::size_t most_together = std::size_t{1} << 16U;

void require_points(std::span<const Point> points) {
    if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw InvalidInput("more points are probed than 32 bits count");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [x, y, z] = points[i];
        if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z)) continue;
        throw InvalidInput("a coordinate of point " + std::to_string(i) + " is not finite");
    }
}

/// What is asked of a hierarchy.
template <class Real>
struct Question {
    const Hierarchy<Real>& hierarchy;
    std::span<const Point> points;
    const Criterion& criterion;
    const HangingNodes* hanging;
    bool needs_keys;
};

template <class Real>
void descend(const Question<Real>& question, std::span<engine::PointInElement> found, double margin,
             ProbeResult& result) {
    const engine::Needs needs{
        .values = true,
        .keys = question.needs_keys,
        .positions = margin != 0 || question.criterion.wants_positions(),
    };
    const engine::Walk<Real> walk(question.hierarchy, needs, question.hanging);
    engine::Descent<Real> descent(walk, question.criterion, question.points, margin, result);
    for (std::size_t i = 0; i < found.size(); i += most_together) {
        descent.run(found.subspan(i, std::min(most_together, found.size() - i)));
    }
}

/// Descends nested; and then wide, with the points that the nested descent may have missed.
template <class Real>
ProbeResult answer(const Question<Real>& question) {
    const Hierarchy<Real>& hierarchy = question.hierarchy;
    ProbeResult result;
    const std::size_t count = question.points.size();
    result.components = static_cast<std::size_t>(hierarchy.facts().components);
    result.values.assign(count * result.components, std::numeric_limits<double>::quiet_NaN());
    result.level.assign(count, -1);
    std::vector<std::uint32_t> left(count);
    std::iota(left.begin(), left.end(), 0U);
    const bool curved = hierarchy.offers(Feature::new_positions);
    bool missed = curved;
    if (!curved) {
        auto coarse = engine::search_coarse(hierarchy, question.points, left, 0);
        descend(question, std::span(coarse.found), 0, result);
        std::erase_if(left, [&](std::uint32_t p) { return result.found(p); });
        missed = coarse.any_deformed || coarse.found.size() > count - left.size();
    }
    if (missed && !left.empty()) {
        const double margin = curved ? engine::curved_margin : engine::wide_margin;
        auto coarse = engine::search_coarse(hierarchy, question.points, left, margin);
        descend(question, std::span(coarse.found), margin, result);
    }
    return result;
}

}  // namespace

template <class Real>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points,
                  const Criterion& criterion, const Bounds& bounds) {
    engine::require_same_epoch(hierarchy, bounds);
    engine::require_saturated(criterion, bounds, hierarchy.facts().decodes);
    require_points(points);
    return answer<Real>({hierarchy, points, criterion, bounds.hanging(), true});
}

template <class Real>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points) {
    require_points(points);
    const HangingNodes hanging = engine::find_hanging_nodes(hierarchy);
    const bool any = !hanging.empty();
    return answer<Real>({hierarchy, points, Exact{}, any ? &hanging : nullptr, any});
}

LineProbe make_line(const Point& from, const Point& to, std::size_t count) {
    if (count < 2) throw InvalidInput("a line is probed at two points or more");
    LineProbe line;
    for (std::size_t i = 0; i < count; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(count - 1);
        line.points.push_back((1 - part) * from + part * to);
        line.distance.push_back(part * norm(to - from));
    }
    return line;
}

std::vector<double> only_values(ProbeResult result, const Point& x) {
    if (!result.found(0)) {
        throw InvalidInput("the point " + text_of(x) + " lies outside the grid");
    }
    return std::move(result.values);
}

template ProbeResult probe(const Hierarchy<float>&, std::span<const Point>, const Criterion&,
                           const Bounds&);
template ProbeResult probe(const Hierarchy<double>&, std::span<const Point>, const Criterion&,
                           const Bounds&);
template ProbeResult probe(const Hierarchy<float>&, std::span<const Point>);
template ProbeResult probe(const Hierarchy<double>&, std::span<const Point>);

}  // namespace nestgrid::detail
