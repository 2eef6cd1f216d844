// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/element_nets.hpp>

#include <algorithm>
#include <cmath>

namespace nestgrid::engine {

namespace {

std::size_t child_of(const VirtualElement& e) { return static_cast<std::size_t>(e.way & 15U); }

/// Whether an element below a pyramid has its apex, so that the box around it is the element.
bool reaches_apex(const VirtualElement& e) {
    const auto at = e.places();
    return std::any_of(at.begin(), at.end(),
                       [&](const Place& x) { return x[2] == std::int64_t{1} << e.level; });
}

}  // namespace

std::array<Place, max_corners> child_places(const ShapeParts& shape,
                                            const std::array<Place, max_corners>& at,
                                            const Child& child) {
    std::array<Place, max_corners> places{};
    for (std::size_t k = 0; k < topology(child.shape).corners; ++k) {
        const std::size_t node = child.corner[k];
        if (node < shape.corners) {
            for (std::size_t d = 0; d < 3; ++d) places[k][d] = 2 * at[node][d];
            continue;
        }
        const Stencil& stencil = shape.rule->new_nodes[node - shape.corners];
        for (std::size_t d = 0; d < 3; ++d) {
            std::int64_t sum = 0;
            for (std::size_t i = 0; i < stencil.count; ++i) sum += at[stencil.parent[i]][d];
            places[k][d] = 2 * sum / stencil.count;
        }
    }
    return places;
}

OwnNet ElementNets::of(const VirtualElement& e) {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    if (leaf.shape == Shape::pyramid) return in_pyramid(e, leaf);
    if (leaf.parts().is_box || e.level == 0) {
        return {of_box(e), leaf.degree, {0, 1, 2, 3, 4, 5, 6, 7}, leaf.factors()};
    }
    const NetPart part = part_at(leaf.factors(), e.places(), e.level);
    restrict_net(records_->net(leaf, component_), leaf.degree, leaf.factors(), part, net_.data());
    return {net_.data(), leaf.degree, part.number, part.factors};
}

OwnNet ElementNets::in_pyramid(const VirtualElement& e, const LeafPolynomial& leaf) {
    const double* const net = records_->net(leaf, component_);
    if (pyramid_ != e.leaf) {
        curvature_ = PyramidCurvature(net, leaf.degree);
        pyramid_ = e.leaf;
    }
    CollapsedBox(e.places(), e.level).restrict_net(net, leaf.degree, net_.data());
    return {net_.data(), leaf.degree, {0, 1, 2, 3, 4}, leaf.factors(), &curvature_};
}

const double* ElementNets::of_box(const VirtualElement& e) {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    if (e.level == 0) return records_->net(leaf, component_);
    return of_children(e.father()) + child_of(e) * net_size(leaf.degree, leaf.factors());
}

const double* ElementNets::of_children(const VirtualElement& e) {
    Halves& halves = halves_[static_cast<std::size_t>(e.level)];
    if (halves.leaf == e.leaf && halves.way == e.way) return halves.nets.data();
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    const double* const own = of_box(e);
    halves.leaf = e.leaf;
    halves.way = e.way;
    halves.nets.resize(net_size(leaf.degree, leaf.factors()) << leaf.factors().count);
    halve_all(own, leaf.degree, leaf.factors().count, halves.nets.data());
    return halves.nets.data();
}

double ElementNets::at_corner(const VirtualElement& e, const OwnNet& own,
                              std::size_t corner) const {
    if (own.curvature == nullptr) {
        return own.net[net_corner(own.degree, own.factors, own.number[corner])];
    }
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    return net_value(records_->net(leaf, component_), leaf.degree, leaf.factors(),
                     collapsed(point_at(e.state->at[corner], e.level)));
}

double ElementNets::beta_on_part(const VirtualElement& e, const OwnNet& own,
                                 const ShapePart& part) {
    if (own.curvature != nullptr) {
        constexpr std::array shapes{Shape::segment, Shape::triangle, Shape::quadrilateral};
        std::array<Place, 4> corners;
        for (std::size_t i = 0; i < part.count; ++i) corners[i] = e.state->at[part.corner[i]];
        return own.curvature->beta(shapes[part.count - 2U], std::span(corners).first(part.count),
                                   e.level);
    }
    const ShapeParts& shape = *e.state->shape;
    std::array<std::uint8_t, 4> corner{};
    for (std::size_t i = 0; i < part.count; ++i) corner[i] = own.number[part.corner[i]];
    std::sort(corner.begin(), corner.begin() + part.count);
    std::array<Place, 3> frame{};
    for (std::size_t i = 0; i < 3; ++i) frame[i] = shape.reference_corner(corner[i]);
    NetRoom on_part;
    take_part(own.net, own.degree, shape.factors, std::span(frame).first(frame_size(part)),
              part.factors, on_part.data());
    return net_facts(on_part.data(), own.degree, part.factors).beta;
}

double ElementNets::corner_error(const VirtualElement& e, const OwnNet& own,
                                 std::span<const double> u) const {
    double off = 0;
    for (std::size_t k = 0; k < u.size(); ++k) {
        off = std::max(off, std::abs(at_corner(e, own, k) - u[k]));
    }
    return off;
}

/// What drawn_error() is for a pyramid or a tetrahedron below a leaf that is a
/// pyramid: U is known by its coefficients in a box around the element.
double ElementNets::drawn_error_in_pyramid(const VirtualElement& e, const OwnNet& own, double beta,
                                           std::span<const double> u, double enough) const {
    const ShapeParts& shape = *e.state->shape;
    const bool pyramid = shape.shape == Shape::pyramid;
    const double residual = pyramid ? pyramid_residual(u) : 0;
    std::array<Point, 4> x{};
    std::array<double, 4> affine{};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t corner = i == 0 ? 0 : shape.axis[i - 1];
        x[i] = point_at(e.state->at[corner], e.level);
        // The corners of the base are off to one side and the other in turn.
        const double twist = pyramid ? (u[0] - u[1] - u[2] + u[3]) / 4 : 0;
        affine[i] = u[corner] - (corner == 4 ? 0 : corner == 0 ? twist : -twist);
    }
    const double distance =
        CollapsedBox(e.places(), e.level).distance_from_affine(own.net, own.degree, x, affine);
    if (distance + residual <= enough) return distance + residual;
    if (!reaches_apex(e)) beta = own.curvature->beta(shape.shape, e.places(), e.level);
    return std::min(distance + residual, beta + corner_error(e, own, u) + 2 * residual);
}

/// With A the affine function that fits what is drawn at the corners best up to s, and r the
/// greatest distance of the polynomial from it, r + s, because at a vertex A is within s of what is
/// drawn, and so on triangles. Or what the element's beta and the corners say.
double ElementNets::drawn_error(const VirtualElement& e, const OwnNet& own, double beta,
                                std::span<const double> u, double enough) const {
    if (own.curvature != nullptr) return drawn_error_in_pyramid(e, own, beta, u, enough);
    std::array<double, max_corners> sorted{};
    for (std::size_t k = 0; k < u.size(); ++k) sorted[own.number[k]] = u[k];
    const AffineFit fit = fit_affine(std::span<const double>(sorted).first(u.size()), own.factors);
    const double distance = distance_from_affine(own.net, own.degree, own.factors, fit);
    return std::min(distance + fit.residual, beta + corner_error(e, own, u) + 2 * fit.residual);
}

}  // namespace nestgrid::engine
