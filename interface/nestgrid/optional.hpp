// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The optional operations of a grid, and how the library asks for any operation.
//
// A grid may also offer, always with or without a trailing `Context&`:
//     void corner_keys(e, std::span<NodeKey> out), void new_keys(e, std::span<NodeKey> out)
//         own level-independent node keys; default: derived, keys.hpp
//     std::size_t node_count()
//         promises that own keys lie in [0, node_count): tables become arrays
//     void corner_positions(e, std::span<Point> out)
//         positions by heart, on grids where eq. (1) holds for them; a function of the node alone;
//         default: interpolated on the way down
//     void new_positions(e, NodeMask which, std::span<Point> out)
//         true positions on curved or moving grids; projected with the same S as the data
//     NodeMask constrained(e)
//         new nodes of e that hang, here or in any other element; default: derived
//     bool conforming()
//         promises that no node hangs, which spares the derivation
//     bool masked(e)
//         e lies outside the domain: skipped with everything below it
//     Hidden hidden(e)
//         whether e and what lies below it is shown: nothing is drawn where it is hidden, but what
//         is drawn beside is what would be drawn if it were not. No element that is hidden in part
//         stops, and hidden leaves constrain no node
//     NodeMask outside(e)
//         new nodes at which no element may stop because only deeper elements end at the boundary
//         of the domain; saturated like an infinite indicator
//     unsigned boundary_faces(e)
//         faces on the boundary of the domain, one bit each, any of them for an element that
//         reaches across it; default: derived from coarse ids
//     void for_each_star_row(f)
//         calls f(StarRow) fine to coarse, each node of any element in one row that does not
//         gather. All coarse elements are split alike, and all of their children; default: sweeps
//     bool knows_stars()
//         whether it does, where that is decided at run time; of a field, whether it has
//         row_values()
//     Point node_position(NodeKey)
//         random access, with for_each_star_row
//     std::uint64_t epoch()
//         changes with the grid: tells stale prerolls
// It may also name constants, from which the sizes of arrays and the lengths of loops follow:
//     static constexpr int max_corners, max_new_nodes, max_children
//         of its elements and rules; default: those of all shapes and rules
//     static constexpr Shape only_shape
//         of all elements; default: simplices where there are no more corners, else any
// and a field
//     void corner_gradients(e, std::span<Point> out)   gradients at the corners, per unit length
//     void row_values(NodeKey first, std::size_t stride, std::span<value_type> out)
//         at the nodes first, first + stride, ... of a star row or of their parents in one place;
//         random access, with for_each_star_row
// A member with one of these names and another signature does not compile; check_grid lists the
// operations it found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <nestgrid/detail/inlining.hpp>
#include <nestgrid/grid.hpp>
#include <nestgrid/keys.hpp>

namespace nestgrid {

/// Nodes first, first + stride, ... of a grid with dense keys, each a plain mean of its parents and
/// with finer nodes around it, at the same distances in key from each. A maximum over those and, of
/// each of them, over its own, is one over all nodes that are made in elements with this corner.
struct StarRow {
    std::size_t first = 0;
    std::size_t stride = 1;
    std::size_t count = 0;
    /// None on the coarse grid, 2, 4 around a face in tensor order, or 8.
    std::span<const std::ptrdiff_t> parents;
    std::span<const std::ptrdiff_t> finer;  ///< nodes of earlier rows
    std::size_t outside = 0;  ///< of the last ones: how many are as the operation `outside` says
    /// Nodes inside elements (Rule::inside) that were in earlier rows; `finer` are now all new
    /// nodes of such an element, and these stand for all of them from here on.
    bool gathers = false;
};

enum class Feature : unsigned {
    own_keys = 1,
    dense_keys = 2,
    own_positions = 4,
    new_positions = 8,
    constrained = 16,
    masked = 32,
    outside = 64,
    boundary_faces = 128,
    gradients = 256,
    hidden = 512,
};
inline constexpr Feature last_feature = Feature::hidden;

enum class Hidden : std::uint8_t { not_at_all, partly, wholly };

template <class Grid>
using ElementOf = typename Grid::Element;

template <class Grid>
using Context = typename detail::ContextOf<Grid>::type;

template <class Grid>
Context<Grid> make_context(const Grid& grid) {
    if constexpr (requires { grid.make_context(); }) {
        return grid.make_context();
    } else {
        return {};
    }
}

namespace detail {

/// Calls an operation with the context where it takes one. `model` is any grid or field, `call` a
/// generic lambda that forwards to the member.
#define NESTGRID_OPERATION(name)                                               \
    template <class Model, class Ctx, class... Args>                           \
    concept offers_##name = requires(const Model& m, Ctx& c, Args&&... args) { \
        m.name(args..., c);                                                    \
    }                                                                          \
    || requires(const Model& m, Args&&... args) { m.name(args...); };          \
    template <class Model, class Ctx, class... Args>                           \
    decltype(auto) call_##name(const Model& m, Ctx& c, Args&&... args) {       \
        if constexpr (requires { m.name(args..., c); }) {                      \
            return m.name(args..., c);                                         \
        } else {                                                               \
            return m.name(args...);                                            \
        }                                                                      \
    }

