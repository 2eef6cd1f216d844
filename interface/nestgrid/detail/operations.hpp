// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the library finds and calls the operations of grids and fields. An optional operation
// (optional.hpp) is one row of NESTGRID_OPTIONAL_OPERATIONS; the row gives
//   - offers_name and call_name, with the context where the member takes one;
//   - the bit in the features of a grid;
//   - the sentence with which a member of that name and another signature is refused;
//   - the entry in the list of operations that check_grid found.
//
// A member is looked at where it can be called as an optional operation, or where its name stands
// for it alone: the name of overloads, of a member template, or of a member whose constraints are
// not satisfied does not. No one can tell a misspelt name from another member; the list shows that
// an operation is missed.
#pragma once

#include <concepts>
#include <string>
#include <type_traits>
#include <vector>

#include <nestgrid/optional.hpp>

namespace nestgrid {

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

template <class Model>
concept DecidesAtRunTime = requires(const Model& m) {
    { m.offers(Feature::own_keys) } -> std::same_as<bool>;
};

inline constexpr Feature no_feature{};
inline constexpr unsigned of_grid = 1;
inline constexpr unsigned of_field = 2;

/// The type of the last argument of operations that take no context.
struct NoContextArgument {
    NoContextArgument() = delete;
};

/// Rows of OPERATION(whose, feature, name, signature, Result, Ctx, Args...): who may have it, the
/// feature to which it belongs, and how the library calls it. E is an element of the grid, C its
/// context.
#define NESTGRID_OPTIONAL_OPERATIONS(OPERATION)                                                    \
    OPERATION(of_grid, Feature::own_keys, corner_keys,                                             \
              "void corner_keys(const Element&, std::span<NodeKey> out) const", void, C, E, Keys)  \
    OPERATION(of_grid, Feature::own_keys, new_keys,                                                \
              "void new_keys(const Element&, std::span<NodeKey> out) const", void, C, E, Keys)     \
    OPERATION(of_grid, Feature::dense_keys, node_count, "std::size_t node_count() const",          \
              std::size_t, NoContextArgument)                                                      \
    OPERATION(of_grid, Feature::own_positions, corner_positions,                                   \
              "void corner_positions(const Element&, std::span<Point> out) const", void, C, E,     \
              Points)                                                                              \
    OPERATION(of_grid, Feature::new_positions, new_positions,                                      \
              "void new_positions(const Element&, NodeMask which, std::span<Point> out) const",    \
              void, C, E, NodeMask, Points)                                                        \
    OPERATION(of_grid, Feature::constrained, constrained,                                          \
              "NodeMask constrained(const Element&) const", NodeMask, C, E)                        \
    OPERATION(of_grid, Feature::hanging_parents, hanging_parents,                                  \
              "std::array<NodeKey, 2> hanging_parents(NodeKey node) const", Parents,               \
              NoContextArgument, NodeKey)                                                          \
    OPERATION(of_grid, no_feature, conforming, "bool conforming() const", bool, NoContextArgument) \
    OPERATION(of_grid, Feature::masked, masked, "bool masked(const Element&) const", bool, C, E)   \
    OPERATION(of_grid, Feature::hidden, hidden, "Hidden hidden(const Element&) const", Hidden, C,  \
              E)                                                                                   \
    OPERATION(of_grid, Feature::presence, presence, "Presence presence(const Element&) const",     \
              Presence, C, E)                                                                      \
    OPERATION(of_grid, Feature::outside, outside, "NodeMask outside(const Element&) const",        \
              NodeMask, C, E)                                                                      \
    OPERATION(of_grid, Feature::boundary_faces, boundary_faces,                                    \
              "unsigned boundary_faces(const Element&) const", unsigned, C, E)                     \
    OPERATION(of_grid, Feature::geometry_degree, geometry_degree,                                  \
              "int geometry_degree(const Element&) const", int, C, E)                              \
    OPERATION(of_grid, Feature::geometry_degree, map,                                              \
              "void map(const Element&, std::span<const Point> reference, std::span<Point> out) "  \
              "const",                                                                             \
              void, C, E, Places, Points)                                                          \
    OPERATION(of_grid, no_feature, for_each_star_row, "void for_each_star_row(f) const", void,     \
              NoContextArgument, void (*)(const StarRow&))                                         \
    OPERATION(of_grid | of_field, no_feature, knows_stars, "bool knows_stars() const", bool,       \
              NoContextArgument)                                                                   \
    OPERATION(of_grid, no_feature, node_position, "Point node_position(NodeKey) const", Point,     \
              NoContextArgument, NodeKey)                                                          \
    OPERATION(of_grid, no_feature, epoch, "std::uint64_t epoch() const", std::uint64_t,            \
              NoContextArgument)                                                                   \
    OPERATION(of_field, Feature::gradients, corner_gradients,                                      \
              "void corner_gradients(const Element&, std::span<Point> out) const", void, C, E,     \
              Points)                                                                              \
    OPERATION(                                                                                     \
        of_field, no_feature, row_values,                                                          \
        "void row_values(NodeKey first, std::size_t stride, std::span<value_type> out) const",     \
        void, NoContextArgument, NodeKey, std::size_t, Values)                                     \
    OPERATION(of_field, Feature::degree, degree, "int degree(const Element&) const", int, C, E)    \
    OPERATION(of_field, Feature::degree, evaluate,                                                 \
              "void evaluate(const Element&, std::span<const Point> reference, "                   \
              "std::span<value_type> out) const",                                                  \
              void, C, E, Places, Values)

/// Whether an operation that returns T can stand for one that returns Result: integers for
/// integers, but truth values for truth values only, and anything for void.
template <class T, class Result>
concept ReturnsAs = std::is_void_v<Result> || std::same_as<T, Result> ||
    (std::integral<T>&& std::integral<Result> && !std::same_as<T, bool> &&
     !std::same_as<Result, bool>);

/// offers_name<Model, Ctx, Args...>: Model has a member of that name that takes Args, perhaps Ctx&
/// after them. call_name(model, context, args...) calls it, with the context where it takes one.
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

/// What a class answers to an operation that it does not have: a value that is 0, false or empty.
struct NoAnswer {
    template <class T>
    constexpr operator T() const {
        return T{};
    }
};

/// That, and call_name() where Model has no such member, which gives NoAnswer.
/// names_name<Model, Result, Ctx, Args...>: Model has a member of that name.
/// fits_name<...>: it has one that takes Args, perhaps Ctx& after them, and returns Result.
#define NESTGRID_OPTIONAL_OPERATION(whose, feature, name, signature, ...)        \
    NESTGRID_OPERATION(name)                                                     \
    template <class Model, class Ctx, class... Args>                             \
        requires(!offers_##name<Model, Ctx, Args...>)                            \
    constexpr NoAnswer call_##name(const Model&, Ctx&, Args&&...) { return {}; } \
    template <class Model, class Result, class Ctx, class... Args>               \
    concept names_##name = requires {                                            \
        &Model::name;                                                            \
    }                                                                            \
    || offers_##name<Model, NoContextArgument, Args...>;                         \
    template <class Model, class Result, class Ctx, class... Args>               \
    concept fits_##name = requires(const Model& m, Args... args) {               \
        { m.name(args...) } -> ReturnsAs<Result>;                                \
    }                                                                            \
    || requires(const Model& m, Ctx& c, Args... args) {                          \
        { m.name(args..., c) } -> ReturnsAs<Result>;                             \
    };

