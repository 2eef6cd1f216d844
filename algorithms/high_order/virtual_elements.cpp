// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/virtual_elements.hpp>

#include <algorithm>
#include <cmath>

#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

using nestgrid::detail::interpolate;

/// Where the elements of a family lie, and the family of the hierarchy that they were made of.
struct VirtualElements::Places {
    std::vector<ElementState> states;
    Family base;
};

VirtualElements::VirtualElements(std::shared_ptr<const HighOrderData> data,
                                 const VirtualOptions& options)
    : data_{std::move(data)},
      records_{&data_->records},
      nodes_{&data_->nodes},
      components_{records_->components()},
      tolerance_{options.tolerance},
      flat_{options.tolerance / flat_share},
      depth_{options.depth},
      lens_{options.lens
                ? std::make_shared<const LensSizes>(*options.lens, *records_, data_->corners())
                : nullptr},
      criterion_{*nodes_, options.tolerance, lens_} {
    const double size = std::max(std::abs(records_->least()), std::abs(records_->greatest()));
    least_beyond_ = 1e-14 * size;
    linear_ = records_->greatest_degree() == 1 && records_->jump() <= 1e-12 * size;
    const double least = 1e-12 * (records_->greatest() - records_->least());
    if (!(tolerance_ > 0) || !std::isfinite(tolerance_)) {
        throw InvalidInput("the tolerance is not a positive number");
    }
    if (tolerance_ < least) {
        throw InvalidInput("the tolerance is below 1e-12 of the range of the data, which is " +
                           std::to_string(records_->greatest() - records_->least()));
    }
    if (depth_ < 1 || depth_ > 16) {
        throw InvalidInput("the depth is " + std::to_string(depth_) + ", not 1 to 16");
    }
}

NodeMask VirtualElements::Stops::holds(const NewNodes& nodes) const {
    NodeMask mask = 0;
    for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
        const RealNode* const node = nodes_->find(nodes.keys[n]);
        const bool stops = node != nullptr && static_cast<double>(node->stop) <= tolerance_ &&
                           (lens_ == nullptr ||
                            lens_->may_stop(static_cast<double>(node->size), nodes.positions[n]));
        mask |= NodeMask{stops} << n;
    }
    return mask & ~nodes.outside;
}

std::unique_ptr<Task> VirtualElements::open() const {
    auto task = std::make_unique<OpenTask>();
    task->base = data_->base->open();
    task->halves.resize(static_cast<std::size_t>(depth_) + 1);
    return task;
}

auto VirtualElements::places(Family& family, std::size_t count) -> Places& {
    if (!family.elements) family.elements = std::make_shared<Places>();
    auto& places = *static_cast<Places*>(family.elements.get());
    if (places.states.size() < count) places.states.resize(count);
    return places;
}

/// Sets the number of the leaf, where the hierarchy does not divide the element.
void VirtualElements::set_leaf(VirtualElement& e, const Member& member, ElementState& state) const {
    if (member.rule != nullptr) return;
    e.leaf = static_cast<std::uint32_t>(records_->leaf_at(state.path));
    for (std::size_t k = 0; k < state.shape->corners; ++k) {
        for (std::size_t d = 0; d < 3; ++d) state.at[k][d] = state.shape->node[k][d] / 2;
    }
}

void VirtualElements::coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const {
    auto& own = static_cast<OpenTask&>(*task);
    family.begin(1);
    family.inner.resize(family.members.size());
    Places& places = VirtualElements::places(family, 1);
    data_->base->coarse(own.base.get(), i, coarse, places.base);
    const Member& base = places.base.members[0];
    ElementState& state = places.states[0];
    state = {base.element,   base.rule, &parts_of(coarse.shape), {}, coarse_path(i),
             coarse.corners, {}};
    std::array<double, max_corners> u{};
    for (std::size_t k = 0; k < state.shape->corners; ++k) {
        state.key[k] = coarse_key(coarse.ids[k]);
        if (!linear_) u[k] = nodes_->values(state.key[k])[0];
    }
    own.coarse = i;
    own.key = state.key;
    VirtualElement e;
    e.state = &state;
    set_leaf(e, base, state);
    describe(own, e, u.data(), family, 0);
}

