// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// check_grid: leaves of higher degree. On every line in the leaf along which the field is a
// polynomial of its degree p, the difference of order p + 1 of its values at p + 2 points in equal
// steps vanishes.
#include <algorithm>
#include <cmath>

#include "grid_checker.hpp"

namespace nestgrid::detail {

namespace {

/// The difference of order values.size() - 1, with weights whose magnitudes add up to 1.
double highest_difference(std::span<const double> values) {
    std::vector<double> left(values.begin(), values.end());
    while (left.size() > 1) {
        for (std::size_t i = 0; i + 1 < left.size(); ++i) left[i] = (left[i + 1] - left[i]) / 2;
        left.pop_back();
    }
    return left[0];
}

/// How long a line along an axis may be from a point with this coordinate 0 on. In a pyramid, whose
/// functions are polynomials on lines to the apex, that along axis 2 is one.
double length_inside(Shape shape, const Point& from, std::size_t axis) {
    if (shape == Shape::pyramid) return axis < 2 ? 1 - from[2] : 1;
    const bool in_triangle = shape == Shape::triangle || (shape == Shape::prism && axis < 2);
    if (in_triangle) return 1 - from[1 - axis];
    if (shape == Shape::tetrahedron) return 1 - from[0] - from[1] - from[2];
    return 1;
}

}  // namespace

/// Of a field that tells degrees: compares what it says of a leaf with the values at its corners,
/// and with polynomials of that degree.
void GridChecker::check_degree(const State& leaf) {
    if (!hierarchy_->offers(Feature::degree)) return;
    const int degree = hierarchy_->degree(task_.get(), leaf.member->element);
    if (degree < 1 || degree > max_degree) {
        fail(Law::degree, name(leaf.step) + " has the degree " + std::to_string(degree) +
                              ", not 1 to " + std::to_string(max_degree));
    }
    check_corner_values(leaf);
    for (std::size_t axis = 0; axis < topology(leaf.shape).dimension; ++axis) {
        for (const Point& through : {Point{0.15, 0.25, 0.3}, Point{0.35, 0.1, 0.2}}) {
            Point from = through;
            from[axis] = 0;
            check_line(leaf, degree, from, axis, length_inside(leaf.shape, from, axis));
        }
    }
}

void GridChecker::check_corner_values(const State& leaf) {
    const Topology& t = topology(leaf.shape);
    const auto corners = std::span(t.reference).first(t.corners);
    std::vector<double> values(t.corners * components_);
    hierarchy_->evaluate(task_.get(), leaf.member->element, corners, values.data());
    const double tolerance = std::max(options_->value_tolerance, 64 * epsilon_) * largest_value_;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t k = i / components_;
        const auto where = [&] { return "corner " + std::to_string(k) + " of " + name(leaf.step); };
        if (!std::isfinite(values[i])) {
            fail(Law::degree, "evaluate() gives no finite number at " + where());
        }
        const Node& node = *nodes_.find(leaf.corner[k].place);
        if (node.constrained || hanging_.contains(node.key)) continue;
        const double value = values_[node.first + i % components_];
        if (std::abs(values[i] - value) <= tolerance) continue;
        fail(Law::degree, "evaluate() gives " + std::to_string(values[i]) + " at " + where() +
                              ", but the node there has the value " + std::to_string(value));
    }
}

/// \param length of the line
void GridChecker::check_line(const State& leaf, int degree, Point from, std::size_t axis,
                             double length) {
    std::vector<Point> points(static_cast<std::size_t>(degree) + 2, from);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double along = length * static_cast<double>(i) / (degree + 1);
        points[i][axis] = along;
        if (leaf.shape != Shape::pyramid || axis < 2) continue;
        for (std::size_t d = 0; d < 2; ++d) points[i][d] *= 1 - along;
    }
    std::vector<double> values(points.size() * components_);
    hierarchy_->evaluate(task_.get(), leaf.member->element, points, values.data());
    std::vector<double> along(points.size());
    for (std::size_t c = 0; c < components_; ++c) {
        double scale = largest_value_;
        for (std::size_t i = 0; i < points.size(); ++i) {
            along[i] = values[i * components_ + c];
            scale = std::max(scale, std::abs(along[i]));
        }
        const double off = highest_difference(along);
        if (std::abs(off) <= std::max(options_->value_tolerance, 64 * epsilon_) * scale) continue;
        fail(Law::degree, "the field is no polynomial of degree " + std::to_string(degree) +
                              " along direction " + std::to_string(axis) + " in " +
                              name(leaf.step) + ", as degree() says");
    }
}

}  // namespace nestgrid::detail
