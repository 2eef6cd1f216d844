// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/sweeps.hpp>

#include <indicators/spread.hpp>

namespace nestgrid::engine {

void Sweeps::leaf(std::span<const NodeKey> corners, float error) {
    for (const std::size_t at : numbers(corners)) {
        std::uint16_t& stop = nodes_[at].entry.stop;
        stop = std::max(stop, detail::bfloat16_above(error));
    }
}

void Sweeps::deviation(const Deviation& d) {
    const Entry entry{detail::bfloat16_above(detail::float_above(d.stop)),
                      detail::bfloat16_above(detail::float_above(d.deviation))};
    for (const std::size_t at : numbers(d.made)) {
        Entry& of = nodes_[at].entry;
        of.stop = std::max(of.stop, entry.stop);
        of.bound = std::max(of.bound, entry.bound);
    }
}

void Sweeps::raise(NodeKey key, const Entry& known) {
    Node& node = nodes_[numbers({&key, 1}).front()];
    node.entry.stop = std::max(node.entry.stop, known.stop);
    node.finer = std::max(node.finer, known.bound);
}

void Sweeps::sweep_all() {
    least_stop_ = detail::bfloat16_infinity;
    sweep(splits_, one_level_ && one_step_,
          [&](const Rule& rule, std::span<const std::size_t> of, float reach) {
              return sweep_split(rule, of, reach);
          });
}

/// Raises shared nodes to the greatest numbers that any rank has for them. The deviation of an
/// element that several ranks have is the greatest at the nodes that any of them has in it.
/// \return whether some rank was told more than it knew
bool Sweeps::raise_across(const SharedNodes& shared) {
    const auto at = [&](NodeKey key) -> Node& { return nodes_[numbers({&key, 1}).front()]; };
    const auto bound = [&](Node& node) -> std::uint16_t& {
        return made_of_ == MadeOf::deviations ? node.entry.bound : node.finer;
    };
    using Told = std::array<std::uint16_t, 2>;
    return shared.raise<Told>(
        [&](NodeKey key) {
            Node& node = at(key);
            return Told{node.entry.stop, bound(node)};
        },
        [&](NodeKey key, const Told& told) {
            Node& node = at(key);
            const bool raises = node.entry.stop < told[0] || bound(node) < told[1];
            node.entry.stop = std::max(node.entry.stop, told[0]);
            bound(node) = std::max(bound(node), told[1]);
            return raises;
        });
}

/// The numbers are the least fixed point of maxima that only grow, whatever the order in which
/// ranks sweep.
void Sweeps::saturate(const SharedNodes* shared) {
    sweep_all();
    while (shared != nullptr && raise_across(*shared)) sweep_all();
    if (made_of_ == MadeOf::deviations) return;
    for (Node& node : nodes_) node.entry.bound = std::max(node.entry.bound, node.bound());
}

/// \param of numbers of the corners and, behind them, of the new nodes
/// \return whether anything has changed
inline bool Sweeps::sweep_split(const Rule& rule, std::span<const std::size_t> of, float reach) {
    const auto hand = [&](const HandedOn& b) {
        return HandedOn{hand_on(spread_, b.stop, reach), b.bound};
    };
    const bool sums = made_of_ != MadeOf::deviations;
    const auto of_node = [&](std::size_t node) {
        return HandedOn{nodes_[node].entry.stop, sums ? nodes_[node].bound() : std::uint16_t{0}};
    };
    const auto raise = [&](std::size_t node, const HandedOn& to) {
        Node& at = nodes_[node];
        const bool changed = at.entry.stop < to.stop || at.finer < to.bound;
        at.entry.stop = std::max(at.entry.stop, to.stop);
        at.finer = std::max(at.finer, to.bound);
        return changed;
    };
    HandedOn greatest;
    bool changed = raise_parents(rule, of, of_node, hand, raise, greatest);
    if (!rule.new_nodes.empty()) least_stop_ = std::min(least_stop_, greatest.stop);
    if (rule.inside != no_new_node) {
        Entry& within =
            nodes_[of[static_cast<std::size_t>(rule.corner_count()) + rule.inside]].entry;
        // It may have parents in the same split, to which it hands the greatest number on.
        changed |= rule.steps > 1 && within.stop < greatest.stop;
        within.stop = std::max(within.stop, greatest.stop);
        within.bound = std::max(within.bound, greatest.bound);
    }
    return changed;
}

void Sweeps::store(detail::IndicatorEntries& entries) const {
    if (number_of_.are_keys()) {
        entries.dense = std::make_unique_for_overwrite<Entry[]>(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) entries.dense[i] = nodes_[i].entry;
        return;
    }
    entries.sparse.reserve(nodes_.size());
    for_each([&](NodeKey node, const Entry& entry) { entries.sparse.insert(node, entry); });
}

}  // namespace nestgrid::engine
