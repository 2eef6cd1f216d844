// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/virtual_elements.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

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

namespace {

/// Those of a drawing that looks at no polynomial.
const VirtualOptions no_leaf{.values = decltype(VirtualOptions::values)(std::in_place)};

/// \param name of the tolerance \param of what the extent is
void require_tolerance(double tolerance, const std::string& name, double extent,
                       const std::string& of) {
    if (!(tolerance > 0) || !std::isfinite(tolerance)) {
        throw InvalidInput("the " + name + " is not a positive number");
    }
    if (tolerance < 1e-12 * extent) {
        throw InvalidInput("the " + name + " is below 1e-12 of the " + of + ", which is " +
                           std::to_string(extent));
    }
}

}  // namespace

/// Positions within the tolerance that the options ask for; nothing where leaves are straight.
auto VirtualElements::places_within(const VirtualOptions& options) const -> std::optional<Drawn> {
    if (!data_->places) return std::nullopt;
    const double own = options.position_tolerance;
    return Drawn(*data_->places, *leaves_->places,
                 own == 0 ? data_->default_position_tolerance(options.tolerance) : own);
}

bool VirtualElements::is_linear(const HighOrderData& data) {
    const LeafSummary& all = data.field.summary;
    return all.greatest_degree == 1 && all.jump() <= 1e-12 * all.magnitude() && !data.places;
}

VirtualElements::VirtualElements(std::shared_ptr<const HighOrderData> data,
                                 const VirtualOptions& options)
    : data_{std::move(data)},
      linear_{is_linear(*data_)},
      leaves_{data_->gathered(linear_ ? no_leaf : options)},
      field_{data_->field, leaves_->field, options.tolerance,
             options.region ? options.region->threshold : options.tolerance},
      places_{places_within(options)},
      components_{field_.summary->components},
      depth_{options.depth},
      lens_{options.lens ? std::make_shared<const LensSizes>(*options.lens, data_->corners())
                         : nullptr},
      region_{options.region
                  ? std::make_shared<const RegionParts>(*options.region, data_->corners())
                  : nullptr},
      criterion_{field_, places_, lens_, region_} {
    require_tolerance(field_.tolerance, "tolerance", field_.summary->extent(), "range of the data");
    if (options.region) {
        require_tolerance(options.region->threshold, "tolerance in the region",
                          field_.summary->extent(), "range of the data");
    }
    if (places_) {
        require_tolerance(places_->tolerance, "tolerance of positions", places_->summary->extent(),
                          "diameter of the domain");
    }
    if (depth_ < 1 || depth_ > 16) {
        throw InvalidInput("the depth is " + std::to_string(depth_) + ", not 1 to 16");
    }
}

NodeMask VirtualElements::Stops::holds(const NewNodes& nodes) const {
    NodeMask mask = 0;
    for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
        const auto fine_enough = [&] {
            const auto size = static_cast<double>(field_.nodes->find(nodes.keys[n])->size);
            return lens_ == nullptr || lens_->may_stop(size, nodes.positions[n]);
        };
        const auto in_region = [&] {
            const auto size = static_cast<double>(field_.nodes->find(nodes.keys[n])->size);
            return region_ != nullptr && region_->may_have(size, nodes.positions[n]);
        };
        const bool stops = field_.stops(nodes.keys[n], false) &&
                           (!places_ || places_->stops(nodes.keys[n], false)) && fine_enough() &&
                           (field_.stops(nodes.keys[n], true) || !in_region());
        mask |= NodeMask{stops} << n;
    }
    return mask & ~nodes.outside;
}