NESTGRID_OPERATION(split)
NESTGRID_OPERATION(children)
NESTGRID_OPERATION(coarse)
NESTGRID_OPERATION(coarse_values)
NESTGRID_OPERATION(new_values)
NESTGRID_OPTIONAL_OPERATIONS(NESTGRID_OPTIONAL_OPERATION)

/// What the rows say of a class: a grid, or a field with values of type Real.
/// \tparam who of_grid or of_field
template <unsigned who, class Model, class Grid, class Real>
class OptionalOperations {
public:
    /// The features that the class has: those of which it has all operations.
    static consteval unsigned features() {
        unsigned offered = 0;
        unsigned missing = 0;
#define NESTGRID_ADD_FEATURE(whose, feature, name, signature, Result, ...)                         \
    if (((whose)&who) != 0) {                                                                      \
        (offers_##name<Model, __VA_ARGS__> ? offered : missing) |= static_cast<unsigned>(feature); \
    }
        NESTGRID_OPTIONAL_OPERATIONS(NESTGRID_ADD_FEATURE)
#undef NESTGRID_ADD_FEATURE
        offered &= ~missing;
        const bool keys = (offered & static_cast<unsigned>(Feature::own_keys)) != 0;
        const unsigned of_keys = static_cast<unsigned>(Feature::dense_keys) |
                                 static_cast<unsigned>(Feature::hanging_parents);
        return keys ? offered : offered & ~of_keys;
    }

    static consteval bool all_fit() {
#define NESTGRID_MUST_FIT(whose, feature, name, signature, ...)              \
    static_assert(((whose)&who) == 0 || !names_##name<Model, __VA_ARGS__> || \
                      fits_##name<Model, __VA_ARGS__>,                       \
                  "A nested grid or a nodal field has a member '" #name      \
                  "' that does not fit the optional operation '" signature "'.");
        NESTGRID_OPTIONAL_OPERATIONS(NESTGRID_MUST_FIT)
#undef NESTGRID_MUST_FIT
        return true;
    }

    /// The names of the operations that the grid or field offers.
    static std::vector<std::string> names(const Model& model) {
        std::vector<std::string> result;
        const auto offers_now = [&](Feature feature) {
            if constexpr (DecidesAtRunTime<Model>) {
                return feature == no_feature || model.offers(feature);
            } else {
                return true;
            }
        };
#define NESTGRID_ADD_NAME(whose, feature, name, signature, Result, ...)                   \
    if (((whose)&who) != 0 && offers_##name<Model, __VA_ARGS__> && offers_now(feature)) { \
        result.emplace_back(#name);                                                       \
    }
        NESTGRID_OPTIONAL_OPERATIONS(NESTGRID_ADD_NAME)
#undef NESTGRID_ADD_NAME
        return result;
    }

private:
    using E = const ElementOf<Grid>&;
    using C = Context<Grid>;
    using Keys = std::span<NodeKey>;
    using Points = std::span<Point>;
    using Places = std::span<const Point>;
    using Parents = std::array<NodeKey, 2>;
    using Values = std::span<Real>;
};

template <class Grid>
using OperationsOfGrid = OptionalOperations<of_grid, Grid, Grid, double>;
template <class Field, class Grid>
using OperationsOfField = OptionalOperations<of_field, Field, Grid, typename Field::value_type>;

#undef NESTGRID_OPERATION
#undef NESTGRID_OPTIONAL_OPERATION
#undef NESTGRID_OPTIONAL_OPERATIONS

}  // namespace detail

/// Whether the class has the operation at all; a type-erased grid decides at run time.
template <class Grid>
constexpr bool may_offer(Feature feature) {
    return (detail::OperationsOfGrid<Grid>::features() & static_cast<unsigned>(feature)) != 0;
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

/// Whether this field tells the polynomials of leaves of the grid.
template <class Grid, class Field>
constexpr bool offers_polynomials(const Field& field) {
    using E = const ElementOf<Grid>&;
    using C = Context<Grid>;
    if constexpr (!detail::offers_degree<Field, C, E> ||
                  !detail::offers_evaluate<Field, C, E, std::span<const Point>,
                                           std::span<typename Field::value_type>>) {
        return false;
    } else if constexpr (detail::DecidesAtRunTime<Field>) {
        return field.offers(Feature::degree);
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

/// Says in English which optional operation of a grid or a field has a signature that the library
/// does not call; every algorithm asks.
template <class Grid, class Field>
consteval bool require_fitting_operations() {
    using E = const ElementOf<Grid>&;
    using C = Context<Grid>;
    static_assert(detail::offers_corner_keys<Grid, C, E, std::span<NodeKey>> ==
                      detail::offers_new_keys<Grid, C, E, std::span<NodeKey>>,
                  "A nested grid with keys of its own must define both 'corner_keys' and "
                  "'new_keys'; the library would ignore one alone.");
    static_assert(detail::offers_geometry_degree<Grid, C, E> ==
                      detail::offers_map<Grid, C, E, std::span<const Point>, std::span<Point>>,
                  "A nested grid with curved leaves must define both 'geometry_degree' and 'map'; "
                  "the library would ignore one alone.");
    static_assert(detail::offers_degree<Field, C, E> ==
                      detail::offers_evaluate<Field, C, E, std::span<const Point>,
                                              std::span<typename Field::value_type>>,
                  "A nodal field of higher degree must define both 'degree' and 'evaluate'; the "
                  "library would ignore one alone.");
    return detail::OperationsOfGrid<Grid>::all_fit() &&
           detail::OperationsOfField<Field, Grid>::all_fit();
}

/// The names of the optional operations and constants that the library finds in a grid, in the
/// order of optional.hpp.
template <class Grid>
std::vector<std::string> offered_operations(const Grid& grid) {
    auto names = detail::OperationsOfGrid<Grid>::names(grid);
    const auto add = [&](bool offered, const char* name) {
        if (offered) names.emplace_back(name);
    };
    add(
        requires { Grid::max_corners; }, "max_corners");
    add(
        requires { Grid::max_children; }, "max_children");
    add(
        requires { Grid::only_shape; }, "only_shape");
    return names;
}

/// Names of the optional operations and constants that a field on a grid offers.
template <class Grid, class Field>
std::vector<std::string> offered_field_operations(const Field& field) {
    return detail::OperationsOfField<Field, Grid>::names(field);
}

}  // namespace nestgrid
