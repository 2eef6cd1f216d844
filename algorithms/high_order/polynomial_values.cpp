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
        : data_{data.data_.get()} {
        // At a tolerance that all leaves are within, elements are those of the hierarchy.
        const VirtualRefinement leaves(data, {.tolerance = std::numeric_limits<double>::max()});
        probed = probe<double>(leaves, points);
        const auto elements = probed.elements.as<VirtualElement>();
        for (std::size_t i = 0; i < points.size(); ++i) {
            leaf_.push_back(probed.found(i) ? elements[probed.element_of[i]].leaf
                                            : VirtualElement::no_leaf);
        }
    }

    /// The values of all components at a point that was found.
    void put_values(std::size_t i) {
        const LeafPolynomial& leaf = data_->records.leaves()[leaf_[i]];
        for (std::size_t c = 0; c < probed.components; ++c) {
            probed.values[i * probed.components + c] =
                net_value(data_->records.net(leaf, c), leaf.degree, leaf.factors(), place(i, leaf));
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
    /// The probed point in the coordinates of its leaf's net: those of the reference element, but
    /// in a pyramid those of the collapsed box.
    Point place(std::size_t i, const LeafPolynomial& leaf) const {
        const Point& at = probed.reference[i];
        return leaf.shape == Shape::pyramid ? collapsed(at) : at;
    }
    Point gradient(std::size_t i, const BaseElement& e) const {
        const LeafPolynomial& leaf = data_->records.leaves()[leaf_[i]];
        const Factors& factors = leaf.factors();
        Point at = place(i, leaf);
        // The apex of a pyramid has no gradient: that of a point below.
        if (leaf.shape == Shape::pyramid) at[2] = std::min(at[2], 1 - 1e-6);
        const Point inner = net_gradient(data_->records.net(leaf), leaf.degree, factors, at);
        std::array<Point, 3> along{};  // derivatives of the position
        for (std::size_t d = 0; d < 3; ++d) {
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
    surface.normals = engine::PolynomialPoints(data, surface.vertices).gradients();
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
