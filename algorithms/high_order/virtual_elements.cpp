// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/virtual_elements.hpp>

#include <algorithm>
#include <cmath>

#include <nestgrid/algorithms/round_up.hpp>
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
      rule_{&data_->walk.rule()},
      dimension_{data_->walk.dimension()},
      corners_{std::size_t{1} << static_cast<unsigned>(dimension_)},
      components_{records_->components()},
      tolerance_{options.tolerance},
      flat_{options.tolerance / flat_share},
      depth_{options.depth},
      criterion_{*nodes_, options.tolerance},
      halved_{halved_parts(*rule_)} {
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
        const bool stops = node != nullptr && static_cast<double>(node->stop) <= tolerance_;
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
    if (places.states.size() < count) places.states.resize(max_box_corners);
    return places;
}

/// Sets the number of the leaf, where the hierarchy does not divide the element.
void VirtualElements::set_leaf(VirtualElement& e, const Member& member) const {
    if (member.rule == nullptr) {
        e.leaf = static_cast<std::uint32_t>(records_->leaf_at(e.state->path));
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
    state = {base.element, base.rule, {}, coarse_path(i), coarse.corners};
    std::vector<double> u(corners_);
    for (std::size_t k = 0; k < corners_; ++k) {
        state.key[k] = coarse_key(coarse.ids[k]);
        u[k] = nodes_->values(state.key[k])[0];
    }
    VirtualElement e;
    e.state = &state;
    set_leaf(e, base);
    describe(own, e, u.data(), family, 0);
}

/// Values at the corners of a coarse element.
NodeMask VirtualElements::coarse_values(Task* task, std::size_t i, std::span<double> out) const {
    auto& own = static_cast<OpenTask&>(*task);
    Coarse coarse;
    data_->base->coarse(own.base.get(), i, coarse, own.family);
    for (std::size_t k = 0; k < out.size() / components_; ++k) {
        const double* const values = nodes_->values(coarse_key(coarse.ids[k]));
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
    std::array<double, 27> u{};  // component 0 at the corners and new nodes
    const std::size_t nodes = rule_->new_nodes.size();
    if (values != nullptr) {
        new_values(task, e, which, values);
        for (std::size_t n = 0; n < corners_ + nodes; ++n) u[n] = values[n * components_];
    } else {
        which = 0;
        const double* const net = e.leaf == VirtualElement::no_leaf ? nullptr : net_of(own, e);
        for (std::size_t k = 0; k < corners_; ++k) {
            u[k] = net == nullptr
                       ? nodes_->values(e.state->key[k])[0]
                       : net[net_corner(records_->leaves()[e.leaf].degree, dimension_, k)];
        }
    }
    for (std::size_t n = 0; n < nodes; ++n) {
        if ((which >> n & 1U) == 0) u[corners_ + n] = interpolate(rule_->new_nodes[n], u.data(), 1);
    }
    family.begin(corners_);
    family.inner.resize(family.members.size());
    Places& places = VirtualElements::places(family, corners_);
    if (e.leaf == VirtualElement::no_leaf) {
        data_->base->enter(own.base.get(), e.state->base, *e.state->rule, 0, nullptr, wanted,
                           places.base);
    }
    const BoxSplitKeys keys = split_keys_of(e.state->key, *rule_);
    const std::array<Point, 27> x = positions(task, e, which);
    for (std::size_t c = 0; c < corners_; ++c) {
        if ((wanted >> c & 1U) == 0) continue;
        VirtualElement child;
        ElementState& state = places.states[c];
        child.state = &state;
        std::array<double, max_box_corners> at_corners;
        for (std::size_t k = 0; k < corners_; ++k) {
            state.key[k] = keys[rule_->children[c].corner[k]];
            at_corners[k] = u[rule_->children[c].corner[k]];
            state.x[k] = x[rule_->children[c].corner[k]];
        }
        set_child(e, c, places.base, child, state);
        describe(own, child, at_corners.data(), family, c);
    }
}

void VirtualElements::set_child(const VirtualElement& father, std::size_t child, const Family& base,
                                VirtualElement& e, ElementState& state) const {
    if (father.leaf == VirtualElement::no_leaf) {
        const Member& member = base.members[child];
        state.base = member.element;
        state.rule = member.rule;
        state.path = child_path(father.state->path, child);
        return set_leaf(e, member);
    }
    state.base = father.state->base;
    state.rule = nullptr;
    state.path = father.state->path;
    e.leaf = father.leaf;
    e.level = father.level + 1;
    for (std::size_t d = 0; d < 3; ++d) {
        e.place[d] = 2 * father.place[d] + static_cast<std::uint32_t>(child >> d & 1U);
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
    member.rule = rule_;
    const BoxSplitKeys keys = split_keys_of(e.state->key, *rule_);
    for (std::size_t n = 0; n < rule_->new_nodes.size(); ++n) {
        const RealNode* const node = nodes_->find(keys[corners_ + n]);
        if (node == nullptr) continue;
        const bool flat = node->hangs && (node->beta <= flat_ || node->shift >= depth_);
        member.constrained |= NodeMask{flat} << n;
    }
}

/// A leaf, or an element below one.
void VirtualElements::describe_leaf(OpenTask& task, const VirtualElement& e, const double* u,
                                    Member& member, InnerBounds& inner) const {
    if (linear_) return;  // values at corners say all
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    const double* const net = net_of(task, e);
    const Looked looked = look(e, net);
    const std::span<const double> corners(u, corners_);
    const double error = drawn_error(net, leaf, looked.facts.beta, corners);
    const double allowed = tolerance_ + static_cast<double>(leaf.jump);
    const bool exceeds = static_cast<double>(float_above(error)) > allowed;
    const bool flat = looked.flat == rule_->all();
    if (flat && (!exceeds || e.level >= depth_)) {
        inner.error = float_above(error);
        inner.limited = exceeds;
        return;
    }
    member.rule = rule_;
    member.constrained = looked.flat;
    member.outside = rule_->all();
    const auto [lo, hi] = std::minmax_element(corners.begin(), corners.end());
    inner.beyond = float_above(
        std::max({0.0, looked.facts.greatest - *hi, *lo - looked.facts.least}) + least_beyond_);
}

void VirtualElements::new_values(Task* task, const VirtualElement& e, NodeMask which,
                                 double* values) const {
    if (which == 0) return;
    double* const out = values + corners_ * components_;
    if (e.leaf == VirtualElement::no_leaf) {
        const BoxSplitKeys keys = split_keys_of(e.state->key, *rule_);
        for (std::size_t n = 0; n < rule_->new_nodes.size(); ++n) {
            if ((which >> n & 1U) == 0) continue;
            std::copy_n(nodes_->values(keys[corners_ + n]), components_, out + n * components_);
        }
        return;
    }
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    const double* const nets = nets_of_children(static_cast<OpenTask&>(*task), e);
    const std::size_t size = net_size(leaf.degree, dimension_);
    for (std::size_t n = 0; n < rule_->new_nodes.size(); ++n) {
        if ((which >> n & 1U) == 0) continue;
        const HalvedPart& part = halved_[n];
        BoxPlace at{};
        for (std::size_t d = 0; d < 3; ++d) {
            const unsigned in_middle = part.span >> d & 1U;
            at[d] = 2 * e.place[d] + 2 * part.at[d] + in_middle;
        }
        const PartCode around = part_around(0, at, e.level + 1, dimension_);
        if (around + 1 != part_count(dimension_)) {
            records_->values_at(leaf.part[around], at, e.level + 1, out + n * components_);
            continue;
        }
        const ChildCorner in = rule_->new_corner[n];
        const double* const net =
            nets + in.child * components_ * size + net_corner(leaf.degree, dimension_, in.corner);
        for (std::size_t c = 0; c < components_; ++c) out[n * components_ + c] = net[c * size];
    }
}

/// Positions at the corners and, behind them, at the new nodes.
/// \param which new nodes that have true ones
std::array<Point, 27> VirtualElements::positions(Task* task, const VirtualElement& e,
                                                 NodeMask which) const {
    std::array<Point, 27> x{};
    if (!data_->base->offers(Feature::new_positions)) return x;
    std::copy_n(e.state->x.begin(), corners_, x.begin());
    const std::size_t count = rule_->new_nodes.size();
    NodeMask given = 0;
    if (e.leaf == VirtualElement::no_leaf) {
        const BoxSplitKeys keys = split_keys_of(e.state->key, *rule_);
        for (std::size_t n = 0; n < count; ++n) {
            const RealNode* const node = nodes_->find(keys[corners_ + n]);
            const bool own = node != nullptr && !node->hangs;
            given |= NodeMask{own} << n;
        }
        given &= which;
        data_->base->new_positions(static_cast<OpenTask&>(*task).base.get(), e.state->base, given,
                                   std::span(x).subspan(corners_, count));
    }
    for (std::size_t n = 0; n < count; ++n) {
        if ((given >> n & 1U) == 0) x[corners_ + n] = interpolate(rule_->new_nodes[n], x.data());
    }
    return x;
}

void VirtualElements::new_positions(Task* task, const VirtualElement& e, NodeMask which,
                                    std::span<Point> out) const {
    const std::array<Point, 27> x = positions(task, e, which);
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(corners_), out.size(), out.begin());
}

/// Faces on the boundary of the domain, where the hierarchy tells those of its elements.
unsigned VirtualElements::boundary(Task* task, const VirtualElement& e) const {
    unsigned faces = 0;
    data_->base->corners(static_cast<OpenTask&>(*task).base.get(), e.state->base, corners_, nullptr,
                         nullptr, &faces);
    for (std::size_t d = 0; e.level > 0 && d < static_cast<std::size_t>(dimension_); ++d) {
        const std::uint32_t last = (std::uint32_t{1} << static_cast<unsigned>(e.level)) - 1;
        if (e.place[d] != 0) faces &= ~(1U << 2 * d);
        if (e.place[d] != last) faces &= ~(1U << (2 * d + 1));
    }
    return faces;
}

}  // namespace nestgrid::engine
