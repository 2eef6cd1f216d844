// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/indicator.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include <indicators/lattice_deviations.hpp>
#include <indicators/preroll.hpp>
#include <indicators/spread.hpp>
#include <indicators/stars.hpp>
#include <indicators/update.hpp>
#include <nestgrid/error.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>
#include <walk/crossing_nodes.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/unusable_values.hpp>

namespace nestgrid {

namespace detail {

void PrerollFacts::add(const PrerollFacts& other) {
    least = std::min(least, other.least);
    greatest = std::max(greatest, other.greatest);
    if (!(other.hanging_violation <= hanging_violation)) {
        hanging_violation = other.hanging_violation;
    }
    largest_split = std::max(largest_split, other.largest_split);
    finest_level = std::max(finest_level, other.finest_level);
    longest_chain = std::max(longest_chain, other.longest_chain);
    all_divided = all_divided && other.all_divided;
    one_level_a_node = one_level_a_node && other.one_level_a_node;
    least_stop = std::min(least_stop, other.least_stop);
}

void IndicatorEntries::resize(std::size_t from, std::size_t to) {
    if (dense == nullptr || from == to) return;
    auto resized = std::make_unique<IndicatorEntry[]>(to);
    std::copy_n(dense.get(), std::min(from, to), resized.get());
    dense = std::move(resized);
}

void PrerollFacts::refuse(double value) {
    throw engine::UnusableValue("a value of the field is not a usable number: " +
                                std::to_string(value));
}

}  // namespace detail

namespace {

/// Takes the facts of all ranks together.
void agree(detail::PrerollFacts& facts, Ranks& ranks) {
    // A node may be made on different levels on two ranks.
    facts.one_level_a_node = false;
    double least = -facts.least;
    double least_stop = -facts.least_stop;
    auto largest_split = static_cast<double>(facts.largest_split);
    auto finest_level = static_cast<double>(facts.finest_level);
    auto longest_chain = static_cast<double>(facts.longest_chain);
    double not_divided = facts.all_divided ? 0 : 1;
    std::array<double*, 8> greatest{&least,         &facts.greatest, &facts.hanging_violation,
                                    &largest_split, &finest_level,   &longest_chain,
                                    &not_divided,   &least_stop};
    engine::take_greatest(ranks, greatest);
    facts.least = -least;
    facts.least_stop = -least_stop;
    facts.largest_split = static_cast<std::size_t>(largest_split);
    facts.finest_level = static_cast<int>(finest_level);
    facts.longest_chain = static_cast<int>(longest_chain);
    facts.all_divided = not_divided == 0;
}

}  // namespace

bool ChangedBox::operator()(std::span<const Point> points) const {
    Point least = points.front();
    Point greatest = points.front();
    for (const Point& x : points) {
        for (std::size_t d = 0; d < 3; ++d) {
            least[d] = std::min(least[d], x[d]);
            greatest[d] = std::max(greatest[d], x[d]);
        }
    }
    for (std::size_t d = 0; d < 3; ++d) {
        if (greatest[d] < low[d] || least[d] > high[d]) return false;
    }
    return true;
}

HierarchicalIndicator::HierarchicalIndicator(const Hierarchy<float>& hierarchy,
                                             const LeafErrors& leaf_errors,
                                             const Executor& executor, const Spread& spread)
    : spread_{spread} {
    prepare(hierarchy, leaf_errors, executor);
}

HierarchicalIndicator::HierarchicalIndicator(const Hierarchy<double>& hierarchy,
                                             const LeafErrors& leaf_errors,
                                             const Executor& executor, const Spread& spread)
    : spread_{spread} {
    prepare(hierarchy, leaf_errors, executor);
}

HierarchicalIndicator::HierarchicalIndicator(const Hierarchy<float>& hierarchy, NodeError error,
                                             const Executor& executor, const Spread& spread)
    : spread_{spread}, error_{error} {
    prepare(hierarchy, {}, executor);
}

HierarchicalIndicator::HierarchicalIndicator(const Hierarchy<double>& hierarchy, NodeError error,
                                             const Executor& executor, const Spread& spread)
    : spread_{spread}, error_{error} {
    prepare(hierarchy, {}, executor);
}

template <class Real>
void HierarchicalIndicator::prepare(const Hierarchy<Real>& hierarchy, const LeafErrors& leaf_errors,
                                    const Executor& executor) {
    const engine::SharedNodes* const shared = hierarchy.facts().shared;
    const auto asked = [&] {
        const char* const of = leaf_errors                      ? "errors of leaves"
                               : error_ == NodeError::deviation ? "deviations"
                                                                : "offsets";
        return std::string("a preroll of ") + of + ", factor " +
               engine::all_digits(spread_.factor) + ", slope " + engine::all_digits(spread_.slope);
    };
    engine::together(shared, asked, [&] {
        engine::require_spread(spread_);
        if (shared != nullptr) engine::require_same_state(hierarchy);
    });
    epoch_ = hierarchy.epoch();
    roundoff_ = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
    own_errors_ = static_cast<bool>(leaf_errors);
    hanging_ = engine::find_hanging_nodes(hierarchy);
    std::optional<engine::Sweeps> sweeps;
    const auto walk_all = [&] {
        const bool measures = spread_.slope > 0;
        const bool deviations = error_ == NodeError::deviation;
        const bool plain = spread_.factor == 1 && !measures && !own_errors_ && !deviations;
        if (hierarchy.facts().knows_stars && plain) {
            facts_ = engine::sweep_stars(hierarchy, entries_);
            node_count_ = hierarchy.facts().node_count;
            return;
        }
        if (deviations && engine::bisects_by_keys(hierarchy)) {
            facts_ = engine::sweep_stars(hierarchy, entries_);
            engine::sweep_lattice_deviations(hierarchy, spread_, entries_, executor);
            node_count_ = hierarchy.facts().node_count;
            return;
        }
        const engine::Walk<Real> walk(
            hierarchy, {.values = true, .keys = true, .positions = measures, .on_ranks = true},
            hanging());
        const engine::MadeOf made_of = deviations    ? engine::MadeOf::deviations
                                       : own_errors_ ? engine::MadeOf::leaf_errors
                                                     : engine::MadeOf::offsets;
        sweeps.emplace(hierarchy.facts().node_count, made_of, spread_);
        facts_ =
            engine::walk_preroll(walk, {&leaf_errors, measures, deviations}, *sweeps, executor);
    };
    engine::together(shared, "a preroll of offsets",
                     [&] { engine::with_places(hierarchy, walk_all); });
    if (!sweeps) return;
    sweeps->saturate(shared);
    facts_.least_stop = detail::bfloat16_value(sweeps->least_stop());
    // No element above a crossing node stops, whatever its level.
    facts_.one_level_a_node = sweeps->one_level_a_node() && hanging_.crossing() == nullptr;
    if (shared != nullptr) agree(facts_, shared->ranks());
    node_count_ = sweeps->node_count();
    sweeps->store(entries_);
}

template <class Real>
void HierarchicalIndicator::update_dirty(const Hierarchy<Real>& hierarchy,
                                         const ChangedPlaces& changed,
                                         const LeafErrors& leaf_errors) {
    const engine::SharedNodes* const shared = hierarchy.facts().shared;
    engine::together(shared, "an update of an indicator", [&] {
        if (own_errors_ == static_cast<bool>(leaf_errors)) return;
        throw InvalidInput(own_errors_
                               ? "an indicator made of errors of leaves is updated with them"
                               : "an indicator made of offsets is updated without errors of "
                                 "leaves");
    });
    if (shared != nullptr && error_ != NodeError::deviation) {
        // A node of this rank that has not changed may have been on another rank before.
        HierarchicalIndicator anew(hierarchy, leaf_errors, SequentialExecutor{}, spread_);
        anew.facts_.add(facts_);
        anew.facts_.least_stop = 0;
        *this = std::move(anew);
        return;
    }
    if (error_ == NodeError::deviation) {
        *this = HierarchicalIndicator(hierarchy, error_, SequentialExecutor{}, spread_);
        return;
    }
    HangingNodes found;
    const bool same_grid = hierarchy.epoch() == epoch_;
    if (!same_grid) found = engine::find_hanging_nodes(hierarchy);
    HangingNodes& hanging = same_grid ? hanging_ : found;
    const engine::Walk<Real> marking(hierarchy, {.values = false, .keys = true, .positions = true},
                                     &hanging);
    const engine::DirtyNodes dirty(marking, changed, !same_grid);
    const engine::Walk<Real> walk(
        hierarchy, {.values = true, .keys = true, .positions = spread_.slope > 0}, &hanging);
    const std::size_t dense = hierarchy.facts().node_count;
    std::vector<std::pair<NodeKey, detail::IndicatorEntry>> made;
    const auto put = [&](NodeKey node, const detail::IndicatorEntry& entry) {
        if (dense != 0) engine::require_dense(node, dense);
        made.emplace_back(node, entry);
    };
    const detail::PrerollFacts facts = engine::with_places(hierarchy, [&] {
        return engine::sweep_dirty(walk, dirty, entries_, leaf_errors, spread_, put);
    });
    entries_.resize(node_count_, dense);
    for (const auto& [node, entry] : made) entries_.put(node, entry);
    node_count_ = entries_.dense == nullptr ? entries_.sparse.size() : dense;
    facts_.add(facts);
    facts_.one_level_a_node = facts_.one_level_a_node && hanging.crossing() == nullptr;
    if (!same_grid) hanging_ = std::move(found);
    epoch_ = hierarchy.epoch();
}

void HierarchicalIndicator::update(const Hierarchy<float>& hierarchy, const ChangedPlaces& changed,
                                   const LeafErrors& leaf_errors) {
    update_dirty(hierarchy, changed, leaf_errors);
}

void HierarchicalIndicator::update(const Hierarchy<double>& hierarchy, const ChangedPlaces& changed,
                                   const LeafErrors& leaf_errors) {
    update_dirty(hierarchy, changed, leaf_errors);
}

std::size_t HierarchicalIndicator::memory_bytes() const {
    const engine::CrossingNodes* crossing = hanging_.crossing();
    return (crossing == nullptr ? 0 : crossing->memory_bytes()) +
           (entries_.dense == nullptr ? 0 : node_count_ * sizeof(detail::IndicatorEntry)) +
           entries_.sparse.memory_bytes() + hanging_.memory_bytes();
}

}  // namespace nestgrid