std::unique_ptr<Task> VirtualElements::open() const {
    auto task = std::make_unique<OpenTask>();
    task->base = data_->base->open();
    const auto add_nets = [&](const Drawn& drawn, std::vector<ElementNets>& nets) {
        for (std::size_t c = 0; c < drawn.records->drawn(); ++c) {
            nets.emplace_back(*drawn.records, c, depth_);
        }
    };
    add_nets(field_, task->field);
    if (places_) add_nets(*places_, task->places);
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
    const std::uint32_t* const chosen = leaves_->choice.find(state.path);
    e.leaf = chosen == nullptr ? VirtualElement::left_out : *chosen;
    if (chosen == nullptr) e.way = static_cast<std::uint64_t>(state.path);
    for (std::size_t k = 0; k < state.shape->corners; ++k) {
        state.at[k] = state.shape->reference_corner(k);
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
    for (std::size_t k = 0; places_ && k < topology(coarse.shape).corners; ++k) {
        coarse.corners[k] = position(coarse_key(coarse.ids[k]));
    }
    state = {base.element,   base.rule, &parts_of(coarse.shape), {}, coarse_path(i),
             coarse.corners, {}};
    std::array<double, max_corners> u{};
    for (std::size_t k = 0; k < state.shape->corners; ++k) {
        state.key[k] = coarse_key(coarse.ids[k]);
        if (!linear_) u[k] = field_.nodes->values(state.key[k])[0];
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
        const double* const values = field_.nodes->values(own.key[k]);
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
    const Positions x = positions(task, e, values != nullptr ? which : rule.all());
    if (values != nullptr) {
        new_values(task, e, which, values);
        for (std::size_t n = 0; n < corners + nodes; ++n) u[n] = values[n * components_];
    } else {
        which = 0;
        const OwnNet net = divided ? OwnNet{} : own.field[0].of(e);
        for (std::size_t k = 0; k < corners; ++k) {
            u[k] = divided ? field_.nodes->values(father.key[k])[0]
                           : own.field[0].at_corner(e, net, k);
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
    state.at = child_places(*above.shape, above.at, above.shape->rule->children[child]);
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
        describe_split(e, member, inner);
    } else {
        describe_leaf(task, e, u, member, inner);
    }
    (member.rule == nullptr ? family.leaves : family.split) |= NodeMask{1} << number;
}

/// An element that the hierarchy itself divides.
void VirtualElements::describe_split(const VirtualElement& e, Member& member,
                                     InnerBounds& inner) const {
    member.rule = e.state->rule;
    const std::size_t corners = e.state->shape->corners;
    const RedSplitKeys keys = split_keys_of(e.state->key, *member.rule);
    for (std::size_t n = 0; n < member.rule->new_nodes.size(); ++n) {
        const NodeKey key = keys[corners + n];
        const bool flat = hangs_flat(field_, key) && (!places_ || hangs_flat(*places_, key));
        member.constrained |= NodeMask{flat} << n;
        const RealNode* const node = places_ ? places_->nodes->find(key) : nullptr;
        if (node == nullptr) continue;
        inner.position_error = std::max(inner.position_error, node->stop);
        inner.beyond_hull = std::max(inner.beyond_hull, node->bound);
    }
}

/// Whether a node of the hierarchy hangs on a part that is flat.
bool VirtualElements::hangs_flat(const Drawn& drawn, NodeKey key) const {
    const RealNode* const node = drawn.nodes->find(key);
    return node != nullptr && node->hangs &&
           is_flat(drawn, node->beta, node->shift, [&](const auto& asks) {
               return node->halves == 0 || asks(drawn.nodes->part_halved(*node));
           });
}

/// A leaf, or an element below one.
void VirtualElements::describe_leaf(OpenTask& task, const VirtualElement& e, const double* u,
                                    Member& member, InnerBounds& inner) const {
    if (e.leaf == VirtualElement::left_out) {
        if (linear_) return;                                   // values at corners say all
        inner.error = std::numeric_limits<float>::infinity();  // nobody is to draw it
        inner.limited = true;
        return;
    }
    const ShapeParts& shape = *e.state->shape;
    const std::span<const double> corners(u, shape.corners);
    const Looked looked = look(task, e, field_, corners);
    NodeMask flat = looked.flat;
    bool all_flat = looked.all_flat;
    bool exceeds = looked.exceeds;
    if (places_) {
        std::array<double, std::size_t{3} * max_corners> x;
        for (std::size_t i = 0; i < 3 * shape.corners; ++i) {
            x[i] = e.state->x[i % shape.corners][i / shape.corners];
        }
        const Looked at = look(task, e, *places_, std::span(x).first(3 * shape.corners));
        flat &= at.flat;
        all_flat &= at.all_flat;
        exceeds |= at.exceeds;
        inner.position_error = detail::float_above(at.error);
        inner.beyond_hull =
            detail::float_above(at.facts.beta + at.corner_error + places_->rounding +
                                static_cast<double>(places_->records->leaves()[e.leaf].jump));
    }
    if (all_flat && (!exceeds || e.level >= depth_)) {
        inner.error = detail::float_above(looked.error);
        inner.limited = exceeds;
        return;
    }
    member.rule = shape.rule;
    member.constrained = flat;
    member.outside = shape.rule->all();
    const auto [lo, hi] = std::minmax_element(corners.begin(), corners.end());
    inner.beyond = detail::float_above(
        std::max({0.0, looked.facts.greatest - *hi, *lo - looked.facts.least}) + field_.rounding);
}

/// Faces on the boundary of the domain, where the hierarchy tells those of its elements.
unsigned VirtualElements::boundary(Task* task, const VirtualElement& e) const {
    const ElementState& state = *e.state;
    unsigned faces = 0;
    const ShapeParts& around =
        e.level == 0 ? *state.shape : field_.records->leaves()[e.leaf].parts();
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
