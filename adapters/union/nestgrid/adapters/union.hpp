// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The union of two hierarchies over one coarse grid (paper, section 5.3): two frames of an adaptive
// run on one grid, so that times between them can be drawn (key_frames.hpp).
//
// An element is a pair of elements at one place. Where one grid ends in a leaf and the other goes
// on, the frame on the leaf is interpolated.
// Invariants:
//   - an element is split where one of the two grids splits it; where both do, they have one rule,
//     so that the rule is a function of the element: true of bisection, octrees and prisms that are
//     refined in one way, not of red-green refinement;
//   - the value of a frame at a node is that of its field where its grid has the node and the node
//     does not hang there, else the mean by the node's stencil of the frame's values: a function of
//     the node, to the last bit;
//   - keys are derived, because the numbers that two grids give to one node differ.
// Consequence: each frame is the same function as on its own grid, and the union is a nested grid
// like any other: it has its own hanging nodes, and prerolls of the frames are made on it.
// Memory: nothing is stored; an element carries the values of both frames at its corners.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/detail/constants.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/detail/made_for.hpp>
#include <nestgrid/detail/operations.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

template <class Grid, class Field>
class UnionFrame;

/// \tparam Grid of both frames, without masked, hidden or outside elements, on one process
/// \tparam Field on it
template <class Grid, class Field>
class Union {
    static_assert(
        !may_offer<Grid>(Feature::masked) && !may_offer<Grid>(Feature::hidden) &&
            !may_offer<Grid>(Feature::outside) && !may_offer<Grid>(Feature::presence),
        "A union takes no grids with masked, hidden or outside elements, nor any of which "
        "parts may be on other processes.");

public:
    using Real = typename Field::value_type;
    static constexpr int dimension = Grid::dimension;
    static constexpr int max_corners = static_cast<int>(detail::corner_capacity<Grid>());
    static constexpr int max_children = static_cast<int>(detail::child_capacity<Grid>());
    static constexpr Shape only_shape = detail::only_shape<Grid>();
    static constexpr int components = detail::components_of<Field>();

    /// The part of an element that belongs to one of the two grids.
    struct Side {
        typename Grid::Element element{};  ///< undefined where the side ends
        bool ends = false;                 ///< a leaf of the grid lies above the element
        /// Values of the frame at the corners of the element; not a number where its field has
        /// none.
        std::array<Real, static_cast<std::size_t>(max_corners* components)> value{};
    };
    struct Element {
        std::array<Side, 2> side;
    };
    struct Context {
        std::array<nestgrid::Context<Grid>, 2> side;
    };

    /// Walks what the grids have in common. All four are borrowed.
    /// \throw GridError where the coarse grids differ, where both grids split an element and not
    ///        alike, and where a grid does not say which of its nodes hang
    Union(const Grid& first, const Field& first_field, const Grid& second,
          const Field& second_field);

    /// Frame 0 or 1 on this grid.
    UnionFrame<Grid, Field> frame(std::size_t number) const { return {*this, number}; }

    Context make_context() const {
        return {{nestgrid::make_context(*grid_[0]), nestgrid::make_context(*grid_[1])}};
    }
    std::size_t coarse_count() const { return grid_[0]->coarse_count(); }
    CoarseElement<Element> coarse(std::size_t i) const {
        Context context = make_context();
        return coarse(i, context);
    }
    CoarseElement<Element> coarse(std::size_t i, Context& context) const;
    const Rule* split(const Element& e, Context& context) const {
        const Rule* const first = split(e, 0, context);
        return first != nullptr ? first : split(e, 1, context);
    }
    void children(const Element& e, std::span<Element> out, Context& context) const;

    unsigned boundary_faces(const Element& e, Context& context) const
        requires(may_offer<Grid>(Feature::boundary_faces)) {
        const std::size_t s = e.side[0].ends ? 1 : 0;
        return detail::call_boundary_faces(*grid_[s], context.side[s], e.side[s].element);
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out,
                       Context& context) const requires(may_offer<Grid>(Feature::new_positions)) {
        const std::size_t s = split(e, 0, context) == nullptr ? 1 : 0;
        detail::call_new_positions(*grid_[s], context.side[s], e.side[s].element, which, out);
    }
    /// \throw GridError by coarse() where one of the grids has changed since
    std::uint64_t epoch() const {
        return nestgrid::epoch(*grid_[0]) * 0x9E3779B97F4A7C15U + nestgrid::epoch(*grid_[1]);
    }

private:
    friend UnionFrame<Grid, Field>;

    static constexpr auto stride_ = static_cast<std::size_t>(components);
    /// Values of a frame at the corners of an element and, behind them, at its new nodes.
    using Values =
        std::array<Real, (static_cast<std::size_t>(max_corners) + max_new_nodes) * stride_>;

    /// The rule by which one of the grids splits an element, or null.
    const Rule* split(const Element& e, std::size_t s, Context& context) const {
        if (e.side[s].ends) return nullptr;
        return detail::call_split(*grid_[s], context.side[s], e.side[s].element);
    }
    void require_same_coarse() const;
    void require_same_rules() const;
    void find_hanging(std::size_t s);
    NodeMask hanging(const Element& e, std::size_t s, const Rule& rule, Context& context) const;
    void find_values(const Element& e, std::size_t s, const Rule& rule, Values& values,
                     Context& context) const;

