// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Projection criteria S (paper, sections 2, 4 and 5.1): values that compose.
//
// Conjunctions and disjunctions of saturated criteria are saturated: where both hold at a corner,
// both hold at the new nodes, and likewise where one of them does.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include <nestgrid/keys.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// The new nodes of one split, as a criterion sees them.
struct NewNodes {
    const Rule& rule;
    std::span<const NodeKey> keys;
    int level;                           ///< of the nodes: one more than that of the element
    NodeMask outside;                    ///< nodes at which no element may stop
    std::span<const Point> positions{};  ///< the true ones, where the criterion wants them
};

class Threshold;

/// S, a function of nodes: 0 or 1, or a weight between (section 6).
class Criterion {
public:
    virtual ~Criterion() = default;
    /// The new nodes at which S holds, that is where it is 1, one bit each.
    virtual NodeMask holds(const NewNodes& nodes) const = 0;
    /// Whether S has values between 0 and 1.
    virtual bool blends() const { return false; }
    /// S at each new node, in [0, 1], and 1 where holds() says so and nowhere else.
    virtual void weights(const NewNodes& nodes, std::span<float> s) const {
        const NodeMask mask = holds(nodes);
        for (std::size_t n = 0; n < s.size(); ++n) s[n] = static_cast<float>(mask >> n & 1U);
    }
    /// Whether the criterion looks at NewNodes::positions.
    virtual bool wants_positions() const { return false; }
    /// Whether S > 0 at any corner of a split element implies S = 1 at all its new nodes.
    /// Algorithms refuse a criterion that is not saturated, unless it insists; elements with such a
    /// corner stop without asking one that is.
    virtual bool saturated() const = 0;
    /// Whether S is a function of nodes only where the grid creates each node on one level.
    virtual bool needs_one_level_a_node() const { return false; }
    /// Whether the criterion is to be used although it is not saturated. Then the surface may have
    /// open edges and lack parts, and no bound is given.
    virtual bool insists() const { return false; }
    /// Whether this is of the grid in the state of this epoch: false where an indicator that the
    /// criterion asks was computed in another one. Algorithms refuse such a criterion.
    virtual bool made_for(std::uint64_t /*epoch*/) const { return true; }
    /// What Isosurface::surface_error is at most, for each of these isovalues, but for the flatness
    /// of triangles in leaves; infinity where the criterion promises nothing.
    virtual double surface_error(std::span<const double> /*isovalues*/) const {
        return std::numeric_limits<double>::infinity();
    }
    /// Whether S is 0 at every node, so that nothing is to be asked.
    virtual bool never_holds() const { return false; }
    /// This criterion as a plain threshold, which walks compare with many numbers at once; null
    /// where it is anything else.
    virtual const Threshold* as_threshold() const { return nullptr; }

protected:
    Criterion() = default;
    Criterion(const Criterion&) = default;
    Criterion& operator=(const Criterion&) = default;
    Criterion(Criterion&&) noexcept = default;
    Criterion& operator=(Criterion&&) noexcept = default;
};

/// How eta is handed from a node y to the nodes x that y depends on:
///     eta(x) >= factor * (eta(y) + slope * |x - y|).
struct Spread {
    /// At least 1: for criteria that blend between epsilon and factor * epsilon (Blended).
    double factor = 1;
    /// At least 0: for thresholds that vary in space with that slope at most (Lens).
    double slope = 0;
};

/// A number eta for every node, to be compared with a threshold.
class Indicator {
public:
    virtual ~Indicator() = default;
    /// eta of a node, in the units of the threshold.
    virtual double stop(NodeKey node) const = 0;
    /// Whether eta at every corner of a split element is at least eta at all its new nodes.
    virtual bool saturated() const { return true; }
    /// How eta spreads from the new nodes of a split element to its corners, where it is saturated.
    virtual Spread spread() const { return {}; }
    /// At a threshold below this no element stops.
    virtual double least_stop() const { return 0; }
    /// Whether this is of the grid in the state of this epoch. One that keeps numbers of nodes says
    /// whether they were computed then.
    virtual bool made_for(std::uint64_t /*epoch*/) const { return true; }
    /// The new nodes of a split with eta <= epsilon, one bit each.
    virtual NodeMask stops_at_most(const Rule& /*rule*/, std::span<const NodeKey> keys,
                                   double epsilon) const {
        NodeMask mask = 0;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (stop(keys[i]) <= epsilon) mask |= NodeMask{1} << i;
        }
        return mask;
    }
    /// The same promise as Criterion::surface_error, of elements that stop where eta <= epsilon.
    virtual double surface_error(std::span<const double> /*isovalues*/, double /*epsilon*/) const {
        return std::numeric_limits<double>::infinity();
    }

protected:
    Indicator() = default;
    Indicator(const Indicator&) = default;
    Indicator& operator=(const Indicator&) = default;
    Indicator(Indicator&&) noexcept = default;
    Indicator& operator=(Indicator&&) noexcept = default;
};

namespace detail {

/// The greatest eta of some nodes.
inline double greatest_eta(const Indicator& indicator, std::span<const NodeKey> nodes) {
    double greatest = 0;
    for (const NodeKey node : nodes) greatest = std::max(greatest, indicator.stop(node));
    return greatest;
}

}  // namespace detail

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
    bool made_for(std::uint64_t epoch) const override { return indicator_->made_for(epoch); }
    double surface_error(std::span<const double> isovalues) const override {
        return indicator_->surface_error(isovalues, epsilon_);
    }
    const Threshold* as_threshold() const override { return this; }

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
    double surface_error(std::span<const double>) const override { return 0; }
    bool never_holds() const override { return true; }
};

