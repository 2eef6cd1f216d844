// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements below a leaf: what of them is flat, how far they are from what is drawn, and values and
// positions at their new nodes.
#include <algorithm>
#include <cmath>

#include <high_order/virtual_elements.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

using nestgrid::detail::interpolate;

/// Looks at the field, or at positions, in an element below a leaf.
/// \param u what is drawn at the corners: all of component 0, then the next one
auto VirtualElements::look(OpenTask& task, const VirtualElement& e, const Drawn& drawn,
                           std::span<const double> u) const -> Looked {
    std::array<OwnNet, 3> nets;
    std::vector<ElementNets>& makers = task.nets_of(*drawn.records);
    for (std::size_t c = 0; c < makers.size(); ++c) nets[c] = makers[c].of(e);
    const auto own = std::span<const OwnNet>(nets).first(makers.size());
    Looked looked;
    looked.facts = joined_facts(own.size(), [&](std::size_t c) {
        const NetFacts facts = net_facts(own[c].net, own[c].degree, own[c].factors);
        looked.beta[c] = facts.beta;
        return facts;
    });
    look_at_parts(e, drawn, own, looked);
    look_at_error(task, e, drawn, own, u, looked);
    return looked;
}

/// Finds the flat parts of an element below a leaf, from the side of the leaf.
void VirtualElements::look_at_parts(const VirtualElement& e, const Drawn& drawn,
                                    std::span<const OwnNet> own, Looked& looked) const {
    const LeafRecords& records = *drawn.records;
    const LeafPolynomial& leaf = records.leaves()[e.leaf];
    const ShapeParts& in_leaf = leaf.parts();
    const ShapeParts& shape = *e.state->shape;
    const bool flat_inside = is_flat(drawn, looked.facts.beta, e.level, [&](const auto& asks) {
        return asks(leaf.number, e.places(), e.level);
    });
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
        const int number = in_leaf.part_in(around);
        bool flat = flat_parts && number < 0;
        for (std::size_t f = 0; f < flat_faces && part.count == 2; ++f) {
            flat |= part_around[f] == number && (part.corners & ~flat_face[f]) == 0;
        }
        if (!flat && number >= 0) {
            const OnRecord on =
                records.on_part(leaf, static_cast<std::size_t>(number), of_part, e.level);
            const NetFacts facts = records.facts_on(on);
            looked.facts.least = std::min(looked.facts.least, facts.least);
            looked.facts.greatest = std::max(looked.facts.greatest, facts.greatest);
            flat = is_flat(drawn, facts.beta, e.level + on.shift,
                           [&](const auto& asks) { return asks(records.in_owner(on)); });
        } else if (!flat) {
            const double beta = norm_of(own.size(), [&](std::size_t c) {
                return ElementNets::beta_on_part(e, own[c], part);
            });
            flat = is_flat(drawn, beta, e.level,
                           [&](const auto& asks) { return asks(leaf.number, of_part, e.level); });
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
}

/// Tells how far the leaf may be from what is drawn between the corners of an element below it.
void VirtualElements::look_at_error(OpenTask& task, const VirtualElement& e, const Drawn& drawn,
                                    std::span<const OwnNet> own, std::span<const double> u,
                                    Looked& looked) const {
    const std::size_t corners = e.state->shape->corners;
    const std::vector<ElementNets>& makers = task.nets_of(*drawn.records);
    const bool one = own.size() == 1;
    const bool near = region_ != nullptr && drawn.in_region < drawn.tolerance &&
                      region_->has(drawn.records->leaves()[e.leaf].number, e.places(), e.level);
    const double allowed = near ? drawn.in_region : drawn.tolerance;
    const double error = norm_of(own.size(), [&](std::size_t c) {
        return makers[c].drawn_error(e, own[c], looked.beta[c], u.subspan(c * corners, corners),
                                     one ? allowed - drawn.rounding : 0);
    });
    if (!one) {
        looked.corner_error = norm_of(own.size(), [&](std::size_t c) {
            return makers[c].corner_error(e, own[c], u.subspan(c * corners, corners));
        });
    }
    const auto jump = static_cast<double>(drawn.records->leaves()[e.leaf].jump);
    looked.error = error + drawn.rounding;
    looked.exceeds = static_cast<double>(detail::float_above(looked.error)) > allowed + jump;
}

/// Values of all components at a new node of an element below a leaf.
void VirtualElements::leaf_values(OpenTask& task, const VirtualElement& e, const Drawn& drawn,
                                  std::size_t node, double* out) const {
    const LeafRecords& records = *drawn.records;
    const LeafPolynomial& leaf = records.leaves()[e.leaf];
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
        records.values_at(
            records.on_part(leaf, static_cast<std::size_t>(part), std::span(&at, 1), e.level + 1),
            out);
        return;
    }
    const std::size_t components = records.components();
    if (leaf.shape == Shape::pyramid) {
        const Point inside = collapsed(point_at(at, e.level + 1));
        for (std::size_t c = 0; c < components; ++c) {
            out[c] = net_value(records.net(leaf, c), leaf.degree, leaf.factors(), inside);
        }
        return;
    }
    std::size_t first = 0;
    if (leaf.parts().is_box) {
        // Those that are drawn are known from the halves.
        const ChildCorner in = shape.rule->new_corner[node];
        const std::size_t number = in.child * net_size(leaf.degree, leaf.factors()) +
                                   net_corner(leaf.degree, leaf.factors(), in.corner);
        for (ElementNets& nets : task.nets_of(records)) out[first++] = nets.of_children(e)[number];
    }
    const NetPart point = part_at(leaf.factors(), std::span(&at, 1), e.level + 1);
    for (std::size_t c = first; c < components; ++c) {
        restrict_net(records.net(leaf, c), leaf.degree, leaf.factors(), point, out + c);
    }
}

