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

}  // namespace nestgrid

#include <nestgrid/adapters/union_steps.hpp>
