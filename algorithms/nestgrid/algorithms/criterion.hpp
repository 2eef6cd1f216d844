// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Projection criteria S (paper, sections 2, 4 and 5.1): values that compose.
//
// A criterion answers, for the new nodes of one split, at which of them S holds:
//     NodeMask operator()(const NewNodes& nodes) const;
//     static constexpr bool saturated = ...;
// Conjunctions and disjunctions of saturated criteria are saturated: where both hold at a corner,
// both hold at the new nodes, and likewise where one of them does.
#pragma once

#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/pack.hpp>
#include <nestgrid/traversal.hpp>

namespace nestgrid {

/// The new nodes of one split, as a criterion sees them.
struct NewNodes {
    const Rule& rule;
    std::span<const NodeKey> keys;
    int level;         ///< of the nodes: one more than that of the element
    NodeMask outside;  ///< nodes at which no element may stop
};

template <class C>
concept Criterion = requires(const C& c, const NewNodes& nodes) {
    { c(nodes) } -> std::same_as<NodeMask>;
    { C::saturated } -> std::convertible_to<bool>;
};

/// S(x) = (eta(x) <= epsilon) for an indicator that stores eta by node.
template <class Indicator>
struct Threshold {
    static constexpr bool saturated = Indicator::saturated;

    const Indicator* indicator;
    double epsilon;

    NESTGRID_INLINE NodeMask operator()(const NewNodes& nodes) const {
        if constexpr (requires { indicator->largest_stop(nodes.rule, nodes.keys); }) {
            if (indicator->largest_stop(nodes.rule, nodes.keys) <= epsilon) {
                return nodes.rule.all() & ~nodes.outside;
            }
        }
        if constexpr (requires { indicator->stops_at_most(nodes.keys, epsilon); }) {
            return indicator->stops_at_most(nodes.keys, epsilon) & ~nodes.outside;
        }
        NodeMask mask = 0;
        for (std::size_t i = 0; i < nodes.keys.size(); ++i) {
            if (indicator->stop(nodes.keys[i]) <= epsilon) mask |= NodeMask{1} << i;
        }
        return mask & ~nodes.outside;
    }
    /// The same of eight nodes.
    struct Packed {
        const Indicator* indicator;
        Pack<float> epsilon;

        /// At which of them, none of them outside.
        /// \param known what `by` knows of them
        template <class Known>
            requires std::same_as<decltype(std::declval<Known>().stop()), Pack<float>>
        NESTGRID_INLINE Pack<std::uint32_t> holds(const NodeKey* nodes, const Indicator& by,
                                                  const Known& known) const {
            return at_most(indicator == &by ? known.stop() : indicator->look_up(nodes).stop(),
                           epsilon);
        }
    };
    Packed packed() const { return {indicator, Pack<float>::all(float_below(epsilon))}; }
};

/// S(x) = (level of x > deepest), section 4. Saturated, because no node is created below a
/// deeper one, wherever each node is created on one level only; combine it with a Threshold on
/// grids that have nodes outside the domain.
struct DeepestLevel {
    static constexpr bool saturated = true;

    int deepest;

    NESTGRID_INLINE NodeMask operator()(const NewNodes& nodes) const {
        return nodes.level > deepest ? nodes.rule.all() & ~nodes.outside : NodeMask{0};
    }
};

/// S false everywhere: the projection is the identity.
struct Exact {
    static constexpr bool saturated = true;
    NESTGRID_INLINE NodeMask operator()(const NewNodes&) const { return 0; }
};

template <Criterion A, Criterion B>
struct Both {
    static constexpr bool saturated = A::saturated && B::saturated;
    A a;
    B b;
    NESTGRID_INLINE NodeMask operator()(const NewNodes& nodes) const {
        const NodeMask first = a(nodes);
        return first == 0 ? first : first & b(nodes);
    }
};

template <Criterion A, Criterion B>
struct Either {
    static constexpr bool saturated = A::saturated && B::saturated;
    A a;
    B b;
    NESTGRID_INLINE NodeMask operator()(const NewNodes& nodes) const { return a(nodes) | b(nodes); }
};

template <Criterion A, Criterion B>
Both<A, B> operator&&(const A& a, const B& b) {
    return {a, b};
}

template <Criterion A, Criterion B>
Either<A, B> operator||(const A& a, const B& b) {
    return {a, b};
}

namespace detail {

/// A criterion that is asked for eight nodes at once, where it can be.
template <class S>
auto packed_criterion(const S& criterion) {
    if constexpr (requires { criterion.packed(); }) {
        return criterion.packed();
    } else {
        return Nothing{};
    }
}

}  // namespace detail

}  // namespace nestgrid