void VirtualElements::new_values(Task* task, const VirtualElement& e, NodeMask which,
                                 double* values) const {
    if (which == 0) return;
    const bool divided = e.leaf == VirtualElement::no_leaf;
    const Rule& rule = divided ? *e.state->rule : *e.state->shape->rule;
    double* const out = values + e.state->shape->corners * components_;
    const RedSplitKeys keys = divided ? split_keys_of(e.state->key, rule) : RedSplitKeys{};
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        if ((which >> n & 1U) == 0) continue;
        if (divided) {
            std::copy_n(field_.nodes->values(keys[e.state->shape->corners + n]), components_,
                        out + n * components_);
        } else {
            leaf_values(static_cast<OpenTask&>(*task), e, field_, n, out + n * components_);
        }
    }
}

/// Positions at the corners and, behind them, at the new nodes.
/// \param which new nodes that have true ones
auto VirtualElements::positions(Task* task, const VirtualElement& e, NodeMask which) const
    -> Positions {
    Positions x{};
    const ElementState& state = *e.state;
    if (places_) {
        put_places(static_cast<OpenTask&>(*task), e, which, x);
        return x;
    }
    if (!data_->base->offers(Feature::new_positions)) return x;
    const bool divided = e.leaf == VirtualElement::no_leaf;
    const Rule& rule = divided ? *state.rule : *state.shape->rule;
    const std::size_t corners = state.shape->corners;
    std::copy_n(state.x.begin(), corners, x.begin());
    NodeMask given = 0;
    if (divided) {
        const RedSplitKeys keys = split_keys_of(state.key, rule);
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const RealNode* const node = field_.nodes->find(keys[corners + n]);
            const bool own = node != nullptr && !node->hangs;
            given |= NodeMask{own} << n;
        }
        given &= which;
        data_->base->new_positions(static_cast<OpenTask&>(*task).base.get(), state.base, given,
                                   std::span(x).subspan(corners, rule.new_nodes.size()));
    }
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        if ((given >> n & 1U) == 0) x[corners + n] = interpolate(rule.new_nodes[n], x.data());
    }
    return x;
}

/// The position of a node of the hierarchy, where leaves are curved.
Point VirtualElements::position(NodeKey key) const {
    const double* const x = places_->nodes->values(key);
    return {x[0], x[1], x[2]};
}

/// The same as positions(), where leaves are curved.
void VirtualElements::put_places(OpenTask& task, const VirtualElement& e, NodeMask which,
                                 Positions& x) const {
    const ElementState& state = *e.state;
    const bool divided = e.leaf == VirtualElement::no_leaf;
    const Rule& rule = divided ? *state.rule : *state.shape->rule;
    const std::size_t corners = state.shape->corners;
    std::copy_n(state.x.begin(), corners, x.begin());
    const RedSplitKeys keys = divided ? split_keys_of(state.key, rule) : RedSplitKeys{};
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        Point& made = x[corners + n];
        if ((which >> n & 1U) == 0) {
            made = interpolate(rule.new_nodes[n], x.data());
        } else if (divided) {
            made = position(keys[corners + n]);
        } else {
            leaf_values(task, e, *places_, n, made.data());
        }
    }
}

void VirtualElements::new_positions(Task* task, const VirtualElement& e, NodeMask which,
                                    std::span<Point> out) const {
    const Positions x = positions(task, e, which);
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(e.state->shape->corners), out.size(),
                out.begin());
}

}  // namespace nestgrid::engine
