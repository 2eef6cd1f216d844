// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <numeric>

#include <high_order/virtual_elements.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>
#include <projection/by_criterion.hpp>
#include <surfaces/node_gradients.hpp>
#include <surfaces/probed_colours.hpp>

namespace nestgrid {

namespace engine {

/// Points and the leaves around them.
class PolynomialPoints {
public:
    PolynomialPoints(const HighOrder& data, std::span<const Point> points)
        : data_{data.data_.get()},
          leaf_(points.size(), VirtualElement::no_leaf),
          place_(points.size()) {
        std::vector<std::size_t> all(points.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        probed = look(data, points, all, points);
    }

    /// Takes points that were not found, as vertices on a curved boundary that is drawn more
    /// coarsely, to leaves beside them.
    void find_rest(const HighOrder& data, std::span<const Point> points) {
        for (double by = near(); by > 0 && by < extent(); by *= 8) {
            for (std::size_t side = 0; side < 6; ++side) {
                std::vector<std::size_t> rest;
                std::vector<Point> beside;
                for (std::size_t i = 0; i < points.size(); ++i) {
                    if (leaf_[i] != VirtualElement::no_leaf) continue;
                    rest.push_back(i);
                    beside.push_back(points[i]);
                    beside.back()[side / 2] += side % 2 == 0 ? by : -by;
                }
                if (rest.empty()) return;
                look(data, beside, rest, points);
            }
        }
    }

    /// The values of all components at a point that was found.
    void put_values(std::size_t i) {
        const LeafPolynomial& leaf = data_->field.records.leaves()[leaf_[i]];
        for (std::size_t c = 0; c < probed.components; ++c) {
            probed.values[i * probed.components + c] = net_value(
                data_->field.records.net(leaf, c), leaf.degree, leaf.factors(), place_[i]);
        }
    }

    /// Gradients of component 0; 0 at points that were not found.
    std::vector<Point> gradients() const {
        std::vector<Point> all(leaf_.size(), Point{0, 0, 0});
        std::vector<std::size_t> order(leaf_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](auto a, auto b) { return leaf_[a] < leaf_[b]; });
        auto next = order.begin();
        std::uint32_t number = 0;  // leaves have the order of the walk
        data_->walk.for_each([&](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule != nullptr) return;
            for (; next != order.end() && leaf_[*next] == number; ++next) {
                all[*next] = gradient(*next, way.back());
            }
            ++number;
        });
        return all;
    }

    ProbeResult probed;

private:
    double extent() const { return data_->places ? data_->places->records.extent() : 0; }
    double near() const { return 1e-3 * extent(); }

