// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/indicator.hpp>

#include <cmath>
#include <string>

#include <indicators/preroll.hpp>
#include <indicators/stars.hpp>
#include <nestgrid/error.hpp>
#include <walk/crossing_nodes.hpp>
#include <walk/hanging_nodes.hpp>

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
}

void PrerollFacts::refuse(double value) {
    throw InvalidInput("a value of the field is not a usable number: " + std::to_string(value));
}

}  // namespace detail

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

template <class Real>
void HierarchicalIndicator::prepare(const Hierarchy<Real>& hierarchy, const LeafErrors& leaf_errors,
                                    const Executor& executor) {
    if (!(spread_.factor >= 1) || !(spread_.slope >= 0) || !std::isfinite(spread_.factor) ||
        !std::isfinite(spread_.slope)) {
        throw InvalidInput(
            "an indicator is spread by a factor of at least 1 and a slope of at "
            "least 0, not by " +
            std::to_string(spread_.factor) + " and " + std::to_string(spread_.slope));
    }
    epoch_ = hierarchy.epoch();
    roundoff_ = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
    own_errors_ = static_cast<bool>(leaf_errors);
    hanging_ = engine::find_hanging_nodes(hierarchy);
    const bool measures = spread_.slope > 0;
    const bool plain = spread_.factor == 1 && !measures && !own_errors_;
    if (hierarchy.facts().knows_stars && plain) {
        facts_ = engine::sweep_stars(hierarchy, entries_);
        node_count_ = hierarchy.facts().node_count;
        return;
    }
    const engine::Walk<Real> walk(hierarchy, {.values = true, .keys = true, .positions = measures},
                                  hanging());
    engine::Sweeps sweeps(hierarchy.facts().node_count, own_errors_, spread_);
    facts_ = engine::walk_preroll(walk, leaf_errors, measures, sweeps, executor);
    sweeps.saturate();
    // No element above a crossing node stops, whatever its level.
    facts_.one_level_a_node = sweeps.one_level_a_node() && hanging_.crossing() == nullptr;
    node_count_ = sweeps.node_count();
    sweeps.store(entries_);
}

std::size_t HierarchicalIndicator::memory_bytes() const {
    const engine::CrossingNodes* crossing = hanging_.crossing();
    return (crossing == nullptr ? 0 : crossing->memory_bytes()) +
           (entries_.dense == nullptr ? 0 : node_count_ * sizeof(detail::IndicatorEntry)) +
           entries_.sparse.memory_bytes() + hanging_.memory_bytes();
}

}  // namespace nestgrid
