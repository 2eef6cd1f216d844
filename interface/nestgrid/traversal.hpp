// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The one depth-first traversal (paper, section 3) with the adaptive projection of eq. (2).
//
// Invariants:
//   - the state of an element is all that is known of it: its corners' projected values and,
//     where a visitor needs them and the grid does not know them by heart, keys and positions;
//   - a new node's value is the interpolant where S holds or the node hangs, else U itself;
//   - U is asked for only where it is used, the children only when they are entered.
// Consequences: memory is O(depth), on the call stack, without any heap; two elements that share a
// node see the same bits there, because every mean is symmetric in its arguments (mean.hpp).
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <nestgrid/closed.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/hanging.hpp>
#include <nestgrid/mean.hpp>
#include <nestgrid/operations.hpp>

namespace nestgrid {

enum class Visit : std::uint8_t {
    skip,     ///< nothing of interest: leave it and what lies below
    stop,     ///< extract the element
    descend,  ///< enter the children
};

/// A visitor's answer about one element.
struct Decision {
    Visit visit = Visit::descend;
    NodeMask interpolated = 0;  ///< new nodes at which the criterion S holds
};

/// The refinement of an element, or that it is a leaf.
struct Split {
    const Rule* rule = nullptr;
    NodeMask constrained = 0;       ///< new nodes that hang
    NodeMask outside = 0;           ///< see the operation `outside`
    std::span<const NodeKey> keys;  ///< of the new nodes, where the visitor needs keys
};

/// What the visitor wants to know of every element.
struct Needs {
    bool keys = false;
    bool positions = false;
    bool closed = false;  ///< closed edges and faces, closed.hpp; needs the other two
};

namespace detail {
struct Nothing {};
template <bool wanted, class T>
using CarriedIf = std::conditional_t<wanted, T, Nothing>;

template <class Grid>
constexpr bool by_heart(Feature feature) {
    return may_offer<Grid>(feature) && !DecidesAtRunTime<Grid>;
}
template <class Visitor>
bool sees_hidden(const Visitor& visitor) {
    if constexpr (requires { visitor.sees_hidden(); }) return visitor.sees_hidden();
    return false;
}
template <class Visitor, class State>
NodeMask children_to_enter(const Visitor& visitor, const State& s) {
    if constexpr (requires { visitor.children_to_enter(s); }) return visitor.children_to_enter(s);
    return ~NodeMask{0};
}
}  // namespace detail

/// An element on the way down.
template <class Grid, class Field, Needs needs>
struct ElementState {
    using Real = typename Field::value_type;
    using Element = ElementOf<Grid>;
    static constexpr std::size_t components =
        static_cast<std::size_t>(detail::components_of<Field>());
    static constexpr std::size_t capacity = detail::corner_capacity<Grid>();
    static constexpr bool carries_keys = needs.keys && !detail::by_heart<Grid>(Feature::own_keys);
    static constexpr bool carries_positions =
        needs.positions && !detail::by_heart<Grid>(Feature::own_positions);
    using Closed = ClosedParts<ElementState, Real, components, capacity>;

    Element element;
    Context<Grid>* context;      ///< of the task that walks
    std::size_t coarse;          ///< number of the coarse element it descends from
    const ElementState* father;  ///< nullptr for a coarse element
    int level;                   ///< 0 for coarse elements
    Shape shape;
    std::int8_t orientation;
    std::uint8_t boundary;      ///< faces on the boundary of the domain, one bit each
    std::uint8_t interpolated;  ///< corners whose value is interpolated by S, one bit each
    const Rule* made_by;        ///< the father's rule, and
    std::uint8_t child;         ///< this element's number in it
    /// A hash of the way down.
    [[no_unique_address]] detail::CarriedIf<needs.closed, NodeKey> path;
    std::array<Real, capacity * components> value;  ///< P_S U at the corners
    [[no_unique_address]] detail::CarriedIf<carries_keys, std::array<NodeKey, capacity>> key;
    [[no_unique_address]] detail::CarriedIf<carries_positions, std::array<Point, capacity>>
        position;
    [[no_unique_address]] detail::CarriedIf<needs.closed, Closed> closed;

    /// Of its shape; where all elements have one, loops over it are unrolled.
    constexpr const Topology& topology() const {
        constexpr Shape only = detail::only_shape<Grid>();
        return nestgrid::topology(only == Shape::point ? shape : only);
    }
    constexpr int corner_count() const { return topology().corners; }
};

/// Walks a grid with a field on it. Construction looks at the coarse grid once; the walk itself
/// allocates nothing. A visitor has
///     Decision inspect(const State&, const Split&);
///     void extract(const State&);              called for elements where it said stop, and leaves
///     void made(const State&, const Split&, std::span<const Real> values)
///                                              optional: P_S U at the corners and, behind them, at
///                                              the new nodes of an element about to be entered
///     bool passes_over_leaves() const;         optional: whether leaves around which nothing is
///                                              closed may be left out, unless coarse
///     NodeMask children_to_enter(const State&) optional: one bit each, where it said descend
///     bool looks_ahead() const;                optional: whether leaves that are not coarse ones
///                                              need no inspect(); then it has
///     NodeMask leaves_of_interest(const Rule&, std::span<const Real> values) const;
///                                              the children at which it would say stop if they are
///                                              leaves, one bit each, by P_S U at the nodes
///     void count_leaf(bool of_interest);       called for each of these leaves, if it is of
///                                              interest right before extract()
///     bool sees_hidden() const;                optional: whether it looks at hidden elements
///     void walk_bisections(const State&)       optional: takes the element and all below it in a
///                                              walk of its own (known_bisection.hpp), where
///     bool walks_bisections() const;           says so
/// Elements whose split creates no node (copies) are looked through: never shown to the visitor.
/// Where an element is hidden in part, stop means descend.
template <class Grid, class Field, Needs needs = Needs{}>
class Traversal {
    static_assert(require_nested_grid<Grid>());
    static_assert(require_nodal_field<Field, Grid>());
    static_assert(!needs.closed || (needs.keys && needs.positions));

public:
    using State = ElementState<Grid, Field, needs>;
    using Real = typename Field::value_type;
    using Element = ElementOf<Grid>;

