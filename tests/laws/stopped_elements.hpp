// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The elements that a projection stops at, and points in them: what probes must find, without a
// search and without the inverse of a map.
#pragma once

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/detail/shape_functions.hpp>
#include <probes/inverse_map.hpp>
#include <walk/project.hpp>

#include "closedness.hpp"

namespace nestgrid_test {

inline constexpr double exact = 1e-12;

/// An element that a projection stops at.
struct Stopped {
    Shape shape;
    int level;
    std::array<Point, max_corners> corner;
    std::array<double, max_corners> value;

    Point place(const Point& s) const {
        const auto weight = shape_functions(shape, s);
        Point x{0, 0, 0};
        for (std::size_t k = 0; k < topology(shape).corners; ++k) x = x + weight[k] * corner[k];
        return x;
    }
    double interpolated(const Point& s) const {
        const auto weight = shape_functions(shape, s);
        double sum = 0;
        for (std::size_t k = 0; k < topology(shape).corners; ++k) sum += weight[k] * value[k];
        return sum;
    }
};

template <class Grid, class Field>
std::vector<Stopped> stopped_elements(const Grid& grid, const Field& field,
                                      const Criterion& criterion, const HangingNodes* hanging) {
    const auto hierarchy = erase(grid, field);
    using Real = typename Field::value_type;
    const engine::Walk<Real> walk(hierarchy, {.positions = true}, hanging);
    std::vector<Stopped> result;
    engine::project<Real>(walk, criterion, [&](const engine::ElementView<Real>& view) {
        Stopped e{view.shape, view.level, {}, {}};
        walk.corners(view, nullptr, e.corner.data());
        std::copy_n(view.value, view.corner_count(), e.value.begin());
        result.push_back(e);
    });
    return result;
}

/// A mean of the corners of the reference element with these weights.
inline Point reference_mean(Shape shape, std::span<const double> weight) {
    Point s{0, 0, 0};
    const double sum = std::accumulate(weight.begin(), weight.end(), 0.0);
    for (std::size_t k = 0; k < weight.size(); ++k) {
        s = s + weight[k] / sum * topology(shape).reference[k];
    }
    return s;
}

/// Points of elements, with what is to be found there.
struct Expected {
    std::vector<Point> points;
    std::vector<double> values;
    std::vector<int> levels;

    void add(const Stopped& e, const Point& s) {
        points.push_back(e.place(s));
        values.push_back(e.interpolated(s));
        levels.push_back(e.level);
    }
};

inline Expected inside(const std::vector<Stopped>& elements, std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    Expected result;
    for (std::size_t i = 0; i < count; ++i) {
        const Stopped& e = elements[random() % elements.size()];
        std::array<double, max_corners> weight;
        for (double& w : weight) w = 0.01 + uniform(random);
        result.add(e, reference_mean(e.shape, std::span(weight).first(topology(e.shape).corners)));
    }
    return result;
}

/// The corners, middles of edges, and two points of each face of about 300 elements.
inline Expected between(const std::vector<Stopped>& elements) {
    Expected result;
    for (std::size_t n = 0; n < elements.size(); n += 1 + elements.size() / 300) {
        const Stopped& e = elements[n];
        const Topology& t = topology(e.shape);
        for (std::size_t k = 0; k < t.corners; ++k) result.add(e, t.reference[k]);
        for (std::size_t i = 0; i < t.edges; ++i) {
            const auto [a, b] = t.edge[i];
            result.add(e, 0.5 * (t.reference[a] + t.reference[b]));
        }
        for (std::size_t f = 0; f < t.faces; ++f) {
            for (const double first : {1.0, 2.7}) {
                std::array<double, max_corners> weight{};
                for (std::size_t i = 0; i < t.face[f].corners; ++i) {
                    weight[t.face[f].corner[i]] = i == 0 ? first : 1;
                }
                result.add(e, reference_mean(e.shape, std::span(weight).first(t.corners)));
            }
        }
    }
    return result;
}

/// Whether a point lies in the box of an element, up to rounding. The element lies in it, too: its
/// points are means of its corners.
inline bool is_in_box(const Stopped& e, const Point& x) {
    const std::span corners = std::span(e.corner).first(topology(e.shape).corners);
    for (std::size_t d = 0; d < 3; ++d) {
        const auto [low, high] =
            std::ranges::minmax(corners, {}, [d](const Point& corner) { return corner[d]; });
        if (!(x[d] >= low[d] - 1e-9 && x[d] <= high[d] + 1e-9)) return false;
    }
    return true;
}

/// Whether a value is that of an element around a point.
inline bool is_value_around(const std::vector<Stopped>& elements, const Point& x, double value) {
    return std::ranges::any_of(elements, [&](const Stopped& e) {
        if (!is_in_box(e, x)) return false;
        const std::span corners = std::span(e.corner).first(topology(e.shape).corners);
        Point s = engine::reference_middle(e.shape);
        return engine::invert(e.shape, corners, x, s) &&
               engine::face_distance(e.shape, s) > -1e-9 && norm(e.place(s) - x) < 1e-9 &&
               std::abs(e.interpolated(s) - value) < exact;
    });
}

/// What is found is what is expected; between elements it may be what another element around the
/// point has, because a quadrilateral that is divided into triangles without a node has other
/// values than one that is not. Gives up after ten wrong values, each of which takes a look at all
/// elements.
inline void expect_values(const ProbeResult& result, const Expected& expected,
                          const std::vector<Stopped>& elements) {
    ASSERT_EQ(result.values.size(), expected.points.size());
    std::size_t missed = 0;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < expected.points.size() && wrong < 10; ++i) {
        missed += result.found(i) ? 0U : 1U;
        if (result.found(i) && !(std::abs(result.values[i] - expected.values[i]) < exact)) {
            wrong += is_value_around(elements, expected.points[i], result.values[i]) ? 0U : 1U;
        }
    }
    EXPECT_EQ(missed, 0U);
    EXPECT_EQ(wrong, 0U);
}

/// Inside elements there is but one value.
inline void expect_values_inside(const ProbeResult& result, const Expected& expected) {
    expect_values(result, expected, {});
    EXPECT_EQ(result.level, expected.levels);
}

}  // namespace nestgrid_test
