// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/probe_line.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include <drawing/requirements.hpp>
#include <nestgrid/detail/shape_functions.hpp>
#include <probes/box_descent.hpp>
#include <probes/descent.hpp>
#include <projection/by_criterion.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>
#include <walk/hanging_nodes.hpp>

namespace nestgrid::engine {

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
    bool finest;  ///< the criterion stops at leaves alone

    /// Whether elements lie in the convex hulls of the corners of those above them.
    bool bounded() const {
        return !hierarchy.offers(Feature::new_positions) &&
               (hanging == nullptr || hanging->crossing() == nullptr);
    }
};

/// Calls take(points) for the points in parts.
template <class T, class Take>
void in_parts(std::span<T> points, const Take& take) {
    for (std::size_t i = 0; i < points.size(); i += most_together) {
        take(points.subspan(i, std::min(most_together, points.size() - i)));
    }
}

/// Descends in reference coordinates, where nothing is curved.
template <class Real>
void descend_nested(const Question<Real>& question, CoarseSearch& coarse,
                    FoundPoints<Real>& found) {
    const Needs needs{.values = true,
                      .keys = question.needs_keys,
                      .positions = question.criterion.wants_positions(),
                      .on_ranks = true};
    const Walk<Real> walk(question.hierarchy, needs, question.hanging);
    Descent<Real> descent(walk, question.criterion, found);
    in_parts(std::span(coarse.found), [&](auto some) { descent.run(some); });
}

/// Descends through boxes.
template <class Real>
void descend_in_boxes(const Question<Real>& question, std::span<const std::uint32_t> which,
                      FoundPoints<Real>& found) {
    Needs needs{.values = true, .keys = question.needs_keys, .positions = true, .on_ranks = true};
    needs.placed = question.finest;
    const Walk<Real> walk(question.hierarchy, needs, question.hanging);
    Reach reach;
    if (std::optional<Reach> told;
        !question.bounded() && (told = Reach::told(question.hierarchy))) {
        reach = std::move(*told);
    } else if (!question.bounded()) {
        needs.values = false;
        const Walk<Real> whole(question.hierarchy, needs, question.hanging);
        reach = Reach(whole, question.criterion);
    }
    BoxDescent<Real> descent(walk, question.criterion, question.points, reach, found);
    in_parts(which, [&](auto some) { descent.run(some); });
}

template <class Real>
ProbeResult answer(const Question<Real>& question) {
    const std::size_t count = question.points.size();
    FoundPoints<Real> found(question.hierarchy, count);
    std::vector<std::uint32_t> left(count);
    std::iota(left.begin(), left.end(), 0U);
    const SharedNodes* const shared = question.hierarchy.facts().shared;
    const auto descend = [&](const auto& alone) {
        together(shared, "values at points", alone);
        if (shared != nullptr) found.agree(shared->ranks());
    };
    bool missed = true;
    if (question.bounded()) {
        CoarseSearch coarse;
        descend([&] {
            coarse = search_coarse(question.hierarchy, question.points, left);
            descend_nested(question, coarse, found);
        });
        // Descents that may miss a point of an element:
        missed = coarse.any_deformed || !std::ranges::all_of(coarse.found, [&](const auto& in) {
                     return found.found(in.point);
                 });
        std::erase_if(left, [&](std::uint32_t p) { return found.found(p); });
    }
    if (missed && !left.empty()) {
        descend([&] { descend_in_boxes(question, std::span(std::as_const(left)), found); });
    }
    TraversalCounts& counts = found.counts();
    std::array<std::uint64_t*, 3> sums{&counts.calls, &counts.visited, &counts.extracted};
    if (shared != nullptr) take_sums(shared->ranks(), sums);
    return found.take();
}

/// What ranks compare before they ask for values at points.
std::string asked_for(std::span<const Point> points, const Criterion& criterion) {
    std::uint64_t sum = 0;
    for (const Point& x : points) {
        for (const double along : x)
            sum = nestgrid::detail::mix64(sum + std::bit_cast<std::uint64_t>(along));
    }
    return "values at " + std::to_string(points.size()) + " points (" + std::to_string(sum) +
           "), " + name_of(criterion);
}

}  // namespace

template <class Real>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points,
                  const Criterion& criterion, const Bounds& bounds) {
    together(
        hierarchy.facts().shared, [&] { return asked_for(points, criterion); },
        [&] {
            if (hierarchy.facts().shared != nullptr) {
                require_same_state(hierarchy);
                require_drawn_on_ranks(criterion, bounds, {}, false);
            }
            require_sound(hierarchy, criterion, bounds);
            require_points(points);
        });
    return answer<Real>({hierarchy, points, criterion, bounds.hanging(), true, false});
}

template <class Real>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points) {
    together(
        hierarchy.facts().shared, [&] { return asked_for(points, Exact{}); },
        [&] {
            if (hierarchy.facts().shared != nullptr) require_same_state(hierarchy);
            require_points(points);
        });
    const HangingNodes hanging = find_hanging_nodes(hierarchy);
    const bool any = !hanging.empty();
    // Values from other ranks are found by keys.
    const bool needs_keys = any || hierarchy.facts().shared != nullptr;
    return answer<Real>({hierarchy, points, Exact{}, any ? &hanging : nullptr, needs_keys, true});
}

template ProbeResult probe(const Hierarchy<float>&, std::span<const Point>, const Criterion&,
                           const Bounds&);
template ProbeResult probe(const Hierarchy<double>&, std::span<const Point>, const Criterion&,
                           const Bounds&);
template ProbeResult probe(const Hierarchy<float>&, std::span<const Point>);
template ProbeResult probe(const Hierarchy<double>&, std::span<const Point>);

}  // namespace nestgrid::engine

namespace nestgrid::detail {

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

}  // namespace nestgrid::detail

namespace nestgrid {

ProbeResult probe(const DiscontinuousData& data, std::span<const Point> points) {
    data.grid().facts().require_one_process("values of discontinuous data at points");
    ProbeResult result = engine::probe(data.grid(), points);
    const auto components = static_cast<std::size_t>(data.components());
    result.components = components;
    result.values.assign(points.size() * components, std::numeric_limits<double>::quiet_NaN());
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t i) { return !result.found(i); });
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return result.element_of[i]; });
    std::vector<double> at_corners;
    std::uint32_t element = ProbeResult::no_element;  // whose values are at hand
    for (const std::size_t i : order) {
        const Shape shape = result.shape_of[result.element_of[i]];
        const std::size_t corners = topology(shape).corners;
        if (element != result.element_of[i]) {
            element = result.element_of[i];
            at_corners.assign(corners * components, 0.0);
            data.leaf_values(result.elements.handle(element), at_corners);
        }
        const auto weight = shape_functions(shape, result.reference[i]);
        for (std::size_t c = 0; c < components; ++c) {
            double sum = 0;
            for (std::size_t k = 0; k < corners; ++k) {
                sum += weight[k] * at_corners[k * components + c];
            }
            result.values[i * components + c] = sum;
        }
    }
    return result;
}

}  // namespace nestgrid