    std::array<const Grid*, 2> grid_;
    std::array<const Field*, 2> field_;
    std::array<HangingNodes, 2> hanging_;  // where a grid does not say so itself
    std::array<detail::MadeFor, 2> made_for_;
};

/// One of the two frames as a field on the union, which must outlive it.
template <class Grid, class Field>
class UnionFrame {
public:
    using Real = typename Field::value_type;
    using value_type = Real;
    static constexpr int components = detail::components_of<Field>();

    UnionFrame(const Union<Grid, Field>& both, std::size_t number)
        : union_{&both}, number_{number} {}

    NodeMask coarse_values(std::size_t i, std::span<Real> out,
                           typename Union<Grid, Field>::Context& context) const {
        const auto e = union_->coarse(i, context).element;
        return give(e.side[number_].value.data(), ~NodeMask{0}, out);
    }
    NodeMask new_values(const typename Union<Grid, Field>::Element& e, NodeMask which,
                        std::span<Real> out, typename Union<Grid, Field>::Context& context) const {
        const Rule& rule = *union_->split(e, context);
        typename Union<Grid, Field>::Values values;
        union_->find_values(e, number_, rule, values, context);
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        return give(values.data() + corners * components, which, out);
    }

private:
    /// \return the nodes without a value
    static NodeMask give(const Real* values, NodeMask which, std::span<Real> out) {
        NodeMask missing = 0;
        for (std::size_t i = 0; i < out.size(); ++i) {
            const std::size_t node = i / components;
            if ((which >> node & 1U) == 0) continue;
            out[i] = values[i];
            if (std::isnan(values[i])) missing |= NodeMask{1} << node;
        }
        return missing;
    }

    const Union<Grid, Field>* union_;
    std::size_t number_;
};

namespace detail {

/// Whether two rules make the same nodes and children.
inline bool are_same(const Rule& a, const Rule& b) {
    if (&a == &b) return true;
    const auto same_child = [](const Child& x, const Child& y) {
        return x.shape == y.shape && x.corner == y.corner && x.orientation == y.orientation;
    };
    return a.parent == b.parent && a.new_nodes == b.new_nodes &&
           std::equal(a.children.begin(), a.children.end(), b.children.begin(), b.children.end(),
                      same_child);
}

}  // namespace detail

template <class Grid, class Field>
Union<Grid, Field>::Union(const Grid& first, const Field& first_field, const Grid& second,
                          const Field& second_field)
    : grid_{&first, &second},
      field_{&first_field, &second_field},
      made_for_{detail::MadeFor(first), detail::MadeFor(second)} {
    require_same_coarse();
    require_same_rules();
    for (const std::size_t s : {0U, 1U}) find_hanging(s);
}

template <class Grid, class Field>
void Union<Grid, Field>::require_same_coarse() const {
    const std::size_t count = grid_[0]->coarse_count();
    if (grid_[1]->coarse_count() != count) {
        throw GridError("the grids of a union must have one coarse grid, but one has " +
                        std::to_string(count) + " coarse elements and the other " +
                        std::to_string(grid_[1]->coarse_count()));
    }
    Context context = make_context();
    for (std::size_t i = 0; i < count; ++i) {
        const auto a = detail::call_coarse(*grid_[0], context.side[0], i);
        const auto b = detail::call_coarse(*grid_[1], context.side[1], i);
        if (a.shape != b.shape || a.ids != b.ids || a.orientation != b.orientation ||
            a.corners != b.corners) {
            throw GridError("the grids of a union must have one coarse grid, but coarse element " +
                            std::to_string(i) +
                            " has other corners, ids or another shape in the second one");
        }
    }
}

template <class Grid, class Field>
void Union<Grid, Field>::require_same_rules() const {
    using Pair = std::array<typename Grid::Element, 2>;
    Context context = make_context();
    for (std::size_t i = 0; i < coarse_count(); ++i) {
        std::vector<Pair> left{{detail::call_coarse(*grid_[0], context.side[0], i).element,
                                detail::call_coarse(*grid_[1], context.side[1], i).element}};
        while (!left.empty()) {
            const Pair e = left.back();
            left.pop_back();
            const Rule* const a = detail::call_split(*grid_[0], context.side[0], e[0]);
            const Rule* const b = detail::call_split(*grid_[1], context.side[1], e[1]);
            if (a == nullptr || b == nullptr) continue;
            if (!detail::are_same(*a, *b)) {
                throw GridError("the grids of a union split an element below coarse element " +
                                std::to_string(i) + " differently, by the rules '" + a->name +
                                "' and '" + b->name + "'");
            }
            std::array<std::array<typename Grid::Element, static_cast<std::size_t>(max_children)>,
                       2>
                children;
            for (const std::size_t s : {0U, 1U}) {
                detail::call_children(*grid_[s], context.side[s], e[s],
                                      std::span(children[s]).first(a->children.size()));
            }
            for (std::size_t c = 0; c < a->children.size(); ++c) {
                left.push_back({children[0][c], children[1][c]});
            }
        }
    }
}

