// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements below a leaf: their coefficients, what of them is flat, and how far they are from what
// is drawn.
#include <algorithm>
#include <cmath>

#include <high_order/virtual_elements.hpp>

namespace nestgrid::engine {

namespace {

std::size_t child_of(const VirtualElement& e) { return static_cast<std::size_t>(e.way & 15U); }

/// Facts of an edge or a face of an element that lies inside its leaf, from the coefficients of the
/// element.
NetFacts facts_on_part(const double* net, int degree, const ShapeParts& shape,
                       const ShapePart& part, std::span<const std::uint8_t> number) {
    std::array<std::uint8_t, 4> corner{};
    for (std::size_t i = 0; i < part.count; ++i) corner[i] = number[part.corner[i]];
    std::sort(corner.begin(), corner.begin() + part.count);
    std::array<Place, 3> frame{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Place& twice = shape.node[corner[i]];
        frame[i] = {twice[0] / 2, twice[1] / 2, twice[2] / 2};
    }
    NetRoom on_part;
    take_part(net, degree, shape.factors, std::span(frame).first(part.count == 2 ? 2 : 3),
              part.factors, on_part.data());
    return net_facts(on_part.data(), degree, part.factors);
}

/// Whether an element below a pyramid has its apex, so that the box around it is the element.
bool reaches_apex(const VirtualElement& e) {
    const auto& at = e.state->at;
    return std::any_of(at.begin(),
                       at.begin() + static_cast<std::ptrdiff_t>(e.state->shape->corners),
                       [&](const Place& x) { return x[2] == std::int64_t{1} << e.level; });
}

}  // namespace

/// Finds the flat parts of an element below a leaf, from the side of the leaf.
auto VirtualElements::look(const VirtualElement& e, const OwnNet& own) const -> Looked {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    const ShapeParts& in_leaf = leaf.parts();
    const ShapeParts& shape = *e.state->shape;
    Looked looked{0, true, net_facts(own.net, own.degree, own.factors)};
    const auto places = std::span<const Place>(e.state->at).first(shape.corners);
    const bool flat_inside = is_flat(looked.facts.beta, e.level,
                                     [&] { return lens_->is_fine(e.leaf, places, e.level); });
    const bool flat_parts = flat_inside && in_leaf.is_box;
    std::array<FaceMask, max_corners> faces;
    for (std::size_t k = 0; k < shape.corners; ++k) {
        faces[k] = in_leaf.faces_at(e.state->at[k], e.level);
    }
    if (flat_inside) looked.flat = shape.rule->all();
    // Faces come first: where one is flat, so are the edges that lie in the same part of the leaf,
    // of whose coefficients theirs are some.
    std::array<int, max_faces> part_around{};
    std::array<CornerMask, max_faces> flat_face{};
    std::size_t flat_faces = 0;
    for (std::size_t p = shape.parts.size(); p-- > 0;) {
        const ShapePart& part = shape.parts[p];
        std::array<Place, 4> corners;
        FaceMask around = ~FaceMask{0};
        for (std::size_t i = 0; i < part.count; ++i) {
            corners[i] = e.state->at[part.corner[i]];
            around &= faces[part.corner[i]];
        }
        const auto of_part = std::span<const Place>(corners).first(part.count);
        const auto is_fine = [&] { return lens_->is_fine(e.leaf, of_part, e.level); };
        const int number = in_leaf.part_in(around);
        bool flat = flat_parts && number < 0;
        for (std::size_t f = 0; f < flat_faces && part.count == 2; ++f) {
            flat |= part_around[f] == number && (part.corners & ~flat_face[f]) == 0;
        }
        if (!flat && number >= 0) {
            const OnRecord on =
                records_->on_part(leaf, static_cast<std::size_t>(number), of_part, e.level);
            const NetFacts facts = records_->facts_on(on);
            looked.facts.least = std::min(looked.facts.least, facts.least);
            looked.facts.greatest = std::max(looked.facts.greatest, facts.greatest);
            flat = is_flat(facts.beta, e.level + on.shift, [&] { return lens_->is_fine(on); });
        } else if (!flat && own.curvature != nullptr) {
            constexpr std::array shapes{Shape::segment, Shape::triangle, Shape::quadrilateral};
            flat = is_flat(own.curvature->beta(shapes[part.count - 2U], of_part, e.level), e.level,
                           is_fine);
        } else if (!flat) {
            flat = is_flat(facts_on_part(own.net, own.degree, shape, part, own.number).beta,
                           e.level, is_fine);
        }
        if (flat && part.count > 2) {
            part_around[flat_faces] = number;
            flat_face[flat_faces++] = part.corners;
        }
        looked.all_flat &= flat;
        if (part.node == no_new_node) continue;
        const NodeMask bit = NodeMask{1} << part.node;
        looked.flat = flat ? looked.flat | bit : looked.flat & ~bit;
    }
    // A node inside the element is private to it.
    if (shape.rule->inside != no_new_node) looked.all_flat &= flat_inside;
    return looked;
}

/// How far U may be from what is drawn between the corners: with A the affine function that fits
/// P_S U there best up to s, and r the greatest distance of U from it, r + s, because at a vertex,
/// where P_S U is what is drawn, A is within s of that, and so on triangles. Or what the element's
/// beta and the corners say.
/// \param u P_S U at the corners, in the order of the net
double VirtualElements::drawn_error(const VirtualElement& e, const OwnNet& own, double beta,
                                    std::span<const double> u) const {
    if (own.curvature != nullptr) return drawn_error_in_pyramid(e, own, beta, u);
    const AffineFit fit = fit_affine(u, own.factors);
    const double distance = distance_from_affine(own.net, own.degree, own.factors, fit);
    double off = 0;
    for (std::size_t k = 0; k < u.size(); ++k) {
        off = std::max(off, std::abs(own.net[net_corner(own.degree, own.factors, k)] - u[k]));
    }
    return std::min(distance + fit.residual, beta + off + 2 * fit.residual) + least_beyond_;
}

/// What drawn_error() is for a pyramid or a tetrahedron below a leaf that is a pyramid: U is known
/// by its coefficients in a box around the element.
/// \param beta of the box, which at the apex is the element
double VirtualElements::drawn_error_in_pyramid(const VirtualElement& e, const OwnNet& own,
                                               double beta, std::span<const double> u) const {
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
    const auto places = std::span<const Place>(e.state->at).first(shape.corners);
    const double distance =
        CollapsedBox(places, e.level).distance_from_affine(own.net, own.degree, x, affine);
    if (distance + residual + least_beyond_ <= tolerance_) {
        return distance + residual + least_beyond_;
    }
    double off = 0;
    for (std::size_t k = 0; k < u.size(); ++k) {
        off = std::max(off, std::abs(own_value(e, own, k) - u[k]));
    }
    if (!reaches_apex(e)) beta = own.curvature->beta(shape.shape, places, e.level);
    return std::min(distance + residual, beta + off + 2 * residual) + least_beyond_;
}

/// The polynomial of a leaf at a corner of an element below it.
double VirtualElements::own_value(const VirtualElement& e, const OwnNet& own,
                                  std::size_t corner) const {
    if (own.curvature == nullptr) {
        return own.net[net_corner(own.degree, own.factors, own.number[corner])];
    }
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    return net_value(records_->net(leaf), leaf.degree, leaf.factors(),
                     collapsed(point_at(e.state->at[corner], e.level)));
}

/// The coefficients of component 0 of an element below a leaf. Boxes are halved on the way down;
/// others are parts of the leaf, whose coefficients depend on their corners alone.
auto VirtualElements::net_of(OpenTask& task, const VirtualElement& e) const -> OwnNet {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    if (leaf.shape == Shape::pyramid) return net_in_pyramid(task, e);
    if (leaf.parts().is_box || e.level == 0) {
        return {box_net_of(task, e), leaf.degree, {0, 1, 2, 3, 4, 5, 6, 7}, leaf.factors()};
    }
    const NetPart part =
        part_at(leaf.factors(), std::span(e.state->at).first(e.state->shape->corners), e.level);
    restrict_net(records_->net(leaf), leaf.degree, leaf.factors(), part, task.net.data());
    return {task.net.data(), leaf.degree, part.number, part.factors};
}

auto VirtualElements::net_in_pyramid(OpenTask& task, const VirtualElement& e) const -> OwnNet {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    if (task.pyramid != e.leaf) {
        task.curvature = PyramidCurvature(records_->net(leaf), leaf.degree);
        task.pyramid = e.leaf;
    }
    const CollapsedBox around(std::span<const Place>(e.state->at).first(e.state->shape->corners),
                              e.level);
    around.restrict_net(records_->net(leaf), leaf.degree, task.net.data());
    return {task.net.data(), leaf.degree, {0, 1, 2, 3, 4}, leaf.factors(), &task.curvature};
}

const double* VirtualElements::box_net_of(OpenTask& task, const VirtualElement& e) const {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    if (e.level == 0) return records_->net(leaf);
    return nets_of_children(task, e.father()) + child_of(e) * net_size(leaf.degree, leaf.factors());
}

/// The coefficients of component 0 in all children of a box, one child behind the other.
const double* VirtualElements::nets_of_children(OpenTask& task, const VirtualElement& e) const {
    OpenTask::Halves& halves = task.halves[static_cast<std::size_t>(e.level)];
    if (halves.leaf == e.leaf && halves.way == e.way) return halves.nets.data();
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    const double* const own = box_net_of(task, e);
    halves.leaf = e.leaf;
    halves.way = e.way;
    halves.nets.resize(net_size(leaf.degree, leaf.factors()) << leaf.factors().count);
    halve_all(own, leaf.degree, leaf.factors().count, halves.nets.data());
    return halves.nets.data();
}

/// Values of all components at a new node of an element below a leaf.
void VirtualElements::leaf_values(OpenTask& task, const VirtualElement& e, std::size_t node,
                                  double* out) const {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    const ShapeParts& shape = *e.state->shape;
    const Stencil& stencil = shape.rule->new_nodes[node];
    Place at{};
    FaceMask faces = ~FaceMask{0};
    for (std::size_t i = 0; i < stencil.count; ++i) {
        const Place& parent = e.state->at[stencil.parent[i]];
        for (std::size_t d = 0; d < 3; ++d) at[d] += parent[d];
        faces &= leaf.parts().faces_at(parent, e.level);
    }
    for (std::int64_t& x : at) x = 2 * x / stencil.count;
    if (const int part = leaf.parts().part_in(faces); part >= 0) {
        records_->values_at(
            records_->on_part(leaf, static_cast<std::size_t>(part), std::span(&at, 1), e.level + 1),
            out);
        return;
    }
    std::size_t first = 0;
    if (leaf.shape == Shape::pyramid) {
        const Point inside = collapsed(point_at(at, e.level + 1));
        for (std::size_t c = 0; c < components_; ++c) {
            out[c] = net_value(records_->net(leaf, c), leaf.degree, leaf.factors(), inside);
        }
        return;
    }
    if (leaf.parts().is_box) {
        const ChildCorner in = shape.rule->new_corner[node];
        out[first++] =
            nets_of_children(task, e)[in.child * net_size(leaf.degree, leaf.factors()) +
                                      net_corner(leaf.degree, leaf.factors(), in.corner)];
    }
    const NetPart point = part_at(leaf.factors(), std::span(&at, 1), e.level + 1);
    for (std::size_t c = first; c < components_; ++c) {
        restrict_net(records_->net(leaf, c), leaf.degree, leaf.factors(), point, out + c);
    }
}

}  // namespace nestgrid::engine