    /// Finds places for some of all points, in the leaves around points that are near them.
    /// \param number of each
    ProbeResult look(const HighOrder& data, std::span<const Point> around,
                     std::span<const std::size_t> number, std::span<const Point> points) {
        // At a tolerance that all leaves are within, elements are those of the hierarchy, and where
        // leaves are curved parts of them.
        const VirtualRefinement leaves(
            data, {.tolerance = std::numeric_limits<double>::max(), .position_tolerance = near()});
        ProbeResult result = engine::probe<double>(leaves, around);
        const auto elements = result.elements.as<VirtualElement>();
        for (std::size_t i = 0; i < around.size(); ++i) {
            if (!result.found(i)) continue;
            const std::size_t n = number[i];
            const VirtualElement& e = elements[result.element_of[i]];
            leaf_[n] = e.leaf;
            const LeafPolynomial& leaf = data_->field.records.leaves()[e.leaf];
            const Point at = in_leaf(leaf.parts(), e, result.reference[i]);
            place_[n] = leaf.shape == Shape::pyramid ? collapsed(at) : at;
            if (data_->places) place_[n] = found_in(leaf_[n], points[n], place_[n]);
        }
        return result;
    }
    /// A point of an element below a leaf, in the reference element of the leaf.
    static Point in_leaf(const ShapeParts& leaf, const VirtualElement& e, const Point& reference) {
        const ShapeParts* shape = &leaf;
        std::array<Place, max_corners> at{};
        for (std::size_t k = 0; k < leaf.corners; ++k) at[k] = leaf.reference_corner(k);
        for (int level = e.level; level > 0; --level) {
            const auto number = static_cast<std::size_t>(e.way >> 4 * (level - 1) & 15U);
            const Child& child = shape->rule->children[number];
            at = child_places(*shape, at, child);
            shape = &parts_of(child.shape);
        }
        const Point origin = point_at(at[0], e.level);
        Point x = origin;
        for (std::size_t d = 0; d < shape->dimension; ++d) {
            x = x + reference[d] * (point_at(at[shape->axis[d]], e.level) - origin);
        }
        return x;
    }
    /// Newton's method for the place of a point in a curved leaf, from one that is near.
    Point found_in(std::uint32_t leaf, const Point& x, const Point& near) const {
        const LeafRecords& records = data_->places->records;
        const LeafPolynomial& of = records.leaves()[leaf];
        Point at = near;
        for (int step = 0; step < 20; ++step) {
            Point off;
            for (std::size_t d = 0; d < 3; ++d) {
                off[d] = x[d] - net_value(records.net(of, d), of.degree, of.factors(), at);
            }
            const auto dual = dual_vectors(axes_at(leaf, at), int(of.parts().dimension));
            if (dual.volume == 0) break;
            Point move{0, 0, 0};
            for (std::size_t d = 0; d < of.parts().dimension; ++d) {
                move[d] = dot(dual.of[d], off) / dual.volume;
            }
            at = at + move;
            if (norm(at - near) > 0.5) return near;
            if (norm(move) < 1e-14) break;
        }
        return at;
    }
    /// Derivatives of the position in a curved leaf along the axes.
    std::array<Point, 3> axes_at(std::uint32_t leaf, const Point& at) const {
        const LeafRecords& records = data_->places->records;
        const LeafPolynomial& of = records.leaves()[leaf];
        std::array<Point, 3> along{};
        for (std::size_t d = 0; d < 3; ++d) {
            const Point slope = net_gradient(records.net(of, d), of.degree, of.factors(), at);
            for (std::size_t axis = 0; axis < 3; ++axis) along[axis][d] = slope[axis];
        }
        return along;
    }
    Point gradient(std::size_t i, const BaseElement& e) const {
        const LeafPolynomial& leaf = data_->field.records.leaves()[leaf_[i]];
        const Factors& factors = leaf.factors();
        Point at = place_[i];
        // The apex of a pyramid has no gradient: that of a point below.
        if (leaf.shape == Shape::pyramid) at[2] = std::min(at[2], 1 - 1e-6);
        const Point inner = net_gradient(data_->field.records.net(leaf), leaf.degree, factors, at);
        std::array<Point, 3> along{};  // derivatives of the position
        if (data_->places) along = axes_at(leaf_[i], at);
        for (std::size_t d = 0; d < 3 && !data_->places; ++d) {
            std::array<double, max_corners> x{};
            x.fill(e.x[e.shape->corners - 1][d]);  // the apex is four corners of the box
            for (std::size_t k = 0; k < e.shape->corners; ++k) {
                x[net_corner(1, factors, k)] = e.x[k][d];
            }
            const Point slope = net_gradient(x.data(), 1, factors, at);
            for (std::size_t axis = 0; axis < 3; ++axis) along[axis][d] = slope[axis];
        }
        return dual_vectors(along, static_cast<int>(e.shape->dimension)).gradient(inner);
    }

    const HighOrderData* data_;
    std::vector<std::uint32_t> leaf_;
    std::vector<Point> place_;  // in the coordinates of the leaf's net: in a pyramid the box's
};

}  // namespace engine

ProbeResult probe(const HighOrder& data, std::span<const Point> points) {
    engine::PolynomialPoints at(data, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (at.probed.found(i)) at.put_values(i);
    }
    at.probed.elements = Elements();
    at.probed.element_of.clear();
    at.probed.shape_of.clear();
    return std::move(at.probed);
}

void set_polynomial_normals(Surface<3>& surface, const HighOrder& data) {
    engine::PolynomialPoints at(data, surface.vertices);
    at.find_rest(data, surface.vertices);
    surface.normals = at.gradients();
    for (Point& normal : surface.normals) {
        const double length = norm(normal);
        if (length > 0) normal = (-1 / length) * normal;
    }
}

void set_polynomial_colours(Surface<3>& surface, const HighOrder& data) {
    if (surface.attributes.empty()) return;
    engine::ProbedColours(surface, [&](std::span<const Point> points) {
        return probe(data, points);
    }).colour_from(0);
}

}  // namespace nestgrid
