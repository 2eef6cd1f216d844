// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The optional operations (optional.hpp) by name: whether a class that names one has it with a
// signature that the library calls, and the list of those that a grid and a field offer.
//
// A member is looked at where it can be called as an optional operation, or where its name stands
// for it alone: the name of overloads, of a member template, or of a member whose constraints are
// not satisfied does not. No one can tell a misspelt name from another member; the list shows that
// an operation is missed.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <nestgrid/optional.hpp>

namespace nestgrid {

namespace detail {

/// Whether an operation that returns T can stand for one that returns Result: integers for
/// integers, but truth values for truth values only, and anything for void.
template <class T, class Result>
concept ReturnsAs = std::is_void_v<Result> || std::same_as<T, Result> ||
    (std::integral<T>&& std::integral<Result> && !std::same_as<T, bool> &&
     !std::same_as<Result, bool>);

/// The type of the last argument of operations that take no context.
class NoLastArgument {
    NoLastArgument() = delete;
};

/// names_name<Model, Result, Ctx, Args...>: Model has a member of that name. fits_name<...>: it has
/// one that takes Args, perhaps Ctx& after them, and returns Result.
#define NESTGRID_NAMED_OPERATION(name)                              \
    template <class Model, class Result, class Ctx, class... Args>  \
    concept names_##name = requires {                               \
        &Model::name;                                               \
    }                                                               \
    || requires(const Model& m, Args... args) { m.name(args...); }; \
    template <class Model, class Result, class Ctx, class... Args>  \
    concept fits_##name = requires(const Model& m, Args... args) {  \
        { m.name(args...) } -> ReturnsAs<Result>;                   \
    }                                                               \
    || requires(const Model& m, Ctx& c, Args... args) {             \
        { m.name(args..., c) } -> ReturnsAs<Result>;                \
    };

NESTGRID_NAMED_OPERATION(corner_keys)
NESTGRID_NAMED_OPERATION(new_keys)
NESTGRID_NAMED_OPERATION(node_count)
NESTGRID_NAMED_OPERATION(corner_positions)
NESTGRID_NAMED_OPERATION(new_positions)
NESTGRID_NAMED_OPERATION(constrained)
NESTGRID_NAMED_OPERATION(conforming)
NESTGRID_NAMED_OPERATION(masked)
NESTGRID_NAMED_OPERATION(hidden)
NESTGRID_NAMED_OPERATION(outside)
NESTGRID_NAMED_OPERATION(boundary_faces)
NESTGRID_NAMED_OPERATION(knows_stars)
NESTGRID_NAMED_OPERATION(node_position)
NESTGRID_NAMED_OPERATION(epoch)
NESTGRID_NAMED_OPERATION(corner_gradients)
NESTGRID_NAMED_OPERATION(row_values)

#undef NESTGRID_NAMED_OPERATION

#define NESTGRID_MUST_FIT(who, name, signature, ...)                      \
    static_assert(!names_##name<__VA_ARGS__> || fits_##name<__VA_ARGS__>, \
                  who " has a member '" #name                             \
                      "' that does not fit the optional operation '" signature "'.")

template <class Grid>
consteval void require_fitting_operations_of_grid() {
    using E = const ElementOf<Grid>&;
    using C = Context<Grid>;
    using Keys = std::span<NodeKey>;
    using Points = std::span<Point>;
    NESTGRID_MUST_FIT("A nested grid", corner_keys,
                      "void corner_keys(const Element&, std::span<NodeKey> out) const", Grid, void,
                      C, E, Keys);
    NESTGRID_MUST_FIT("A nested grid", new_keys,
                      "void new_keys(const Element&, std::span<NodeKey> out) const", Grid, void, C,
                      E, Keys);
    NESTGRID_MUST_FIT("A nested grid", node_count, "std::size_t node_count() const", Grid,
                      std::size_t, NoLastArgument);
    NESTGRID_MUST_FIT("A nested grid", corner_positions,
                      "void corner_positions(const Element&, std::span<Point> out) const", Grid,
                      void, C, E, Points);
    NESTGRID_MUST_FIT(
        "A nested grid", new_positions,
        "void new_positions(const Element&, NodeMask which, std::span<Point> out) const", Grid,
        void, C, E, NodeMask, Points);
    NESTGRID_MUST_FIT("A nested grid", constrained, "NodeMask constrained(const Element&) const",
                      Grid, NodeMask, C, E);
    NESTGRID_MUST_FIT("A nested grid", conforming, "bool conforming() const", Grid, bool,
                      NoLastArgument);
    NESTGRID_MUST_FIT("A nested grid", masked, "bool masked(const Element&) const", Grid, bool, C,
                      E);
    NESTGRID_MUST_FIT("A nested grid", hidden, "Hidden hidden(const Element&) const", Grid, Hidden,
                      C, E);
    NESTGRID_MUST_FIT("A nested grid", outside, "NodeMask outside(const Element&) const", Grid,
                      NodeMask, C, E);
    NESTGRID_MUST_FIT("A nested grid", boundary_faces,
                      "unsigned boundary_faces(const Element&) const", Grid, unsigned, C, E);
    NESTGRID_MUST_FIT("A nested grid", knows_stars, "bool knows_stars() const", Grid, bool,
                      NoLastArgument);
    NESTGRID_MUST_FIT("A nested grid", node_position, "Point node_position(NodeKey) const", Grid,
                      Point, NoLastArgument, NodeKey);
    NESTGRID_MUST_FIT("A nested grid", epoch, "std::uint64_t epoch() const", Grid, std::uint64_t,
                      NoLastArgument);
    static_assert(offers_corner_keys<Grid, C, E, Keys> == offers_new_keys<Grid, C, E, Keys>,
                  "A nested grid with keys of its own must define both 'corner_keys' and "
                  "'new_keys'; the library would ignore one alone.");
}

