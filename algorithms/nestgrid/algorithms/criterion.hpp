// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Projection criteria S (paper, sections 2, 4 and 5.1): values that compose.
//
// Conjunctions and disjunctions of saturated criteria are saturated: where both hold at a corner,
// both hold at the new nodes, and likewise where one of them does.
#pragma once

#include <concepts>
#include <span>

#include <nestgrid/keys.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// The new nodes of one split, as a criterion sees them.
struct NewNodes {
    const Rule& rule;
    std::span<const NodeKey> keys;
    int level;         ///< of the nodes: one more than that of the element
    NodeMask outside;  ///< nodes at which no element may stop
};

/// S, a function of nodes.
class Criterion {
public:
    virtual ~Criterion() = default;
    /// The new nodes at which S holds, one bit each.
    virtual NodeMask holds(const NewNodes& nodes) const = 0;
    /// Whether S at any corner of a split element implies S at all its new nodes. Algorithms refuse
    /// a criterion that is not, unless it insists.
    virtual bool saturated() const = 0;
    /// Whether S is a function of nodes only where the grid creates each node on one level.
    virtual bool needs_one_level_a_node() const { return false; }
    /// Whether the criterion is to be used although it is not saturated. Then the surface may have
    /// open edges and lack parts, and no bound is given.
    virtual bool insists() const { return false; }

protected:
    Criterion() = default;
    Criterion(const Criterion&) = default;
    Criterion& operator=(const Criterion&) = default;
    Criterion(Criterion&&) = default;
    Criterion& operator=(Criterion&&) = default;
};

/// A number eta for every node, to be compared with a threshold.
class Indicator {
public:
    virtual ~Indicator() = default;
    /// eta of a node, in the units of the threshold.
    virtual double stop(NodeKey node) const = 0;
    /// Whether eta at every corner of a split element is at least eta at all its new nodes.
    virtual bool saturated() const { return true; }
    /// The new nodes of a split with eta <= epsilon, one bit each.
    virtual NodeMask stops_at_most(const Rule& /*rule*/, std::span<const NodeKey> keys,
                                   double epsilon) const {
        NodeMask mask = 0;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (stop(keys[i]) <= epsilon) mask |= NodeMask{1} << i;
        }
        return mask;
    }

protected:
    Indicator() = default;
    Indicator(const Indicator&) = default;
    Indicator& operator=(const Indicator&) = default;
    Indicator(Indicator&&) = default;
    Indicator& operator=(Indicator&&) = default;
};

/// S(x) = (eta(x) <= epsilon). The indicator must outlive the criterion.
class Threshold final : public Criterion {
public:
    Threshold(const Indicator* indicator, double epsilon)
        : indicator_{indicator}, epsilon_{epsilon} {}

    const Indicator* indicator() const { return indicator_; }
    double epsilon() const { return epsilon_; }
    NodeMask holds(const NewNodes& nodes) const override {
        return indicator_->stops_at_most(nodes.rule, nodes.keys, epsilon_) & ~nodes.outside;
    }
    bool saturated() const override { return indicator_->saturated(); }

private:
    const Indicator* indicator_;
    double epsilon_;
};

/// S(x) = (level of x > deepest), section 4. Saturated, because no node is created below a
/// deeper one, wherever each node is created on one level only; for other grids take
/// NodeLevels::deeper_than (node_levels.hpp). Combine it with a Threshold on grids that have nodes
/// outside the domain.
class DeepestLevel final : public Criterion {
public:
    explicit DeepestLevel(int deepest) : deepest_{deepest} {}
    NodeMask holds(const NewNodes& nodes) const override {
        return nodes.level > deepest_ ? nodes.rule.all() & ~nodes.outside : NodeMask{0};
    }
    bool saturated() const override { return true; }
    bool needs_one_level_a_node() const override { return true; }

private:
    int deepest_;
};

/// S false everywhere: the projection is the identity.
class Exact final : public Criterion {
public:
    NodeMask holds(const NewNodes&) const override { return 0; }
    bool saturated() const override { return true; }
};

template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
class Both final : public Criterion {
public:
    Both(const A& a, const B& b) : a_{a}, b_{b} {}
    NodeMask holds(const NewNodes& nodes) const override {
        const NodeMask first = a_.holds(nodes);
        return first == 0 ? first : first & b_.holds(nodes);
    }
    bool saturated() const override { return a_.saturated() && b_.saturated(); }
    bool needs_one_level_a_node() const override {
        return a_.needs_one_level_a_node() || b_.needs_one_level_a_node();
    }
    bool insists() const override { return a_.insists() || b_.insists(); }

private:
    A a_;
    B b_;
};

template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
class Either final : public Criterion {
public:
    Either(const A& a, const B& b) : a_{a}, b_{b} {}
    NodeMask holds(const NewNodes& nodes) const override {
        return a_.holds(nodes) | b_.holds(nodes);
    }
    bool saturated() const override { return a_.saturated() && b_.saturated(); }
    bool needs_one_level_a_node() const override {
        return a_.needs_one_level_a_node() || b_.needs_one_level_a_node();
    }
    bool insists() const override { return a_.insists() || b_.insists(); }

private:
    A a_;
    B b_;
};

/// Insists on a criterion that is not saturated.
template <std::derived_from<Criterion> S>
class Unsaturated final : public Criterion {
public:
    explicit Unsaturated(const S& criterion) : criterion_{criterion} {}
    NodeMask holds(const NewNodes& nodes) const override { return criterion_.holds(nodes); }
    bool saturated() const override { return false; }
    bool insists() const override { return true; }

private:
    S criterion_;
};

template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
Both<A, B> operator&&(const A& a, const B& b) {
    return {a, b};
}

template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
Either<A, B> operator||(const A& a, const B& b) {
    return {a, b};
}

}  // namespace nestgrid