template <class Grid, class Field>
void Union<Grid, Field>::find_hanging(std::size_t s) {
    if (offers(*grid_[s], Feature::constrained)) return;
    if constexpr (requires { grid_[s]->conforming(); }) {
        if (grid_[s]->conforming()) return;
    }
    hanging_[s] = derive_hanging_nodes(*grid_[s]);
    if (hanging_[s].crossing() != nullptr ||
        (!hanging_[s].empty() && !offers(*grid_[s], Feature::own_keys))) {
        throw GridError("a grid of a union does not say which of its nodes hang");
    }
}

/// The new nodes that hang in one of the grids, which splits the element.
template <class Grid, class Field>
NodeMask Union<Grid, Field>::hanging(const Element& e, std::size_t s, const Rule& rule,
                                     Context& context) const {
    if constexpr (may_offer<Grid>(Feature::constrained)) {
        if (offers(*grid_[s], Feature::constrained)) {
            return detail::call_constrained(*grid_[s], context.side[s], e.side[s].element);
        }
    }
    if constexpr (may_offer<Grid>(Feature::own_keys)) {
        if (hanging_[s].size() != 0) {
            std::array<NodeKey, max_new_nodes> keys;
            const std::span<NodeKey> new_keys = std::span(keys).first(rule.new_nodes.size());
            detail::call_new_keys(*grid_[s], context.side[s], e.side[s].element, new_keys);
            return hanging_[s].mask(new_keys);
        }
    }
    return 0;
}

/// Sets the values of a frame at the nodes of a split element.
template <class Grid, class Field>
void Union<Grid, Field>::find_values(const Element& e, std::size_t s, const Rule& rule,
                                     Values& values, Context& context) const {
    const std::size_t corners = static_cast<std::size_t>(rule.corner_count()) * stride_;
    const std::size_t count = rule.new_nodes.size();
    std::copy_n(e.side[s].value.begin(), corners, values.begin());
    NodeMask interpolated = rule.all();
    if (split(e, s, context) != nullptr) {
        const std::span<Real> made = std::span(values).subspan(corners, count * stride_);
        const NodeMask missing = detail::call_new_values(*field_[s], context.side[s],
                                                         e.side[s].element, rule.all(), made);
        for (std::size_t i = 0; i < made.size(); ++i) {
            if ((missing >> i / stride_ & 1U) != 0) {
                made[i] = std::numeric_limits<Real>::quiet_NaN();
            }
        }
        interpolated = hanging(e, s, rule, context);
    }
    for (std::size_t n = 0; n < count; ++n) {
        if ((interpolated >> n & 1U) == 0) continue;
        const auto mean = detail::interpolate<stride_>(rule.new_nodes[n], values.data(), stride_);
        std::ranges::copy(mean,
                          values.begin() + static_cast<std::ptrdiff_t>(corners + n * stride_));
    }
}

template <class Grid, class Field>
auto Union<Grid, Field>::coarse(std::size_t i, Context& context) const -> CoarseElement<Element> {
    CoarseElement<Element> result;
    for (const std::size_t s : {0U, 1U}) {
        made_for_[s].require_same(*grid_[s], "the union");
        const auto from = detail::call_coarse(*grid_[s], context.side[s], i);
        Side& side = result.element.side[s];
        side.element = from.element;
        const std::span<Real> values =
            std::span(side.value).first(topology(from.shape).corners * stride_);
        const NodeMask missing = detail::call_coarse_values(*field_[s], context.side[s], i, values);
        for (std::size_t k = 0; k < values.size(); ++k) {
            if ((missing >> k / stride_ & 1U) != 0) {
                values[k] = std::numeric_limits<Real>::quiet_NaN();
            }
        }
        result.shape = from.shape;
        result.corners = from.corners;
        result.ids = from.ids;
        result.orientation = from.orientation;
    }
    return result;
}

template <class Grid, class Field>
void Union<Grid, Field>::children(const Element& e, std::span<Element> out,
                                  Context& context) const {
    const Rule& rule = *split(e, context);
    Values values;
    std::array<typename Grid::Element, static_cast<std::size_t>(max_children)> below;
    for (const std::size_t s : {0U, 1U}) {
        const bool ends = split(e, s, context) == nullptr;
        find_values(e, s, rule, values, context);
        if (!ends) {
            detail::call_children(*grid_[s], context.side[s], e.side[s].element,
                                  std::span(below).first(rule.children.size()));
        }
        for (std::size_t c = 0; c < rule.children.size(); ++c) {
            Side& side = out[c].side[s];
            const Child& child = rule.children[c];
            side.ends = ends;
            if (!ends) side.element = below[c];
            for (std::size_t k = 0; k < topology(child.shape).corners; ++k) {
                std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(child.corner[k] * stride_),
                            stride_, side.value.begin() + static_cast<std::ptrdiff_t>(k * stride_));
            }
        }
    }
}

}  // namespace nestgrid