/// Values at the corners of a coarse element, which as a rule was asked for just before.
NodeMask VirtualElements::coarse_values(Task* task, std::size_t i, std::span<double> out) const {
    auto& own = static_cast<OpenTask&>(*task);
    if (own.coarse != i) {
        Coarse coarse;
        data_->base->coarse(own.base.get(), i, coarse, own.family);
        own.coarse = i;
        std::transform(coarse.ids.begin(), coarse.ids.end(), own.key.begin(), coarse_key);
    }
    for (std::size_t k = 0; k < out.size() / components_; ++k) {
        const double* const values = nodes_->values(own.key[k]);
        std::copy_n(values, components_,
                    out.begin() + static_cast<std::ptrdiff_t>(k * components_));
    }
    return 0;
}

/// Children whose corner values are those that the walk will see: hanging nodes and those at which
/// a criterion holds are interpolated here, too.
void VirtualElements::enter(Task* task, const VirtualElement& e, NodeMask which, double* values,
                            NodeMask wanted, Family& family) const {
    auto& own = static_cast<OpenTask&>(*task);
    const ElementState& father = *e.state;
    const bool divided = e.leaf == VirtualElement::no_leaf;
    const Rule& rule = divided ? *father.rule : *father.shape->rule;
    const std::size_t corners = father.shape->corners;
    const std::size_t nodes = rule.new_nodes.size();
    std::array<double, max_split_nodes> u{};  // component 0 at the corners and new nodes
    if (values != nullptr) {
        new_values(task, e, which, values);
        for (std::size_t n = 0; n < corners + nodes; ++n) u[n] = values[n * components_];
    } else {
        which = 0;
        const OwnNet net = divided ? OwnNet{} : net_of(own, e);
        for (std::size_t k = 0; k < corners; ++k) {
            u[k] = divided ? nodes_->values(father.key[k])[0] : own_value(e, net, k);
        }
    }
    for (std::size_t n = 0; n < nodes; ++n) {
        if ((which >> n & 1U) == 0) u[corners + n] = interpolate(rule.new_nodes[n], u.data(), 1);
    }
    family.begin(rule.children.size());
    family.inner.resize(family.members.size());
    Places& places = VirtualElements::places(family, rule.children.size());
    if (divided) {
        data_->base->enter(own.base.get(), father.base, rule, 0, nullptr, wanted, places.base);
    }
    const RedSplitKeys keys = split_keys_of(father.key, rule);
    const Positions x = positions(task, e, which);
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        if ((wanted >> c & 1U) == 0) continue;
        const Child& made = rule.children[c];
        VirtualElement child;
        ElementState& state = places.states[c];
        child.state = &state;
        state.shape = &parts_of(made.shape);
        std::array<double, max_corners> at_corners{};
        for (std::size_t k = 0; k < state.shape->corners; ++k) {
            state.key[k] = keys[made.corner[k]];
            at_corners[k] = u[made.corner[k]];
            state.x[k] = x[made.corner[k]];
        }
        set_child(e, c, places.base, child, state);
        describe(own, child, at_corners.data(), family, c);
    }
}

void VirtualElements::set_child(const VirtualElement& father, std::size_t child, const Family& base,
                                VirtualElement& e, ElementState& state) const {
    const ElementState& above = *father.state;
    if (father.leaf == VirtualElement::no_leaf) {
        const Member& member = base.members[child];
        state.base = member.element;
        state.rule = member.rule;
        state.path = child_path(above.path, child);
        return set_leaf(e, member, state);
    }
    state.base = above.base;
    state.rule = nullptr;
    state.path = above.path;
    e.leaf = father.leaf;
    e.level = father.level + 1;
    e.way = father.way << 4U | child;
    const Rule& rule = *above.shape->rule;
    for (std::size_t k = 0; k < state.shape->corners; ++k) {
        const std::size_t node = rule.children[child].corner[k];
        if (node < above.shape->corners) {
            for (std::size_t d = 0; d < 3; ++d) state.at[k][d] = 2 * above.at[node][d];
            continue;
        }
        const Stencil& stencil = rule.new_nodes[node - above.shape->corners];
        for (std::size_t d = 0; d < 3; ++d) {
            std::int64_t sum = 0;
            for (std::size_t i = 0; i < stencil.count; ++i) sum += above.at[stencil.parent[i]][d];
            state.at[k][d] = 2 * sum / stencil.count;
        }
    }
}

/// Sets a member of a family to an element.
/// \param u component 0 of P_S U at its corners
void VirtualElements::describe(OpenTask& task, const VirtualElement& e, const double* u,
                               Family& family, std::size_t number) const {
    Member& member = family.members[number];
    nestgrid::detail::set_handle(member.element, e);
    member.rule = nullptr;
    member.constrained = member.outside = 0;
    InnerBounds& inner = family.inner[number];
    inner = {};
    if (e.leaf == VirtualElement::no_leaf) {
        describe_split(e, member);
    } else {
        describe_leaf(task, e, u, member, inner);
    }
    (member.rule == nullptr ? family.leaves : family.split) |= NodeMask{1} << number;
}

