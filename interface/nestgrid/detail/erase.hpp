// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Makes a Hierarchy of a model of NestedGrid and NodalField. This is what an algorithm costs the
// compiler for each pair of grid and field.
#pragma once

#include <algorithm>
#include <memory>

#include <nestgrid/detail/constants.hpp>
#include <nestgrid/detail/inlining.hpp>
#include <nestgrid/detail/made_for.hpp>
#include <nestgrid/detail/operations.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid {

/// A field that is zero, for algorithms that look at the grid alone.
template <class Grid>
struct ZeroField {
    using value_type = float;
    NodeMask coarse_values(std::size_t, std::span<float> out) const {
        std::fill(out.begin(), out.end(), 0.0F);
        return 0;
    }
    NodeMask new_values(const ElementOf<Grid>&, NodeMask, std::span<float> out) const {
        std::fill(out.begin(), out.end(), 0.0F);
        return 0;
    }
};

namespace detail {

template <class Grid>
HierarchyFacts facts_of_grid(const Grid& grid) {
    HierarchyFacts facts;
    facts.dimension = Grid::dimension;
    for (unsigned bit = 1; bit <= static_cast<unsigned>(last_feature); bit <<= 1U) {
        const auto feature = static_cast<Feature>(bit);
        if (may_offer<Grid>(feature) && offers(grid, feature)) facts.features |= bit;
    }
    facts.node_count = dense_key_count(grid);
    NoContext none;
    facts.conforming = call_conforming(grid, none);
    if constexpr (requires { grid.whole(); }) facts.fills_rows = grid.whole();
    facts.only_shape = only_shape<Grid>();
    if constexpr (requires { grid.shared_nodes(); }) facts.shared = grid.shared_nodes();
    return facts;
}

/// Which members of a family are what, one bit each: in registers while a family is described.
struct MemberMasks {
    NodeMask split = 0;
    NodeMask leaves = 0;
    NodeMask hidden = 0;
};

/// Sets member c of a family to an element, with its rule, masks and keys of new nodes.
/// \param masks to which the bits of the member are added
template <class Grid, class AnyContext>
NESTGRID_INLINE void describe_member(const Grid& grid, const HierarchyFacts& facts,
                                     AnyContext& context, const ElementOf<Grid>& e, Family& family,
                                     std::size_t c, MemberMasks& masks) {
    Member& member = family.members[c];
    set_handle(member.element, e);
    // Known when this is compiled where the grid cannot have the feature.
    const auto has = [&](Feature feature) NESTGRID_INLINE_LAMBDA {
        return may_offer<Grid>(feature) && facts.offers(feature);
    };
    if (has(Feature::presence)) {
        member.presence = call_presence(grid, context, e);
        if (member.presence == Presence::elsewhere) return;
    }
    if (has(Feature::masked) && call_masked(grid, context, e)) return;
    const NodeMask bit = NodeMask{1} << c;
    if (has(Feature::hidden)) {
        member.hidden = call_hidden(grid, context, e);
        if (member.hidden == Hidden::wholly) masks.hidden |= bit;
    }
    member.rule = call_split(grid, context, e);
    if (member.rule == nullptr) {
        masks.leaves |= bit;
        return;
    }
    masks.split |= bit;
    if (has(Feature::own_keys)) {
        member.first_key = static_cast<std::uint32_t>(family.key_count);
        // A grid that gives the keys of another rule writes no farther than the spare room, and
        // check_grid can name the mistake.
        const std::size_t count = member.rule->new_nodes.size();
        call_new_keys(grid, context, e, family.add_keys(count, max_new_nodes));
    }
    if (has(Feature::constrained)) member.constrained = call_constrained(grid, context, e);
    if (has(Feature::outside)) member.outside = call_outside(grid, context, e);
}

/// Describes the only member of a family, or one that is described by itself.
template <class Grid, class AnyContext>
void describe_member(const Grid& grid, const HierarchyFacts& facts, AnyContext& context,
                     const ElementOf<Grid>& e, Family& family, std::size_t c) {
    MemberMasks masks;
    describe_member(grid, facts, context, e, family, c, masks);
    family.split |= masks.split;
    family.leaves |= masks.leaves;
    family.hidden |= masks.hidden;
}

/// A field that gives the gradient of the data at any node, of a grid with known bisections.
template <class Field, class Grid>
concept GivesGradientsAtNodes = requires(const Field& field, typename Grid::Node node) {
    field.gradient_at(node);
};

/// The same of a grid whose keys tell the places of nodes.
template <class Field, class Grid>
concept GivesGradientsByKey = requires(const Field& field, const Grid& grid, NodeKey node) {
    field.gradient_at(grid.place(node));
};

template <class Grid, class Field>
class ErasedHierarchy final : public Hierarchy<typename Field::value_type> {
    static_assert(require_nested_grid<Grid>());
    static_assert(require_nodal_field<Field, Grid>());
    static_assert(require_fitting_operations<Grid, Field>());

public:
    using Real = typename Field::value_type;
    using Element = ElementOf<Grid>;