template <class Field, class Grid>
consteval void require_fitting_operations_of_field() {
    using E = const ElementOf<Grid>&;
    NESTGRID_MUST_FIT("A nodal field", corner_gradients,
                      "void corner_gradients(const Element&, std::span<Point> out) const", Field,
                      void, Context<Grid>, E, std::span<Point>);
    NESTGRID_MUST_FIT(
        "A nodal field", row_values,
        "void row_values(NodeKey first, std::size_t stride, std::span<value_type> out) const",
        Field, void, NoLastArgument, NodeKey, std::size_t, std::span<typename Field::value_type>);
    NESTGRID_MUST_FIT("A nodal field", knows_stars, "bool knows_stars() const", Field, bool,
                      NoLastArgument);
}

#undef NESTGRID_MUST_FIT

}  // namespace detail

/// Says in English which optional operation of a grid or a field has a signature that the library
/// does not call; every algorithm asks.
template <class Grid, class Field>
consteval bool require_fitting_operations() {
    detail::require_fitting_operations_of_grid<Grid>();
    detail::require_fitting_operations_of_field<Field, Grid>();
    return true;
}

/// The names of the optional operations and constants that the library finds in a grid, in the
/// order of optional.hpp.
template <class Grid>
std::vector<std::string> offered_operations(const Grid& grid) {
    std::vector<std::string> names;
    const auto add = [&](bool offered, const char* name) {
        if (offered) names.emplace_back(name);
    };
    const auto has = [&](Feature f) { return may_offer<Grid>(f) && offers(grid, f); };
    add(has(Feature::own_keys), "corner_keys");
    add(has(Feature::own_keys), "new_keys");
    add(has(Feature::dense_keys), "node_count");
    add(has(Feature::own_positions), "corner_positions");
    add(has(Feature::new_positions), "new_positions");
    add(has(Feature::constrained), "constrained");
    add(
        requires { grid.conforming(); }, "conforming");
    add(has(Feature::masked), "masked");
    add(has(Feature::hidden), "hidden");
    add(has(Feature::outside), "outside");
    add(has(Feature::boundary_faces), "boundary_faces");
    add(
        requires { grid.for_each_star_row([](const StarRow&) {}); }, "for_each_star_row");
    add(
        requires { grid.knows_stars(); }, "knows_stars");
    add(
        requires { grid.node_position(NodeKey{}); }, "node_position");
    add(
        requires { grid.epoch(); }, "epoch");
    add(
        requires { Grid::max_corners; }, "max_corners");
    add(
        requires { Grid::max_new_nodes; }, "max_new_nodes");
    add(
        requires { Grid::max_children; }, "max_children");
    add(
        requires { Grid::only_shape; }, "only_shape");
    return names;
}

/// Likewise of a field on a grid.
template <class Grid, class Field>
std::vector<std::string> offered_field_operations(const Field& field) {
    std::vector<std::string> names;
    if (offers_gradients<Grid>(field)) names.emplace_back("corner_gradients");
    if (KnowsRows<Field>) names.emplace_back("row_values");
    if (requires { field.knows_stars(); }) names.emplace_back("knows_stars");
    return names;
}

}  // namespace nestgrid