/// An element that the hierarchy itself divides.
void VirtualElements::describe_split(const VirtualElement& e, Member& member) const {
    member.rule = e.state->rule;
    const std::size_t corners = e.state->shape->corners;
    const RedSplitKeys keys = split_keys_of(e.state->key, *member.rule);
    for (std::size_t n = 0; n < member.rule->new_nodes.size(); ++n) {
        const RealNode* const node = nodes_->find(keys[corners + n]);
        if (node == nullptr) continue;
        const bool flat =
            node->hangs && is_flat(node->beta, node->shift, [&] {
                return node->halves == 0 || lens_->is_fine(nodes_->part_halved(*node));
            });
        member.constrained |= NodeMask{flat} << n;
    }
}

/// A leaf, or an element below one.
void VirtualElements::describe_leaf(OpenTask& task, const VirtualElement& e, const double* u,
                                    Member& member, InnerBounds& inner) const {
    if (linear_) return;  // values at corners say all
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    const ShapeParts& shape = *e.state->shape;
    const OwnNet own = net_of(task, e);
    const Looked looked = look(e, own);
    std::array<double, max_corners> sorted{};
    for (std::size_t k = 0; k < shape.corners; ++k) sorted[own.number[k]] = u[k];
    const auto corners = std::span<const double>(sorted).first(shape.corners);
    const double error = drawn_error(e, own, looked.facts.beta, corners);
    const double allowed = tolerance_ + static_cast<double>(leaf.jump);
    const bool exceeds = static_cast<double>(detail::float_above(error)) > allowed;
    if (looked.all_flat && (!exceeds || e.level >= depth_)) {
        inner.error = detail::float_above(error);
        inner.limited = exceeds;
        return;
    }
    member.rule = shape.rule;
    member.constrained = looked.flat;
    member.outside = shape.rule->all();
    const auto [lo, hi] = std::minmax_element(corners.begin(), corners.end());
    inner.beyond = detail::float_above(
        std::max({0.0, looked.facts.greatest - *hi, *lo - looked.facts.least}) + least_beyond_);
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
            std::copy_n(nodes_->values(keys[e.state->shape->corners + n]), components_,
                        out + n * components_);
        } else {
            leaf_values(static_cast<OpenTask&>(*task), e, n, out + n * components_);
        }
    }
}

/// Positions at the corners and, behind them, at the new nodes.
/// \param which new nodes that have true ones
auto VirtualElements::positions(Task* task, const VirtualElement& e, NodeMask which) const
    -> Positions {
    Positions x{};
    if (!data_->base->offers(Feature::new_positions)) return x;
    const ElementState& state = *e.state;
    const bool divided = e.leaf == VirtualElement::no_leaf;
    const Rule& rule = divided ? *state.rule : *state.shape->rule;
    const std::size_t corners = state.shape->corners;
    std::copy_n(state.x.begin(), corners, x.begin());
    NodeMask given = 0;
    if (divided) {
        const RedSplitKeys keys = split_keys_of(state.key, rule);
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const RealNode* const node = nodes_->find(keys[corners + n]);
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

void VirtualElements::new_positions(Task* task, const VirtualElement& e, NodeMask which,
                                    std::span<Point> out) const {
    const Positions x = positions(task, e, which);
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(e.state->shape->corners), out.size(),
                out.begin());
}

/// Faces on the boundary of the domain, where the hierarchy tells those of its elements.
unsigned VirtualElements::boundary(Task* task, const VirtualElement& e) const {
    const ElementState& state = *e.state;
    unsigned faces = 0;
    const ShapeParts& around =
        e.leaf == VirtualElement::no_leaf ? *state.shape : records_->leaves()[e.leaf].parts();
    data_->base->corners(static_cast<OpenTask&>(*task).base.get(), state.base, around.corners,
                         nullptr, nullptr, &faces);
    if (e.level == 0) return faces;
    const Topology& t = topology(state.shape->shape);
    unsigned own = 0;
    for (std::size_t f = 0; f < t.faces; ++f) {
        FaceMask in_leaf = ~FaceMask{0};
        for (std::size_t i = 0; i < t.face[f].corners; ++i) {
            in_leaf &= around.faces_at(state.at[t.face[f].corner[i]], e.level);
        }
        own |= unsigned{(in_leaf & faces) != 0} << f;
    }
    return own;
}

}  // namespace nestgrid::engine
