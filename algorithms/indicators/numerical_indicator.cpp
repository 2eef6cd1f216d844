// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/numerical_indicator.hpp>

#include <algorithm>
#include <unordered_map>

#include <indicators/eta_source.hpp>
#include <indicators/vector_box.hpp>
#include <nestgrid/detail/shape_functions.hpp>
#include <walk/gradient.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// The derivatives along the axes of the reference element of the shape function of each corner.
using ShapeSlopes = std::array<Point, max_corners>;

ShapeSlopes shape_slopes(Shape shape, const Point& s) {
    const Topology& t = topology(shape);
    const auto here = shape_functions(shape, s);
    ShapeSlopes slopes{};
    for (std::size_t d = 0; d < t.dimension; ++d) {
        // All shape functions are affine along each axis, but for the axis of a pyramid.
        if (shape == Shape::pyramid && d == 2) continue;
        Point next = s;
        next[d] += 1;
        const auto there = shape_functions(shape, next);
        for (std::size_t k = 0; k < t.corners; ++k) slopes[k][d] = there[k] - here[k];
    }
    if (shape == Shape::pyramid) {
        const double h = 1 - s[2];
        const double twist = h > 0 ? s[0] * s[1] / (h * h) : 0;
        const std::array<double, 5> along_axis{twist - 1, -twist, -twist, twist, 1};
        for (std::size_t k = 0; k < t.corners; ++k) slopes[k][2] = along_axis[k];
    }
    return slopes;
}

/// The gradient of component 0 in the element of a split, where its shape functions have these
/// derivatives.
Point gradient(const MeasuredSplit& split, const ShapeSlopes& slopes) {
    const Topology& t = topology(split.rule.parent);
    std::array<Point, 3> along{};
    std::array<double, 3> rise{};
    for (std::size_t k = 0; k < t.corners; ++k) {
        for (std::size_t d = 0; d < t.dimension; ++d) {
            along[d] = along[d] + slopes[k][d] * split.positions[k];
            rise[d] += slopes[k][d] * split.values[k * split.components];
        }
    }
    return dual_vectors(along, t.dimension).gradient(rise);
}

/// The gradients in the elements that make a node, and the greatest diameter of these.
struct Jump {
    VectorBox gradients;
    float diameter = 0;
};

class JumpSource final : public EtaSource {
public:
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               NodeEtas& etas) override {
        const Rule& rule = split.rule;
        const auto made = nodes.subspan(split.corner_count());
        const std::vector<ShapeSlopes>& slopes = slopes_of(rule);
        const float diameter = float_above(split.diameter());
        const bool one = is_simplex(rule.parent);
        Point g{};
        for (std::size_t n = 0; n < made.size(); ++n) {
            if (made[n] >= jumps_.size()) jumps_.resize(made[n] + 1);
            if (n == 0 || !one) g = gradient(split, slopes[n]);
            Jump& jump = jumps_[made[n]];
            jump.gradients.add(g);
            jump.diameter = std::max(jump.diameter, diameter);
            etas.raise(made[n], finite_offset(split.offset(n)));
        }
    }
    void finish(NodeEtas& etas) override {
        for (std::size_t node = 0; node < jumps_.size(); ++node) {
            const Jump& jump = jumps_[node];
            etas.raise(node, double{jump.diameter} * jump.gradients.diagonal());
        }
    }

private:
    /// At the new nodes of a rule.
    const std::vector<ShapeSlopes>& slopes_of(const Rule& rule) {
        std::vector<ShapeSlopes>& slopes = slopes_[&rule];
        if (!slopes.empty()) return slopes;
        const std::vector<Point> reference = reference_nodes(rule);
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const auto corners = static_cast<std::size_t>(rule.corner_count());
            slopes.push_back(shape_slopes(rule.parent, reference[corners + n]));
        }
        return slopes;
    }

    std::vector<Jump> jumps_;
    std::unordered_map<const Rule*, std::vector<ShapeSlopes>> slopes_;
};

template <class Real>
SweptIndicator sweep_jumps(const Hierarchy<Real>& hierarchy, const NumericalOptions& options) {
    JumpSource source;
    return sweep_source(hierarchy, source, options.spread);
}

}  // namespace

}  // namespace engine

SweptIndicator numerical_indicator(const Hierarchy<float>& hierarchy,
                                   const NumericalOptions& options) {
    return engine::sweep_jumps(hierarchy, options);
}

SweptIndicator numerical_indicator(const Hierarchy<double>& hierarchy,
                                   const NumericalOptions& options) {
    return engine::sweep_jumps(hierarchy, options);
}

}  // namespace nestgrid
