// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of check_grid: leaves of higher degree, and curved ones. On every line in the leaf along
// which the field, or a coordinate, is a polynomial of its degree p, the difference of order p + 1
// of its values at p + 2 points in equal steps vanishes.
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

/// Polynomials of leaves: each has at the corners what the nodes have there, and the degree that is
/// told.
class PolynomialLaw : public GridLaw {
public:
    /// What the polynomials are, and who tells them.
    struct Names {
        Feature feature;
        Law law;
        const char* at_node;   ///< what a node has
        const char* what;      ///< what is a polynomial
        const char* degree;    ///< what a leaf has
        const char* tells;     ///< the operation that tells that
        const char* evaluate;  ///< the operation that tells the polynomial
    };
    PolynomialLaw(Inspection& inspection, const Names& names, std::size_t components)
        : inspection_{&inspection}, names_{names}, components_{components} {}

    void revisit(const CheckedElement& leaf) final {
        if (!offered() || !leaf.is_leaf() || leaf.member->hidden == Hidden::wholly) return;
        const int degree = degree_of(leaf);
        if (degree < 1 || degree > max_degree) {
            fail(inspection_->name(leaf.step) + " has the " + names_.degree + " " +
                 std::to_string(degree) + ", not 1 to " + std::to_string(max_degree));
        }
        check_corners(leaf);
        for (std::size_t axis = 0; axis < topology(leaf.shape).dimension; ++axis) {
            for (const Point& through : {Point{0.15, 0.25, 0.3}, Point{0.35, 0.1, 0.2}}) {
                Point from = through;
                from[axis] = 0;
                check_line(leaf, degree, from, axis);
            }
        }
    }

protected:
    bool offered() const { return inspection_->offers(names_.feature); }
    [[noreturn]] void fail(const std::string& sentence) const {
        Inspection::fail(names_.law, sentence);
    }

    Inspection* inspection_;

private:
    virtual int degree_of(const CheckedElement& leaf) const = 0;
    /// \return all components, point by point
    virtual std::vector<double> evaluate(const CheckedElement& leaf,
                                         std::span<const Point> points) const = 0;
    /// What a component is at a node.
    virtual double at_node(std::size_t node, std::size_t component) const = 0;
    /// The greatest magnitude, as far as it is known.
    virtual double size() const = 0;

    void check_corners(const CheckedElement& leaf) const;
    void check_line(const CheckedElement& leaf, int degree, Point from, std::size_t axis) const;

    Names names_;
    std::size_t components_;
};

void PolynomialLaw::check_corners(const CheckedElement& leaf) const {
    const Topology& t = topology(leaf.shape);
    const std::vector<double> values = evaluate(leaf, std::span(t.reference).first(t.corners));
    const double tolerance = inspection_->tolerance(64) * size();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t k = i / components_;
        const auto where = [&] {
            return "corner " + std::to_string(k) + " of " + inspection_->name(leaf.step);
        };
        if (!std::isfinite(values[i])) {
            fail(std::string(names_.evaluate) + " gives no finite number at " + where());
        }
        const std::size_t node = *inspection_->nodes().find(leaf.corner[k].place);
        if (inspection_->nodes()[node].hangs) continue;
        const double value = at_node(node, i % components_);
        if (std::abs(values[i] - value) <= tolerance) continue;
        fail(std::string(names_.evaluate) + " gives " + std::to_string(values[i]) + " at " +
             where() + ", but the node there has the " + names_.at_node + " " +
             std::to_string(value));
    }
}

/// Looks along a line from a point whose coordinate along an axis is 0.
void PolynomialLaw::check_line(const CheckedElement& leaf, int degree, Point from,
                               std::size_t axis) const {
    const double length = length_inside(leaf.shape, from, axis);
    std::vector<Point> points(static_cast<std::size_t>(degree) + 2, from);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double along = length * static_cast<double>(i) / (degree + 1);
        points[i][axis] = along;
        if (leaf.shape != Shape::pyramid || axis < 2) continue;
        for (std::size_t d = 0; d < 2; ++d) points[i][d] *= 1 - along;
    }
    const std::vector<double> values = evaluate(leaf, points);
    std::vector<double> along(points.size());
    for (std::size_t c = 0; c < components_; ++c) {
        double scale = size();
        for (std::size_t i = 0; i < points.size(); ++i) {
            along[i] = values[i * components_ + c];
            scale = std::max(scale, std::abs(along[i]));
        }
        const double off = highest_difference(along);
        if (std::abs(off) <= inspection_->tolerance(64) * scale) continue;
        fail("the " + std::string(names_.what) + " is no polynomial of degree " +
             std::to_string(degree) + " along direction " + std::to_string(axis) + " in " +
             inspection_->name(leaf.step) + ", as " + names_.tells + " says");
    }
}

