// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The walk of a preroll over any hierarchy: tells of every split, by one thread or several.
// Several threads walk parts of the hierarchy and log what they meet; the logs are repeated one
// after the other, beside the walks that go on. Included by indicator.hpp.
#pragma once

#include <array>
#include <bit>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/frontier.hpp>
#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/traversal.hpp>

namespace nestgrid::detail {

/// One split as a preroll meets it.
struct MetSplit {
    const Rule* rule;
    int level;
    NodeMask outside;               ///< see the operation `outside`
    std::span<const NodeKey> keys;  ///< of the corners and the new nodes behind them
};

/// What a preroll learns beside the numbers of nodes. All of it is a least or a greatest, so that
/// the order does not count.
struct PrerollFacts {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();
    double hanging_violation = 0;
    std::size_t largest_split = 0;  ///< number of new nodes
    int finest_level = 0;
    bool all_divided = true;  ///< every rule divides all edges and faces

    void add(const PrerollFacts& other) {
        least = std::min(least, other.least);
        greatest = std::max(greatest, other.greatest);
        if (!(other.hanging_violation <= hanging_violation)) {
            hanging_violation = other.hanging_violation;
        }
        largest_split = std::max(largest_split, other.largest_split);
        finest_level = std::max(finest_level, other.finest_level);
        all_divided = all_divided && other.all_divided;
    }

    /// \throw InvalidInput where it is not a number, infinite, or beyond the limit
    void add_value(double value, double limit) {
        if (!(std::abs(value) <= limit)) {
            throw InvalidInput("a value of the field is not a usable number: " +
                               std::to_string(value));
        }
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
};

/// |U - sum omega U| at a new node, rounded up.
inline float offset_above(double value, double mean) {
    return float_above(distance_above(value, mean));
}
inline float offset_above(float value, float mean) { return distance_above(value, mean); }

/// What a part of the walk has met, to be told again.
class PrerollLog {
public:
    template <class Offset>
    void split(const MetSplit& s, Offset&& offset) {
        items_.push_back({s.rule, s.level, s.outside, s.keys.size()});
        keys_.insert(keys_.end(), s.keys.begin(), s.keys.end());
        for (std::size_t n = 0; n < s.rule->new_nodes.size(); ++n) numbers_.push_back(offset(n));
    }
    void leaf(std::span<const NodeKey> corners, float error) {
        items_.push_back({nullptr, 0, 0, corners.size()});
        keys_.insert(keys_.end(), corners.begin(), corners.end());
        numbers_.push_back(error);
    }

    template <class Receiver>
    void repeat(Receiver& receiver) const {
        std::span<const NodeKey> keys(keys_);
        std::span<const float> numbers(numbers_);
        for (const Item& i : items_) {
            const auto of = keys.first(i.keys);
            keys = keys.subspan(i.keys);
            if (i.rule == nullptr) {
                receiver.leaf(of, numbers.front());
                numbers = numbers.subspan(1);
            } else {
                receiver.split({i.rule, i.level, i.outside, of},
                               [&](std::size_t n) { return numbers[n]; });
                numbers = numbers.subspan(i.rule->new_nodes.size());
            }
        }
    }

    void clear() { *this = {}; }

private:
    struct Item {
        const Rule* rule;
        int level;
        NodeMask outside;
        std::size_t keys;
    };
    std::vector<Item> items_;
    std::vector<NodeKey> keys_;
    std::vector<float> numbers_;  // offsets of new nodes, errors of leaves
};

/// Walks everything and tells of it:
///     receiver.split(const MetSplit&, offset)   offset(n) is |U_delta| of new node n, rounded up,
///                                               0 where it hangs
///     receiver.leaf(keys of corners, error)     where leaves have errors; else coarse ones, with 0
template <class Walk, class LeafError, class Receiver>
class PrerollVisitor {
public:
    using State = typename Walk::State;
    using Real = typename Walk::Real;
    static constexpr bool of_leaves = !std::is_same_v<LeafError, Nothing>;

    PrerollVisitor(const Walk& walk, const LeafError& leaf_error, Receiver& receiver)
        : walk_{&walk}, leaf_error_{&leaf_error}, receiver_{&receiver} {}

    const PrerollFacts& facts() const { return facts_; }

    bool passes_over_leaves() const { return !of_leaves; }
    bool sees_hidden() const { return true; }

    Decision inspect(const State& s, const Split& split) {
        if (s.level == 0) {
            for (std::size_t i = 0; i < static_cast<std::size_t>(s.corner_count()); ++i) {
                facts_.add_value(static_cast<double>(s.value[i * State::components]), limit_);
            }
        }
        if constexpr (of_leaves) {
            if (split.rule == nullptr) {
                const double error = (*leaf_error_)(s.element);
                if (!(error >= 0)) {
                    throw InvalidInput("the error of a leaf is not a usable number: " +
                                       std::to_string(error));
                }
                receiver_->leaf(corner_keys(s), float_above(error));
            }
        } else if (split.rule == nullptr && s.level == 0) {
            receiver_->leaf(corner_keys(s), 0);  // its nodes count, too
        }
        return {};
    }