NESTGRID_OPERATION(split)
NESTGRID_OPERATION(children)
NESTGRID_OPERATION(coarse)
NESTGRID_OPERATION(coarse_values)
NESTGRID_OPERATION(new_values)
NESTGRID_OPERATION(corner_keys)
NESTGRID_OPERATION(new_keys)
NESTGRID_OPERATION(corner_positions)
NESTGRID_OPERATION(new_positions)
NESTGRID_OPERATION(constrained)
NESTGRID_OPERATION(masked)
NESTGRID_OPERATION(hidden)
NESTGRID_OPERATION(outside)
NESTGRID_OPERATION(boundary_faces)
NESTGRID_OPERATION(corner_gradients)

#undef NESTGRID_OPERATION

// The constants, or what they are by default.
template <class Grid>
constexpr std::size_t corner_capacity() {
    if constexpr (requires { Grid::max_corners; }) {
        return static_cast<std::size_t>(Grid::max_corners);
    } else {
        return max_corners;
    }
}
template <class Grid>
constexpr std::size_t child_capacity() {
    if constexpr (requires { Grid::max_children; }) {
        return static_cast<std::size_t>(Grid::max_children);
    } else {
        return max_children;
    }
}

/// Of all elements, where it is known when the grid is compiled; else Shape::point.
template <class Grid>
constexpr Shape only_shape() {
    constexpr bool simplices = corner_capacity<Grid>() == std::size_t{Grid::dimension} + 1;
    if constexpr (requires { Grid::only_shape; }) {
        return Grid::only_shape;
    } else if constexpr (simplices) {
        return Grid::dimension == 1   ? Shape::segment
               : Grid::dimension == 2 ? Shape::triangle
                                      : Shape::tetrahedron;
    } else {
        return Shape::point;
    }
}

template <class Model>
concept DecidesAtRunTime = requires(const Model& m) {
    { m.offers(Feature::own_keys) } -> std::same_as<bool>;
};

template <class Grid>
constexpr unsigned static_features() {
    using E = const ElementOf<Grid>&;
    using C = Context<Grid>;
    unsigned f = 0;
    const auto add = [&](Feature feature, bool offered) {
        if (offered) f |= static_cast<unsigned>(feature);
    };
    const bool keys = offers_corner_keys<Grid, C, E, std::span<NodeKey>> &&
                      offers_new_keys<Grid, C, E, std::span<NodeKey>>;
    add(Feature::own_keys, keys);
    add(
        Feature::dense_keys, keys && requires(const Grid& g) { g.node_count(); });
    add(Feature::own_positions, offers_corner_positions<Grid, C, E, std::span<Point>>);
    add(Feature::new_positions, offers_new_positions<Grid, C, E, NodeMask, std::span<Point>>);
    add(Feature::constrained, offers_constrained<Grid, C, E>);
    add(Feature::masked, offers_masked<Grid, C, E>);
    add(Feature::hidden, offers_hidden<Grid, C, E>);
    add(Feature::outside, offers_outside<Grid, C, E>);
    add(Feature::boundary_faces, offers_boundary_faces<Grid, C, E>);
    return f;
}

}  // namespace detail

/// Whether the class has the operation at all; a type-erased grid decides at run time.
template <class Grid>
constexpr bool may_offer(Feature feature) {
    return (detail::static_features<Grid>() & static_cast<unsigned>(feature)) != 0;
}

/// Whether this grid offers the operation.
template <class Grid>
constexpr bool offers(const Grid& grid, Feature feature) {
    if constexpr (detail::DecidesAtRunTime<Grid>) {
        return grid.offers(feature);
    } else {
        return may_offer<Grid>(feature);
    }
}

/// How much of an element is hidden.
template <class Grid>
Hidden hidden_part(const Grid& grid, Context<Grid>& context, const ElementOf<Grid>& e) {
    if constexpr (may_offer<Grid>(Feature::hidden)) {
        if (offers(grid, Feature::hidden)) return detail::call_hidden(grid, context, e);
    }
    return Hidden::not_at_all;
}
template <class Grid>
bool is_hidden(const Grid& grid, Context<Grid>& context, const ElementOf<Grid>& e) {
    return hidden_part(grid, context, e) == Hidden::wholly;
}

/// Whether this field offers gradients at the corners of elements of the grid.
template <class Grid, class Field>
constexpr bool offers_gradients(const Field& field) {
    if constexpr (!detail::offers_corner_gradients<Field, Context<Grid>, const ElementOf<Grid>&,
                                                   std::span<Point>>) {
        return false;
    } else if constexpr (detail::DecidesAtRunTime<Field>) {
        return field.offers(Feature::gradients);
    } else {
        return true;
    }
}

/// Number of dense keys, or 0 where keys are not dense.
template <class Grid>
std::size_t dense_key_count(const Grid& grid) {
    if constexpr (may_offer<Grid>(Feature::dense_keys)) {
        return offers(grid, Feature::dense_keys) ? grid.node_count() : 0;
    } else {
        return 0;
    }
}

template <class Field>
concept KnowsRows = requires(const Field& field, std::span<typename Field::value_type> out) {
    field.row_values(NodeKey{}, std::size_t{1}, out);
};

/// Whether a grid or field that has the operations on stars can be asked for them.
template <class Model>
bool knows_stars(const Model& model) {
    if constexpr (requires { model.knows_stars(); }) {
        return model.knows_stars();
    } else {
        return true;
    }
}

template <class Grid>
std::uint64_t epoch(const Grid& grid) {
    if constexpr (requires { grid.epoch(); }) {
        return grid.epoch();
    } else {
        return 0;
    }
}

}  // namespace nestgrid
