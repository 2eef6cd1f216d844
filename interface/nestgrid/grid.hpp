// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The contract: what an adapter must answer about a nested grid (paper, section 1.2) and the data
// on it. Everything else is derived by the library.
//
// A grid is a class with
//     using Element = ...;                         a value, copied without heap
//     static constexpr int dimension = 2;          of the elements: 1, 2 or 3
//     std::size_t coarse_count() const;
//     CoarseElement<Element> coarse(std::size_t i) const;
//     const Rule* split(const Element& e) const;   nullptr on a leaf
//     void children(const Element& e, std::span<Element> out) const;
// An Element can be default-constructed. Rules live as long as the grid; `out` has one place for
// each child of the rule, in its order. A field on it is one with
//     using value_type = float or double;
//     static constexpr int components = 1;         optional
//     NodeMask coarse_values(std::size_t i, std::span<value_type> out) const;
//     NodeMask new_values(const Element& e, NodeMask which, std::span<value_type> out) const;
// Values are true values U, finest level first (section 1.2); component c of node n goes to
// out[n * components + c], n counting the corners of a coarse element or the new nodes of the rule
// of e. Only the nodes in `which` are asked for. The result holds the nodes that could not be
// given, for example because they live on another process.
//
// A field that is stored as differences from interpolants may ask for the values at the corners:
//     NodeMask new_values(const Element& e, NodeMask which, std::span<const value_type> corners,
//                         std::span<value_type> out) const;
// They are true values, or interpolants where a corner hangs. A new node that is not in `which` has
// the weighted mean of its parents.
//
// All operations are const and reentrant. A grid that needs state per task (a rebuilt entity, a
// cache) names it `Context`, offers `Context make_context() const`, and takes a `Context&` as an
// additional last argument of any operation it likes; so does its field.
// The optional operations are listed in optional.hpp.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include <nestgrid/rule.hpp>

