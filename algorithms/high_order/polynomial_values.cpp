// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <numeric>

#include <high_order/virtual_elements.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>
#include <probes/inverse_map.hpp>
#include <projection/by_criterion.hpp>
#include <surfaces/node_gradients.hpp>
#include <surfaces/probed_colours.hpp>

namespace nestgrid {

namespace engine {

/// Points and the leaves around them.
class PolynomialPoints {
public:
    /// Which of the points that lie in no drawn part of a curved leaf get the leaf beside them.
    enum class Beside {
        inside,   ///< those that lie in it
        nearest,  ///< all: vertices of surfaces that are drawn more coarsely
    };

    PolynomialPoints(const HighOrder& data, std::span<const Point> points, Beside beside)
        : data_{data.data_.get()},
          leaves_(data, {.tolerance = std::numeric_limits<double>::max(),
                         .position_tolerance = near(),
                         .values = looked_at()}),
          found_(points.size()) {
        if (data_->places) polynomials_ = data_->gathered({});
        std::vector<std::size_t> all(points.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        probed = engine::probe<double>(leaves_, points);
        take(probed, all, points, Beside::nearest);
        if (data_->places) {
            look_beside(points, beside);
        } else {
            gather_found();
        }
    }

    /// The values of all components at a point that was found, and its place in the leaf.
    void put_values(std::size_t i) {
        const LeafRecords& records = polynomials_->field;
        const LeafPolynomial& leaf = records.leaves()[found_[i].leaf];
        for (std::size_t c = 0; c < probed.components; ++c) {
            probed.values[i * probed.components + c] =
                net_value(records.net(leaf, c), leaf.degree, leaf.factors(), found_[i].place);
        }
        if (!data_->places) return;
        const auto [x, y, z] = found_[i].place;
        const double width = leaf.shape == Shape::pyramid ? 1 - z : 1;
        probed.reference[i] = {x * width, y * width, z};
    }

    /// Gradients of component 0; 0 at points that were not found.
    std::vector<Point> gradients() const {
        std::vector<Point> all(found_.size(), Point{0, 0, 0});
        std::vector<std::size_t> order(found_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto number_of = [&](std::size_t i) {
            const bool none = found_[i].leaf == VirtualElement::no_leaf;
            return none ? LeafChoice::none : polynomials_->field.leaves()[found_[i].leaf].number;
        };
        std::stable_sort(order.begin(), order.end(),
                         [&](auto a, auto b) { return number_of(a) < number_of(b); });
        auto next = order.begin();
        std::uint32_t number = 0;  // leaves have the order of the walk
        const auto add = [&](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule != nullptr) return;
            for (; next != order.end() && number_of(*next) == number; ++next) {
                all[*next] = gradient(*next, way.back());
            }
            ++number;
        };
        data_->walk.for_each(add, BaseWalk::Positions::yes);
        return all;
    }

    ProbeResult probed;

private:
    struct Found {
        std::uint32_t leaf = VirtualElement::no_leaf;  // among those that are gathered
        std::uint64_t path = 0;                        // of a straight leaf
        Point place{};  // in the coordinates of the leaf's net: in a pyramid the box's
        double depth = -std::numeric_limits<double>::infinity();  // in the leaf

        bool inside() const { return depth > -1e-9; }
    };

    /// Straight leaves are not divided, so that no polynomial is needed before they are found.
    decltype(VirtualOptions::values) looked_at() const {
        if (data_->places) return std::nullopt;
        return decltype(VirtualOptions::values)(std::in_place);
    }
    double near() const { return data_->places ? 1e-3 * data_->places->summary.extent() : 0; }

    /// Looks for what is not inside a leaf that was found: on curved boundaries, and beside faces
    /// that are drawn straight.
    void look_beside(std::span<const Point> points, Beside beside) {
        for (double by = 2 * near(); by < data_->places->summary.extent(); by *= 8) {
            for (std::size_t side = 0; side < 6; ++side) {
                std::vector<std::size_t> rest;
                std::vector<Point> around;
                for (std::size_t i = 0; i < points.size(); ++i) {
                    const bool none = found_[i].leaf == VirtualElement::no_leaf;
                    if (!none && (found_[i].inside() || by > 2 * near())) continue;
                    rest.push_back(i);
                    around.push_back(points[i]);
                    around.back()[side / 2] += side % 2 == 0 ? by : -by;
                }
                if (rest.empty()) return;
                take(engine::probe<double>(leaves_, around), rest, points, beside);
            }
            if (beside == Beside::inside) return;
        }
    }
    /// Reads the polynomials of the leaves that were found, which are straight.
    void gather_found() {
        KeyTable<NodeKey, std::uint32_t> number;
        for (const Found& found : found_) {
            if (found.leaf != VirtualElement::no_leaf) number.insert(NodeKey{found.path}, 0);
        }
        std::uint32_t count = 0;
        const auto chooses = [&](std::size_t, const BaseElement& leaf) {
            std::uint32_t* const at = number.find(NodeKey{static_cast<std::uint64_t>(leaf.path)});
            if (at != nullptr) *at = count++;
            return at != nullptr;
        };
        polynomials_ = std::make_shared<const GatheredLeaves>(
            data_->gather(chooses, LeafChoice::Needs::polynomials));
        for (Found& found : found_) {
            if (found.leaf != VirtualElement::no_leaf) {
                found.leaf = *number.find(NodeKey{found.path});
            }
        }
    }
    /// Takes the leaves around some points for those that they stand for, where these lie deeper in
    /// them than in what was found before.
    /// \param number of the point that each stands for, among `points`
    void take(const ProbeResult& result, std::span<const std::size_t> number,
              std::span<const Point> points, Beside accepted) {
        const auto elements = result.elements.as<VirtualElement>();
        for (std::size_t i = 0; i < number.size(); ++i) {
            if (!result.found(i)) continue;
            const VirtualElement& e = elements[result.element_of[i]];
            const Shape shape = data_->places ? polynomials_->field.leaves()[e.leaf].shape
                                              : result.shape_of[result.element_of[i]];
            const bool pyramid = shape == Shape::pyramid;
            const Point at = in_leaf(parts_of(shape), e, result.reference[i]);
            Found found{e.leaf, e.way, pyramid ? collapsed(at) : at};
            const std::size_t n = number[i];
            if (data_->places) found.place = found_in(e.leaf, points[n], found.place);
            found.depth = face_distance(pyramid ? Shape::hexahedron : shape, found.place);
            if (accepted == Beside::inside && !found.inside()) continue;
            if (found.depth <= found_[n].depth) continue;
            found_[n] = found;
            probed.level[n] = result.level[i];
        }
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
        const LeafRecords& records = *polynomials_->places;
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
        const LeafRecords& records = *polynomials_->places;
        const LeafPolynomial& of = records.leaves()[leaf];
        std::array<Point, 3> along{};
        for (std::size_t d = 0; d < 3; ++d) {
            const Point slope = net_gradient(records.net(of, d), of.degree, of.factors(), at);
            for (std::size_t axis = 0; axis < 3; ++axis) along[axis][d] = slope[axis];
        }
        return along;
    }
    Point gradient(std::size_t i, const BaseElement& e) const {
        const LeafPolynomial& leaf = polynomials_->field.leaves()[found_[i].leaf];
        const Factors& factors = leaf.factors();
        Point at = found_[i].place;
        // The apex of a pyramid has no gradient: that of a point below.
        if (leaf.shape == Shape::pyramid) at[2] = std::min(at[2], 1 - 1e-6);
        const Point inner = net_gradient(polynomials_->field.net(leaf), leaf.degree, factors, at);
        std::array<Point, 3> along{};  // derivatives of the position
        if (data_->places) along = axes_at(found_[i].leaf, at);
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
    /// At a tolerance that all leaves are within, so that elements are those of the hierarchy, and
    /// where leaves are curved parts of them.
    VirtualRefinement leaves_;
    std::shared_ptr<const GatheredLeaves> polynomials_;
    std::vector<Found> found_;
};

}  // namespace engine

namespace {

ProbeResult values_at(const HighOrder& data, std::span<const Point> points,
                      engine::PolynomialPoints::Beside beside) {
    engine::PolynomialPoints at(data, points, beside);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (at.probed.found(i)) at.put_values(i);
    }
    at.probed.elements = Elements();
    at.probed.element_of.clear();
    at.probed.shape_of.clear();
    return std::move(at.probed);
}

}  // namespace

ProbeResult probe(const HighOrder& data, std::span<const Point> points) {
    return values_at(data, points, engine::PolynomialPoints::Beside::inside);
}

void set_polynomial_normals(Surface<3>& surface, const HighOrder& data) {
    using engine::PolynomialPoints;
    surface.normals =
        PolynomialPoints(data, surface.vertices, PolynomialPoints::Beside::nearest).gradients();
    for (Point& normal : surface.normals) {
        const double length = norm(normal);
        if (length > 0) normal = (-1 / length) * normal;
    }
}

void set_polynomial_colours(Surface<3>& surface, const HighOrder& data) {
    if (surface.attributes.empty()) return;
    engine::ProbedColours(surface, [&](std::span<const Point> points) {
        return values_at(data, points, engine::PolynomialPoints::Beside::nearest);
    }).colour_from(0);
}

}  // namespace nestgrid
