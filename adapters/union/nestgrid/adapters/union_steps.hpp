// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of union.hpp, at whose end this is included.
#pragma once

namespace nestgrid {

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