/// The field.
class DegreeLaw final : public PolynomialLaw {
public:
    explicit DegreeLaw(Inspection& inspection)
        : PolynomialLaw(
              inspection,
              {Feature::degree, Law::degree, "value", "field", "degree", "degree()", "evaluate()"},
              inspection.components()) {}

private:
    int degree_of(const CheckedElement& leaf) const override {
        return inspection_->hierarchy().degree(inspection_->task(), leaf.member->element);
    }
    std::vector<double> evaluate(const CheckedElement& leaf,
                                 std::span<const Point> points) const override {
        std::vector<double> values(points.size() * inspection_->components());
        inspection_->hierarchy().evaluate(inspection_->task(), leaf.member->element, points,
                                          values.data());
        return values;
    }
    double at_node(std::size_t node, std::size_t component) const override {
        return inspection_->nodes().values(node, inspection_->components())[component];
    }
    double size() const override { return inspection_->nodes().largest_value(); }
};

/// Positions in curved leaves. The nodes are where the grid puts them.
class CurvedLaw final : public PolynomialLaw {
public:
    explicit CurvedLaw(Inspection& inspection)
        : PolynomialLaw(inspection,
                        {Feature::geometry_degree, Law::map, "coordinate", "position",
                         "geometry degree", "geometry_degree()", "map()"},
                        3) {}

    void visit(const MadeNode& made) override {
        if (!offered() || !made.is_new) return;
        position_.resize(std::max(position_.size(), made.known + 1));
        position_[made.known] = position_of(made);
        for (const double x : position_[made.known]) size_ = std::max(size_, std::abs(x));
    }

private:
    Point position_of(const MadeNode& made) const {
        if (made.stencil == nullptr) return made.node().position;
        const std::size_t corners = made.element.corners().size();
        if (inspection_->offers(Feature::new_positions)) {
            std::array<Point, max_new_nodes> x;
            const std::size_t n = made.number - corners;
            inspection_->hierarchy().new_positions(
                inspection_->task(), made.element.member->element, NodeMask{1} << n,
                std::span(x).first(made.element.member->rule->new_nodes.size()));
            return x[n];
        }
        Point mean{0, 0, 0};
        for (std::size_t i = 0; i < made.stencil->count; ++i) {
            const CheckedNode& parent = made.nodes[made.stencil->parent[i]];
            mean = mean +
                   made.stencil->weight[i] * position_[*inspection_->nodes().find(parent.place)];
        }
        return mean;
    }
    int degree_of(const CheckedElement& leaf) const override {
        return inspection_->hierarchy().geometry_degree(inspection_->task(), leaf.member->element);
    }
    std::vector<double> evaluate(const CheckedElement& leaf,
                                 std::span<const Point> points) const override {
        std::vector<Point> mapped(points.size());
        inspection_->hierarchy().map(inspection_->task(), leaf.member->element, points, mapped);
        std::vector<double> values;
        for (const Point& x : mapped) values.insert(values.end(), x.begin(), x.end());
        return values;
    }
    double at_node(std::size_t node, std::size_t component) const override {
        return position_[node][component];
    }
    double size() const override { return size_; }

    std::vector<Point> position_;  // of the nodes
    double size_ = 0;
};

}  // namespace

GridLawPointer degree_law(Inspection& inspection) {
    return std::make_unique<DegreeLaw>(inspection);
}
GridLawPointer curved_law(Inspection& inspection) {
    return std::make_unique<CurvedLaw>(inspection);
}

}  // namespace nestgrid::detail