    ErasedHierarchy(const Grid& grid, const Field& field)
        : Hierarchy<Real>(facts_of(grid, field)), grid_{&grid}, field_{&field}, made_for_{grid} {}

    std::size_t coarse_count() const override { return grid_->coarse_count(); }
    std::uint64_t epoch() const override { return nestgrid::epoch(*grid_); }
    Elements make_elements() const override { return Elements::of<Element>(); }

    std::unique_ptr<Task> open() const override {
        made_for_.require_same(*grid_, "the hierarchy");
        if constexpr (has_context_) return std::make_unique<OpenTask>(*grid_);
        return nullptr;
    }

    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        with(task, [&](auto& context) {
            const CoarseElement<Element> from = call_coarse(*grid_, context, i);
            coarse.shape = from.shape;
            coarse.orientation = from.orientation;
            coarse.corners = from.corners;
            coarse.ids = from.ids;
            family.begin(1);
            const std::span<Element> kept = places(family, 1);
            if (!kept.empty()) kept[0] = from.element;
            describe_member(*grid_, this->facts_, context, kept.empty() ? from.element : kept[0],
                            family, 0);
        });
    }

    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           Real* out) const override {
        return with(task, [&](auto& context) {
            return call_coarse_values(*field_, context, i,
                                      std::span<Real>(out, corners * components_));
        });
    }

    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& family) const override {
        return with(task, [&](auto& context) {
            const auto& e = element_of<Element>(element);
            NodeMask missing = 0;
            if (which != 0) missing = ask(context, e, rule, which, values);
            const std::size_t count = rule.children.size();
            constexpr std::size_t most = child_capacity<Grid>();
            if (count > most) throw_too_many_children(rule, most);
            family.begin(count);
            std::array<Element, fits_handle<Element> ? most : 1> on_stack;
            std::span<Element> children = places(family, count);
            if (children.empty()) children = std::span(on_stack).first(count);
            call_children(*grid_, context, e, children);
            MemberMasks masks;
            for (std::size_t c = 0; c < count; ++c) {
                if ((wanted >> c & 1U) == 0) continue;
                describe_member(*grid_, this->facts_, context, children[c], family, c, masks);
            }
            family.split = masks.split;
            family.leaves = masks.leaves;
            family.hidden = masks.hidden;
            return missing;
        });
    }

    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        Real* values) const override {
        return with(task, [&](auto& context) {
            return ask(context, element_of<Element>(element), rule, which, values);
        });
    }

    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override {
        with(task, [&](auto& context) {
            const auto& e = element_of<Element>(element);
            if (may_offer<Grid>(Feature::own_keys) && keys != nullptr) {
                call_corner_keys(*grid_, context, e, std::span<NodeKey>(keys, count));
            }
            if (may_offer<Grid>(Feature::own_positions) && positions != nullptr) {
                call_corner_positions(*grid_, context, e, std::span<Point>(positions, count));
            }
            if (may_offer<Grid>(Feature::boundary_faces) && boundary != nullptr) {
                *boundary = call_boundary_faces(*grid_, context, e);
            }
        });
    }

    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override {
        with(task, [&](auto& context) {
            call_new_positions(*grid_, context, element_of<Element>(element), which, out);
        });
    }

    void corner_gradients(Task* task, const Handle& element, std::span<Point> out) const override {
        with(task, [&](auto& context) {
            call_corner_gradients(*field_, context, element_of<Element>(element), out);
        });
    }

    void node_gradients(std::span<const NodeKey> nodes, std::span<Point> out) const override {
        if constexpr (GivesGradientsByKey<Field, Grid>) {
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                out[i] = field_->gradient_at(grid_->place(nodes[i]));
            }
        }
    }

    int degree(Task* task, const Handle& leaf) const override {
        if (!may_have_degree_) return 1;
        return with(task, [&](auto& context) {
            return static_cast<int>(call_degree(*field_, context, element_of<Element>(leaf)));
        });
    }
    void evaluate(Task* task, const Handle& leaf, std::span<const Point> reference,
                  Real* out) const override {
        with(task, [&](auto& context) {
            call_evaluate(*field_, context, element_of<Element>(leaf), reference,
                          std::span<Real>(out, reference.size() * components_));
        });
    }

    int geometry_degree(Task* task, const Handle& leaf) const override {
        if (!may_offer<Grid>(Feature::geometry_degree)) return 1;
        return with(task, [&](auto& context) {
            const auto& e = element_of<Element>(leaf);
            return static_cast<int>(call_geometry_degree(*grid_, context, e));
        });
    }
    void map(Task* task, const Handle& leaf, std::span<const Point> reference,
             std::span<Point> out) const override {
        with(task, [&](auto& context) {
            call_map(*grid_, context, element_of<Element>(leaf), reference, out);
        });
    }

    std::array<NodeKey, 2> hanging_parents(NodeKey node) const override {
        if (!may_offer<Grid>(Feature::hanging_parents)) return {node, node};
        NoContext none;
        return call_hanging_parents(*grid_, none, node);
    }

    void star_rows(const std::function<void(const StarRow&)>& function) const override {
        NoContext none;
        call_for_each_star_row(*grid_, none, function);
    }
    void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const override {
        NoContext none;
        call_row_values(*field_, none, first, stride, out);
    }
    Point node_position(NodeKey node) const override {
        NoContext none;
        return call_node_position(*grid_, none, node);
    }

    void bisect(const Handle& element, PatchVisitor& visitor) const override {
        if constexpr (may_know_patches_) {
            bisect_patches(*grid_, *field_, element_of<Element>(element), visitor);
        }
    }