    /// \param hanging nodes that hang, where the grid does not say so itself; may be null
    /// \throw GridError where a coarse element has a shape of another dimension than the grid
    explicit Traversal(const Grid& grid, const Field& field, const HangingNodes* hanging = nullptr)
        : grid_{&grid}, field_{&field}, hanging_{hanging} {
        boundary_faces_ = offers(grid, Feature::boundary_faces);
        if (!boundary_faces_) boundary_ = coarse_boundary(grid);
        own_keys_ = offers(grid, Feature::own_keys);
        own_positions_ = offers(grid, Feature::own_positions);
        new_positions_ = offers(grid, Feature::new_positions);
        constrained_ = offers(grid, Feature::constrained);
    }

    const Grid& grid() const { return *grid_; }
    const Field& field() const { return *field_; }

    template <class Visitor>
    void run(Visitor& visitor) const {
        run(visitor, 0, grid_->coarse_count());
    }

    /// Visits the coarse elements first ... last - 1 and what lies below them, in order.
    template <class Visitor>
    void run(Visitor& visitor, std::size_t first, std::size_t last) const {
        Context<Grid> context = make_context(*grid_);
        for (std::size_t i = first; i < last; ++i) {
            State state;
            state.context = &context;
            if (make_coarse(i, state)) walk_below(state, visitor);
        }
    }

    /// Visits an element and what lies below it.
    template <class Visitor>
    void walk_below(const State& s, Visitor& visitor) const {
        if constexpr (requires { visitor.walk_bisections(s); }) {
            if (visitor.walks_bisections()) return visitor.walk_bisections(s);
        }
        inspect(s, detail::call_split(*grid_, *s.context, s.element), visitor);
    }

    /// Keys of the corners.
    void keys(const State& s, std::span<NodeKey> out) const requires(needs.keys) {
        if constexpr (State::carries_keys) {
            std::copy_n(s.key.begin(), s.corner_count(), out.begin());
        } else {
            detail::call_corner_keys(*grid_, *s.context, s.element, exact(s, out));
        }
    }

    /// Positions of the corners.
    void positions(const State& s, std::span<Point> out) const requires(needs.positions) {
        if (own_positions_) {
            if constexpr (may_offer<Grid>(Feature::own_positions)) {
                detail::call_corner_positions(*grid_, *s.context, s.element, exact(s, out));
            }
        } else if constexpr (State::carries_positions) {
            std::copy_n(s.position.begin(), s.corner_count(), out.begin());
        }
    }

    /// Positions of the ends of a maximal edge.
    std::array<Point, 2> positions(const typename State::Closed::Edge& edge) const
        requires(needs.closed);

    /// Faces on the boundary of the domain, one bit each.
    unsigned boundary(const State& s) const {
        if constexpr (may_offer<Grid>(Feature::boundary_faces)) {
            if (boundary_faces_) {
                return detail::call_boundary_faces(*grid_, *s.context, s.element);
            }
        }
        return s.boundary;
    }

    /// Faces of each coarse element whose ids occur once on the coarse grid, one bit each.
    static std::vector<std::uint8_t> coarse_boundary(const Grid& grid);

private:
    static constexpr std::size_t node_capacity_ =
        State::capacity + detail::new_node_capacity<Grid>();

    template <class T>
    static std::span<T> exact(const State& s, std::span<T> out) {
        return out.first(static_cast<std::size_t>(s.corner_count()));
    }

    bool make_coarse(std::size_t i, State& s) const;

    template <class Visitor>
    void inspect(const State& s, const Rule* rule, Visitor& visitor) const;

    template <class Visitor>
    void descend(const State& s, const Split& split, NodeMask interpolated, NodeKey* keys,
                 Visitor& visitor) const;

    /// The nodes of one split.
    struct Nodes {
        NodeMask interpolated;  // by S
        NodeMask mean;          // by S, or because they hang
        NodeKey* key;
        std::array<Real, node_capacity_ * State::components> value;
        std::array<Point, State::carries_positions ? node_capacity_ : 1> position;
    };
    /// The edges and faces of a rule that a split closes.
    struct Parts;

    /// Enters the children; `parts` is null where nothing around them is closed.
    template <class Visitor>
    void enter(const State& s, const Rule& rule, const Nodes& nodes, const Parts* parts,
               Visitor& visitor) const;
    template <class Visitor>
    void close_and_enter(const State& s, const Rule& rule, const Nodes& nodes,
                         Visitor& visitor) const;
    void close(const State& s, const Rule& rule, const Nodes& nodes, Parts& parts) const;

    /// Values of the new nodes behind those of the corners, eq. (2).
    void project(const State& s, const Split& split, NodeMask interpolated, Real* value) const;
    void project_positions(const State& s, const Split& split, NodeMask interpolated,
                           Point* position) const;

    const Grid* grid_;
    const Field* field_;
    const HangingNodes* hanging_;
    std::vector<std::uint8_t> boundary_;
    bool boundary_faces_ = false;
    bool own_keys_ = false;
    bool own_positions_ = false;
    bool new_positions_ = false;
    bool constrained_ = false;
};

}  // namespace nestgrid

#include <nestgrid/traversal_steps.hpp>