namespace nestgrid {

/// An element of the coarse grid: the only place where an adapter gives coordinates and ids.
template <class Element>
struct CoarseElement {
    Element element{};
    Shape shape = Shape::point;
    std::array<Point, max_corners> corners{};
    /// Two elements share a node if and only if they give the same id. Periodic images and the two
    /// sides of a slit are different nodes.
    std::array<std::uint64_t, max_corners> ids{};
    std::int8_t orientation = 1;  ///< -1 where the corners are numbered as in a mirror
};

struct NoContext {};

namespace detail {

template <class Grid>
struct ContextOf {
    using type = NoContext;
};
template <class Grid>
    requires requires { typename Grid::Context; }
struct ContextOf<Grid> {
    using type = typename Grid::Context;
};

template <class Field>
constexpr int components_of() {
    if constexpr (requires { Field::components; }) {
        return Field::components;
    } else {
        return 1;
    }
}

template <class G>
concept HasElement = requires {
    typename G::Element;
}
&&std::copyable<typename G::Element>&& std::default_initializable<typename G::Element>;
template <class G>
concept HasDimension = requires {
    requires G::dimension >= 1 && G::dimension <= 3;
};
template <class G>
concept HasCoarseCount = requires(const G& g) {
    { g.coarse_count() } -> std::convertible_to<std::size_t>;
};
template <class G>
concept HasCoarse = HasElement<G> && requires(const G& g) {
    { g.coarse(std::size_t{}) } -> std::same_as<CoarseElement<typename G::Element>>;
};
template <class G>
concept HasSplit = HasElement<G> &&(
    requires(const G& g, const typename G::Element& e) {
        { g.split(e) } -> std::same_as<const Rule*>;
    } ||
    requires(const G& g, const typename G::Element& e, typename ContextOf<G>::type& c) {
        { g.split(e, c) } -> std::same_as<const Rule*>;
    });
template <class G>
concept HasChildren = HasElement<G> &&(
    requires(const G& g, const typename G::Element& e, std::span<typename G::Element> out) {
        g.children(e, out);
    } ||
    requires(const G& g, const typename G::Element& e, std::span<typename G::Element> out,
             typename ContextOf<G>::type& c) { g.children(e, out, c); });

template <class F>
concept HasValueType = requires {
    typename F::value_type;
}
&&(std::same_as<typename F::value_type, float> || std::same_as<typename F::value_type, double>);
template <class F, class G>
concept HasCoarseValues = HasValueType<F> &&(
    requires(const F& f, std::size_t i, std::span<typename F::value_type> out) {
        { f.coarse_values(i, out) } -> std::same_as<NodeMask>;
    } ||
    requires(const F& f, std::size_t i, std::span<typename F::value_type> out,
             typename ContextOf<G>::type& c) {
        { f.coarse_values(i, out, c) } -> std::same_as<NodeMask>;
    });
template <class F, class G>
concept HasNewValues = HasValueType<F> && HasElement<G> &&(
    requires(const F& f, const typename G::Element& e, NodeMask m,
             std::span<typename F::value_type> out) {
        { f.new_values(e, m, out) } -> std::same_as<NodeMask>;
    } ||
    requires(const F& f, const typename G::Element& e, NodeMask m,
             std::span<typename F::value_type> out, typename ContextOf<G>::type& c) {
        { f.new_values(e, m, out, c) } -> std::same_as<NodeMask>;
    });
template <class F, class G>
concept DecodesNewValues =
    HasValueType<F> && HasElement<G> && !HasNewValues<F, G> &&
    (
        requires(const F& f, const typename G::Element& e, NodeMask m,
                 std::span<const typename F::value_type> corners,
                 std::span<typename F::value_type> out) {
            { f.new_values(e, m, corners, out) } -> std::same_as<NodeMask>;
        } ||
        requires(const F& f, const typename G::Element& e, NodeMask m,
                 std::span<const typename F::value_type> corners,
                 std::span<typename F::value_type> out, typename ContextOf<G>::type& c) {
            { f.new_values(e, m, corners, out, c) } -> std::same_as<NodeMask>;
        });

}  // namespace detail

template <class G>
concept NestedGrid =
    detail::HasElement<G> && detail::HasDimension<G> && detail::HasCoarseCount<G> &&
    detail::HasCoarse<G> && detail::HasSplit<G> && detail::HasChildren<G>;

template <class F, class G>
concept NodalField = detail::HasValueType<F> && detail::HasCoarseValues<F, G> &&
    (detail::HasNewValues<F, G> || detail::DecodesNewValues<F, G>);

/// Says in English what a class lacks to be a nested grid; every algorithm asks.
template <class G>
consteval bool require_nested_grid() {
    static_assert(detail::HasElement<G>,
                  "A nested grid must define a type 'Element' that can be copied and "
                  "default-constructed.");
    static_assert(detail::HasDimension<G>,
                  "A nested grid must define 'static constexpr int dimension', 1, 2 or 3.");
    static_assert(detail::HasCoarseCount<G>,
                  "A nested grid must define 'std::size_t coarse_count() const'.");
    static_assert(detail::HasCoarse<G>,
                  "A nested grid must define 'CoarseElement<Element> coarse(std::size_t) const'.");
    static_assert(detail::HasSplit<G>,
                  "A nested grid must define 'const Rule* split(const Element&) const'.");
    static_assert(detail::HasChildren<G>,
                  "A nested grid must define 'void children(const Element&, std::span<Element> "
                  "out) const'.");
    return NestedGrid<G>;
}

/// Says in English what a class lacks to be a nodal field on the grid G.
template <class F, class G>
consteval bool require_nodal_field() {
    static_assert(detail::HasValueType<F>,
                  "A nodal field must define 'value_type' as float or double.");
    static_assert(detail::HasCoarseValues<F, G>,
                  "A nodal field must define 'NodeMask coarse_values(std::size_t, "
                  "std::span<value_type> out) const'.");
    static_assert(detail::HasNewValues<F, G> || detail::DecodesNewValues<F, G>,
                  "A nodal field must define 'NodeMask new_values(const Element&, NodeMask which, "
                  "std::span<value_type> out) const'.");
    return NodalField<F, G>;
}

}  // namespace nestgrid