/// Any criterion as a value; copies share it.
class AnyCriterion final : public Criterion {
public:
    template <std::derived_from<Criterion> S>
        requires(!std::same_as<S, AnyCriterion>)
    AnyCriterion(S criterion) : criterion_{std::make_shared<const S>(std::move(criterion))} {}
    /// \param criterion not null
    explicit AnyCriterion(std::shared_ptr<const Criterion> criterion)
        : criterion_{std::move(criterion)} {}

    NodeMask holds(const NewNodes& nodes) const override { return criterion_->holds(nodes); }
    bool blends() const override { return criterion_->blends(); }
    void weights(const NewNodes& nodes, std::span<float> s) const override {
        criterion_->weights(nodes, s);
    }
    bool wants_positions() const override { return criterion_->wants_positions(); }
    bool saturated() const override { return criterion_->saturated(); }
    bool needs_one_level_a_node() const override { return criterion_->needs_one_level_a_node(); }
    bool insists() const override { return criterion_->insists(); }
    bool made_for(std::uint64_t epoch) const override { return criterion_->made_for(epoch); }
    double surface_error(std::span<const double> isovalues) const override {
        return criterion_->surface_error(isovalues);
    }
    bool never_holds() const override { return criterion_->never_holds(); }
    const Threshold* as_threshold() const override { return criterion_->as_threshold(); }

private:
    std::shared_ptr<const Criterion> criterion_;
};

namespace detail {

/// What a conjunction and a disjunction have in common.
template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
class TwoCriteria : public Criterion {
public:
    bool blends() const override { return a_.blends() || b_.blends(); }
    bool wants_positions() const override { return a_.wants_positions() || b_.wants_positions(); }
    bool saturated() const override { return a_.saturated() && b_.saturated(); }
    bool needs_one_level_a_node() const override {
        return a_.needs_one_level_a_node() || b_.needs_one_level_a_node();
    }
    bool insists() const override { return a_.insists() || b_.insists(); }
    bool made_for(std::uint64_t epoch) const override {
        return a_.made_for(epoch) && b_.made_for(epoch);
    }

protected:
    TwoCriteria(A a, B b) : a_{std::move(a)}, b_{std::move(b)} {}

    /// Puts choose(S of a, S of b) into s.
    template <class Choose>
    void combine(const NewNodes& nodes, std::span<float> s, Choose&& choose) const {
        std::array<float, max_new_nodes> of_b;
        a_.weights(nodes, s);
        b_.weights(nodes, std::span(of_b).first(s.size()));
        for (std::size_t n = 0; n < s.size(); ++n) s[n] = choose(s[n], of_b[n]);
    }

    A a_;
    B b_;
};

}  // namespace detail

/// S_a and S_b: the least of their weights.
template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
class Both final : public detail::TwoCriteria<A, B> {
public:
    Both(const A& a, const B& b) : detail::TwoCriteria<A, B>(a, b) {}
    NodeMask holds(const NewNodes& nodes) const override {
        const NodeMask first = this->a_.holds(nodes);
        return first == 0 ? first : first & this->b_.holds(nodes);
    }
    void weights(const NewNodes& nodes, std::span<float> s) const override {
        this->combine(nodes, s, [](float a, float b) { return std::min(a, b); });
    }
    double surface_error(std::span<const double> isovalues) const override {
        return std::min(this->a_.surface_error(isovalues), this->b_.surface_error(isovalues));
    }
    bool never_holds() const override { return this->a_.never_holds() || this->b_.never_holds(); }
};

/// S_a or S_b: the greatest of their weights.
template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
class Either final : public detail::TwoCriteria<A, B> {
public:
    Either(const A& a, const B& b) : detail::TwoCriteria<A, B>(a, b) {}
    NodeMask holds(const NewNodes& nodes) const override {
        return this->a_.holds(nodes) | this->b_.holds(nodes);
    }
    void weights(const NewNodes& nodes, std::span<float> s) const override {
        this->combine(nodes, s, [](float a, float b) { return std::max(a, b); });
    }
    bool never_holds() const override { return this->a_.never_holds() && this->b_.never_holds(); }
};

/// Insists on a criterion that is not saturated.
template <std::derived_from<Criterion> S>
class Unsaturated final : public Criterion {
public:
    explicit Unsaturated(S criterion) : criterion_{std::move(criterion)} {}
    NodeMask holds(const NewNodes& nodes) const override { return criterion_.holds(nodes); }
    bool blends() const override { return criterion_.blends(); }
    void weights(const NewNodes& nodes, std::span<float> s) const override {
        criterion_.weights(nodes, s);
    }
    bool wants_positions() const override { return criterion_.wants_positions(); }
    bool saturated() const override { return false; }
    bool insists() const override { return true; }
    bool made_for(std::uint64_t epoch) const override { return criterion_.made_for(epoch); }

private:
    S criterion_;
};

/// A node is interpolated where both criteria hold.
template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
Both<A, B> operator&&(const A& a, const B& b) {
    return {a, b};
}

/// A node is interpolated where one of the criteria holds.
template <std::derived_from<Criterion> A, std::derived_from<Criterion> B>
Either<A, B> operator||(const A& a, const B& b) {
    return {a, b};
}

}  // namespace nestgrid
