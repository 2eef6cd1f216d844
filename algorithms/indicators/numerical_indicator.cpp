// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/numerical_indicator.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <unordered_map>
#include <vector>

#include <indicators/eta_source.hpp>
#include <indicators/gradient_lanes.hpp>
#include <indicators/vector_box.hpp>
#include <nestgrid/detail/shape_functions.hpp>

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

/// A derivative that is not 0: of the shape function of a corner, along an axis.
struct Slope {
    std::uint8_t corner;
    std::uint8_t axis;
    double value;
};

/// The derivatives of all shape functions at a point of the reference element that are not 0.
std::vector<Slope> slopes_at(Shape shape, const Point& s) {
    const ShapeSlopes all = shape_slopes(shape, s);
    std::vector<Slope> slopes;
    for (std::uint8_t k = 0; k < topology(shape).corners; ++k) {
        for (std::uint8_t d = 0; d < topology(shape).dimension; ++d) {
            if (all[k][d] != 0) slopes.push_back({k, d, all[k][d]});
        }
    }
    return slopes;
}

/// The gradients in the elements that make a node, and the greatest diameter of these.
struct Jump {
    VectorBox gradients;
    float diameter = 0;

    /// As those of a box, and the diameter, which is not negative.
    using Numbers = std::array<std::uint32_t, 7>;
    Numbers numbers() const {
        const VectorBox::Numbers box = gradients.numbers();
        Numbers all{};
        std::copy(box.begin(), box.end(), all.begin());
        all.back() = std::bit_cast<std::uint32_t>(diameter);
        return all;
    }
    bool raise(const Numbers& other) {
        VectorBox::Numbers box;
        std::copy_n(other.begin(), box.size(), box.begin());
        const auto told = std::bit_cast<float>(other.back());
        const bool longer = diameter < told;
        diameter = std::max(diameter, told);
        return gradients.raise(box) || longer;
    }
};

/// Gradients at the new nodes of a split, several at once. On a simplex there is one.
template <std::size_t count>
class SplitGradients {
public:
    /// Computes the gradients at new nodes n ... n + count - 1, or at fewer where the split ends.
    /// \param slopes at the new nodes
    void solve(const MeasuredSplit& split, const std::vector<std::vector<Slope>>& slopes,
               std::size_t n) {
        for (std::size_t lane = 0; lane < count && n + lane < slopes.size(); ++lane) {
            put(split, slopes[n + lane], lane);
        }
        lanes_.solve(topology(split.rule.parent).dimension, 1);
    }
    std::array<float, 3> of(std::size_t lane) {
        constexpr double most = std::numeric_limits<float>::max();
        std::array<float, 3> g;
        for (std::size_t d = 0; d < 3; ++d) {
            g[d] = static_cast<float>(std::clamp(lanes_.result()[d][lane], -most, most));
        }
        return g;
    }

private:
    /// Puts the function of a split into a lane, as it is where shape functions have these slopes.
    void put(const MeasuredSplit& split, const std::vector<Slope>& slopes, std::size_t lane) {
        std::array<Point, 3> along{};
        std::array<double, 3> rise{};
        for (const auto& [corner, axis, value] : slopes) {
            along[axis] = along[axis] + value * split.positions[corner];
            rise[axis] += value * split.values[corner * split.components];
        }
        for (std::size_t d = 0; d < 3; ++d) lanes_.set(lane, d, along[d], rise[d]);
    }

    GradientLanes<count> lanes_;
};

constexpr std::size_t most_lanes = 8;

class JumpSource final : public EtaSource {
public:
    std::string name() const override { return "the numerical indicator"; }
    void agree(const SharedNodes& shared, NodeEtas& etas) override {
        const auto jump = [&](NodeKey key) -> Jump& {
            const std::size_t node = etas.maxima().number(key);
            if (node >= jumps_.size()) jumps_.resize(node + 1);
            return jumps_[node];
        };
        shared.raise<Jump::Numbers>(
            [&](NodeKey key) { return jump(key).numbers(); },
            [&](NodeKey key, const Jump::Numbers& told) { return jump(key).raise(told); });
    }
    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               NodeEtas& etas) override {
        const Rule& rule = split.rule;
        const auto made = nodes.subspan(split.corner_count());
        const std::vector<std::vector<Slope>>& slopes = slopes_of(rule);
        const float diameter = detail::float_above(split.diameter());
        const auto add = [&](std::size_t n, const std::array<float, 3>& gradient) {
            if (made[n] >= jumps_.size()) jumps_.resize(made[n] + 1);
            Jump& jump = jumps_[made[n]];
            jump.gradients.add(gradient);
            jump.diameter = std::max(jump.diameter, diameter);
            etas.raise(made[n], finite_offset(split.offset(n)));
        };
        if (is_simplex(rule.parent)) {
            one_.solve(split, slopes, 0);
            for (std::size_t n = 0; n < made.size(); ++n) add(n, one_.of(0));
            return;
        }
        for (std::size_t n = 0; n < made.size(); ++n) {
            const std::size_t lane = n % most_lanes;
            if (lane == 0) several_.solve(split, slopes, n);
            add(n, several_.of(lane));
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
    const std::vector<std::vector<Slope>>& slopes_of(const Rule& rule) {
        std::vector<std::vector<Slope>>& slopes = slopes_[&rule];
        if (!slopes.empty()) return slopes;
        const std::vector<Point> reference = reference_nodes(rule);
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const auto corners = static_cast<std::size_t>(rule.corner_count());
            slopes.push_back(slopes_at(rule.parent, reference[corners + n]));
        }
        return slopes;
    }

    std::vector<Jump> jumps_;
    SplitGradients<1> one_;
    SplitGradients<most_lanes> several_;
    std::unordered_map<const Rule*, std::vector<std::vector<Slope>>> slopes_;
};

template <class Real>
SweptIndicator sweep_jumps(const Hierarchy<Real>& hierarchy, const NumericalOptions& options) {
    JumpSource source;
    return sweep_source(hierarchy, source, options.spread);
}

}  // namespace

}  // namespace engine

SweptIndicator numerical_indicator(const FieldOnGrid& field, const NumericalOptions& options) {
    return field.visit(
        [&](const auto& hierarchy) { return engine::sweep_jumps(hierarchy, options); });
}

}  // namespace nestgrid