private:
    static constexpr auto components_ = static_cast<std::size_t>(components_of<Field>());
    static constexpr bool has_context_ = !std::is_same_v<Context<Grid>, NoContext>;
    static constexpr bool decodes_ = DecodesNewValues<Field, Grid>;
    static constexpr bool has_star_rows_ = requires(const Grid& grid) {
        grid.for_each_star_row([](const StarRow&) {});
    };
    static constexpr bool may_have_degree_ =
        offers_degree<Field, Context<Grid>, const Element&> &&
        offers_evaluate<Field, Context<Grid>, const Element&, std::span<const Point>,
                        std::span<Real>>;
    static constexpr bool may_know_patches_ =
        requires(const Grid& grid, const Field& field, const Element& e, PatchVisitor& visitor) {
        { knows_patches(grid, field, HierarchyFacts{}) } -> std::same_as<bool>;
        bisect_patches(grid, field, e, visitor);
    };

    struct OpenTask final : Task {
        explicit OpenTask(const Grid& grid) : context(make_context(grid)) {}
        Context<Grid> context;
    };

    /// Calls function(context) with the context of a task.
    template <class Function>
    static decltype(auto) with(Task* task, Function&& function) {
        if constexpr (has_context_) {
            return function(static_cast<OpenTask*>(task)->context);
        } else {
            NoContext none;
            return function(none);
        }
    }

    static HierarchyFacts facts_of(const Grid& grid, const Field& field) {
        HierarchyFacts facts = facts_of_grid(grid);
        facts.components = components_of<Field>();
        facts.decodes = decodes_;
        if (offers_gradients<Grid>(field)) {
            facts.features |= static_cast<unsigned>(Feature::gradients);
        }
        if (offers_polynomials<Grid>(field)) {
            facts.features |= static_cast<unsigned>(Feature::degree);
        }
        facts.knows_stars = has_star_rows_ && KnowsRows<Field> && nestgrid::knows_stars(grid) &&
                            nestgrid::knows_stars(field);
        facts.knows_star_positions = has_star_rows_ && requires { grid.node_position(NodeKey{}); }
        &&nestgrid::knows_stars(grid);
        if constexpr (may_know_patches_) facts.knows_patches = knows_patches(grid, field, facts);
        facts.gradients_at_nodes = GivesGradientsAtNodes<Field, Grid> && facts.knows_patches;
        facts.gradients_by_key =
            GivesGradientsByKey<Field, Grid> && facts.offers(Feature::gradients);
        facts.bisects_means = facts.knows_patches && facts.dimension == 3;
        if constexpr (requires { field.far_values(); }) facts.far_values = field.far_values();
        if (facts.offers(Feature::presence)) facts.drop_promises_of_whole_grids();
        return facts;
    }

    /// Where the elements of a family are kept that do not fit into handles; else nothing.
    static std::span<Element> places(Family& family, std::size_t count) {
        if constexpr (fits_handle<Element>) {
            return {};
        } else {
            if (!family.elements) family.elements = std::make_shared<std::vector<Element>>();
            auto& elements = *static_cast<std::vector<Element>*>(family.elements.get());
            if (elements.size() < count) elements.resize(count);
            return std::span(elements).first(count);
        }
    }

    /// Values at new nodes, behind those at the corners.
    template <class AnyContext>
    NodeMask ask(AnyContext& context, const Element& e, const Rule& rule, NodeMask which,
                 Real* values) const {
        const std::size_t corners = static_cast<std::size_t>(rule.corner_count()) * components_;
        const std::span<Real> out(values + corners, rule.new_nodes.size() * components_);
        if constexpr (decodes_) {
            return call_new_values(*field_, context, e, which,
                                   std::span<const Real>(values, corners), out);
        } else {
            return call_new_values(*field_, context, e, which, out);
        }
    }

    const Grid* grid_;
    const Field* field_;
    MadeFor made_for_;
};

}  // namespace detail

/// A grid and a field on it as a Hierarchy; both are borrowed.
template <class Grid, class Field>
detail::ErasedHierarchy<Grid, Field> erase(const Grid& grid, const Field& field) {
    return {grid, field};
}

}  // namespace nestgrid
