// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Law of check_grid: leaves of higher degree. On every line in the leaf along which the field is a
// polynomial of its degree p, the difference of order p + 1 of its values at p + 2 points in equal
// steps vanishes.
#include <algorithm>
#include <cmath>

#include "laws.hpp"

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

/// A field that tells degrees has in each leaf the values at its corners, and is a polynomial of
/// the degree that it tells.
class DegreeLaw final : public GridLaw {
public:
    explicit DegreeLaw(Inspection& inspection) : inspection_{&inspection} {}

    void revisit(const CheckedElement& leaf) override {
        if (!inspection_->offers(Feature::degree) || !leaf.is_leaf() ||
            leaf.member->hidden == Hidden::wholly) {
            return;
        }
        const int degree =
            inspection_->hierarchy().degree(inspection_->task(), leaf.member->element);
        if (degree < 1 || degree > max_degree) {
            Inspection::fail(Law::degree, inspection_->name(leaf.step) + " has the degree " +
                                              std::to_string(degree) + ", not 1 to " +
                                              std::to_string(max_degree));
        }
        check_corner_values(leaf);
        for (std::size_t axis = 0; axis < topology(leaf.shape).dimension; ++axis) {
            for (const Point& through : {Point{0.15, 0.25, 0.3}, Point{0.35, 0.1, 0.2}}) {
                Point from = through;
                from[axis] = 0;
                check_line(leaf, degree, from, axis);
            }
        }
    }

private:
    void check_corner_values(const CheckedElement& leaf) const;
    void check_line(const CheckedElement& leaf, int degree, Point from, std::size_t axis) const;
    std::vector<double> evaluate(const CheckedElement& leaf, std::span<const Point> points) const {
        std::vector<double> values(points.size() * inspection_->components());
        inspection_->hierarchy().evaluate(inspection_->task(), leaf.member->element, points,
                                          values.data());
        return values;
    }

    Inspection* inspection_;
};

void DegreeLaw::check_corner_values(const CheckedElement& leaf) const {
    const Topology& t = topology(leaf.shape);
    const std::size_t components = inspection_->components();
    const std::vector<double> values = evaluate(leaf, std::span(t.reference).first(t.corners));
    const KnownNodes& nodes = inspection_->nodes();
    const double tolerance = inspection_->tolerance(64) * nodes.largest_value();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t k = i / components;
        const auto where = [&] {
            return "corner " + std::to_string(k) + " of " + inspection_->name(leaf.step);
        };
        if (!std::isfinite(values[i])) {
            Inspection::fail(Law::degree, "evaluate() gives no finite number at " + where());
        }
        const std::size_t node = *nodes.find(leaf.corner[k].place);
        if (nodes[node].hangs) continue;
        const double value = nodes.values(node, components)[i % components];
        if (std::abs(values[i] - value) <= tolerance) continue;
        Inspection::fail(Law::degree, "evaluate() gives " + std::to_string(values[i]) + " at " +
                                          where() + ", but the node there has the value " +
                                          std::to_string(value));
    }
}

/// Looks along a line from a point whose coordinate along an axis is 0.
void DegreeLaw::check_line(const CheckedElement& leaf, int degree, Point from,
                           std::size_t axis) const {
    const double length = length_inside(leaf.shape, from, axis);
    std::vector<Point> points(static_cast<std::size_t>(degree) + 2, from);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double along = length * static_cast<double>(i) / (degree + 1);
        points[i][axis] = along;
        if (leaf.shape != Shape::pyramid || axis < 2) continue;
        for (std::size_t d = 0; d < 2; ++d) points[i][d] *= 1 - along;
    }
    const std::size_t components = inspection_->components();
    const std::vector<double> values = evaluate(leaf, points);
    std::vector<double> along(points.size());
    for (std::size_t c = 0; c < components; ++c) {
        double scale = inspection_->nodes().largest_value();
        for (std::size_t i = 0; i < points.size(); ++i) {
            along[i] = values[i * components + c];
            scale = std::max(scale, std::abs(along[i]));
        }
        const double off = highest_difference(along);
        if (std::abs(off) <= inspection_->tolerance(64) * scale) continue;
        Inspection::fail(Law::degree, "the field is no polynomial of degree " +
                                          std::to_string(degree) + " along direction " +
                                          std::to_string(axis) + " in " +
                                          inspection_->name(leaf.step) + ", as degree() says");
    }
}

}  // namespace

GridLawPointer degree_law(Inspection& inspection) {
    return std::make_unique<DegreeLaw>(inspection);
}

}  // namespace nestgrid::detail
