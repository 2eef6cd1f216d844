// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/visual_indicator.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <indicators/corner_axes.hpp>
#include <indicators/diameter.hpp>
#include <indicators/eta_source.hpp>
#include <indicators/vector_box.hpp>
#include <nestgrid/error.hpp>
#include <walk/gradient.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/walk.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// The true function in a child.
struct ChildFunction {
    Shape shape;
    std::array<Point, max_corners> position;
    std::array<double, max_corners> value;

    ChildFunction(const MeasuredSplit& split, const Child& child) : shape{child.shape} {
        for (std::size_t k = 0; k < topology(shape).corners; ++k) {
            position[k] = split.positions[child.corner[k]];
            value[k] = split.values[child.corner[k] * split.components];
        }
    }

    Point gradient(std::size_t i) const {
        const auto dimension = static_cast<std::size_t>(topology(shape).dimension);
        const CornerAxes axes = corner_axes(shape, i);
        std::array<Point, 3> along{};
        std::array<double, 3> rise{};
        for (std::size_t d = 0; d < dimension; ++d) {
            along[d] = position[axes[d][1]] - position[axes[d][0]];
            rise[d] = value[axes[d][1]] - value[axes[d][0]];
        }
        return dual_vectors(along, topology(shape).dimension).gradient(rise);
    }
};

/// Boxes of the normals around each node.
class NormalSource final : public EtaSource {
public:
    explicit NormalSource(double tau) : tau_{tau} {}

    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               NodeEtas& etas) override {
        const std::size_t corners = split.corner_count();
        for (std::size_t n = 0; corners + n < nodes.size(); ++n) {
            const std::size_t node = nodes[corners + n];
            if (node >= boxes_.size()) boxes_.resize(node + 1);
            etas.raise(node, trace_of(split.offset(n)));
        }
        for (const Child& child : split.rule.children) {
            const VectorBox box = normals(split, child);
            for (std::size_t k = 0; k < topology(child.shape).corners; ++k) {
                if (child.corner[k] >= corners) boxes_[nodes[child.corner[k]]].add(box);
            }
        }
    }
    void finish(NodeEtas& etas) override {
        for (std::size_t node = 0; node < boxes_.size(); ++node) {
            etas.raise(node, std::min(2.0, boxes_[node].diagonal()));
        }
    }

private:
    VectorBox normals(const MeasuredSplit& split, const Child& child) const {
        const ChildFunction f(split, child);
        const std::size_t corners = topology(child.shape).corners;
        const double h = diameter_of(std::span(f.position).first(corners));
        VectorBox box;
        const std::size_t count = gradient_count(child.shape);
        const std::size_t plain = child.shape == Shape::pyramid ? 4 : count;
        for (std::size_t i = 0; i < plain; ++i) box.add(normal(h * f.gradient(i)));
        if (plain == count) return box;
        Point sum{0, 0, 0};
        for (std::size_t i = plain; i < count; ++i) sum = sum + f.gradient(i);
        box.add(normal(h / static_cast<double>(count - plain) * sum));
        return box;
    }
    /// \param rise the gradient times the diameter
    Point normal(const Point& rise) const {
        const double length = std::sqrt(dot(rise, rise) + tau_ * tau_);
        return length == 0 ? Point{0, 0, 0} : 1 / length * rise;
    }

    double tau_;
    std::vector<VectorBox> boxes_;
};

/// Finds the least and the greatest value of component 0.
template <class Real>
class RangeVisitor final : public Visitor<Real> {
public:
    using View = ElementView<Real>;

    explicit RangeVisitor(std::size_t components) : components_{components} {}

    Real range() const { return least_ < greatest_ ? greatest_ - least_ : 0; }

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule&, const Real*, NodeMask, bool) override { return {}; }
    Decision inspect(const View& view, const Split&) override {
        if (view.level == 0) add(view.value, view.corner_count());
        return {};
    }
    void extract(const View&) override {}
    void entered(const View& view, const Split& split, const Real* value) override {
        add(value + view.corner_count() * components_, split.rule->new_nodes.size());
    }

private:
    void add(const Real* value, std::size_t nodes) {
        for (std::size_t i = 0; i < nodes; ++i) {
            least_ = std::min(least_, value[i * components_]);
            greatest_ = std::max(greatest_, value[i * components_]);
        }
    }

    std::size_t components_;
    Real least_ = std::numeric_limits<Real>::max();
    Real greatest_ = std::numeric_limits<Real>::lowest();
};

/// 2^-20 of the range of component 0.
template <class Real>
double default_tau(const Hierarchy<Real>& hierarchy) {
    const HangingNodes hanging = find_hanging_nodes(hierarchy);
    const Walk<Real> walk(hierarchy, {.keys = false}, &hanging);
    RangeVisitor<Real> visitor(walk.components());
    walk.run(visitor);
    return 0x1p-20 * static_cast<double>(visitor.range());
}

template <class Real>
SweptIndicator sweep_normals(const Hierarchy<Real>& hierarchy, const VisualOptions& options) {
    if (options.tau && !(*options.tau >= 0 && std::isfinite(*options.tau))) {
        throw InvalidInput("tau is a finite difference of data that is not negative, not " +
                           std::to_string(*options.tau));
    }
    NormalSource source(options.tau ? *options.tau : default_tau(hierarchy));
    return sweep_source(hierarchy, source, options.spread);
}

}  // namespace

}  // namespace engine

SweptIndicator visual_indicator(const Hierarchy<float>& hierarchy, const VisualOptions& options) {
    return engine::sweep_normals(hierarchy, options);
}

SweptIndicator visual_indicator(const Hierarchy<double>& hierarchy, const VisualOptions& options) {
    return engine::sweep_normals(hierarchy, options);
}

}  // namespace nestgrid