    /// \param value at the corners and the new nodes behind them
    void made(const State& s, const Split& split, std::span<const Real> value) {
        constexpr std::size_t stride = State::components;
        const Rule& rule = *split.rule;
        const std::size_t corners = corner_keys(s).size();
        facts_.largest_split = std::max(facts_.largest_split, rule.new_nodes.size());
        facts_.all_divided = facts_.all_divided && rule.divides_all;
        facts_.finest_level = std::max(facts_.finest_level, s.level + 1);
        if ((split.constrained & rule.all()) != 0) compare_hanging(s, split, value);
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            if ((split.constrained >> n & 1U) != 0) continue;
            facts_.add_value(static_cast<double>(value[(corners + n) * stride]), limit_);
        }
        std::copy(split.keys.begin(), split.keys.end(),
                  keys_.begin() + static_cast<std::ptrdiff_t>(corners));
        receiver_->split({split.rule, s.level, split.outside,
                          std::span<const NodeKey>(keys_).first(corners + split.keys.size())},
                         [&](std::size_t n) {
                             if ((split.constrained >> n & 1U) != 0) return 0.0F;
                             const Real mean = interpolate(rule.new_nodes[n], value.data(), stride);
                             return offset_above(value[(corners + n) * stride], mean);
                         });
    }

    void extract(const State&) {}

    // What a Frontier asks for.
    Decision look(const State&, const Split&) const { return {}; }
    void undo() {}
    void restart() { receiver_->clear(); }

private:
    static constexpr double limit_ = static_cast<double>(std::numeric_limits<Real>::max() / 8);

    std::span<const NodeKey> corner_keys(const State& s) {
        walk_->keys(s, keys_);
        return std::span(keys_).first(static_cast<std::size_t>(s.corner_count()));
    }

    /// What the field says at nodes that hang, where it says anything, with what is used.
    void compare_hanging(const State& s, const Split& split, std::span<const Real> value) {
        constexpr std::size_t stride = State::components;
        const std::size_t count = split.rule->new_nodes.size();
        const std::size_t corners = value.size() / stride - count;
        const NodeMask hanging = split.constrained & split.rule->all();
        std::array<Real, max_new_nodes * stride> given;
        const NodeMask missing = call_new_values(walk_->field(), *s.context, s.element, hanging,
                                                 std::span<Real>(given.data(), count * stride));
        for (NodeMask left = hanging & ~missing; left != 0; left &= left - 1) {
            const auto n = static_cast<std::size_t>(std::countr_zero(left));
            const double off = std::abs(static_cast<double>(given[n * stride]) -
                                        static_cast<double>(value[(corners + n) * stride]));
            if (!(off <= facts_.hanging_violation)) facts_.hanging_violation = off;
        }
    }

    const Walk* walk_;
    const LeafError* leaf_error_;
    Receiver* receiver_;
    PrerollFacts facts_;
    std::array<NodeKey, max_corners + max_new_nodes> keys_;
};

/// Shows a whole hierarchy to a receiver, as PrerollVisitor.
template <class Walk, class LeafError, class Receiver, class E>
PrerollFacts walk_preroll(const Walk& walk, const LeafError& leaf_error, Receiver& receiver,
                          const E& executor) {
    if constexpr (!std::is_same_v<E, SequentialExecutor>) {
        if (executor.concurrency() > 1) {
            struct Part {
                PrerollLog log;
                PrerollFacts facts;
            };
            using Visitor = PrerollVisitor<Walk, LeafError, PrerollLog>;
            PrerollLog above;
            Visitor visitor(walk, leaf_error, above);
            const std::size_t wanted = 64 * executor.concurrency();  // short logs
            const Frontier frontier(walk, visitor, wanted);
            above.repeat(receiver);
            PrerollFacts facts = visitor.facts();
            const std::size_t entries = frontier.entry_count();
            const std::size_t parts = std::min(entries, wanted);
            executor.run(
                parts,
                [&](std::size_t i) {
                    Part part;
                    Visitor below(walk, leaf_error, part.log);
                    frontier.run(walk, i * entries / parts, (i + 1) * entries / parts, below);
                    part.facts = below.facts();
                    return part;
                },
                [&](std::size_t, const Part& part) {
                    part.log.repeat(receiver);
                    facts.add(part.facts);
                });
            return facts;
        }
    }
    PrerollVisitor<Walk, LeafError, Receiver> visitor(walk, leaf_error, receiver);
    walk.run(visitor);
    return visitor.facts();
}

}  // namespace nestgrid::detail
