// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/split_bounds.hpp>

#include <algorithm>

#include <indicators/node_numbers.hpp>
#include <indicators/split_ranges.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/unusable_values.hpp>

namespace nestgrid {

bool detail::are_split_bounds_worth_while(const HierarchyFacts& facts) {
    return !facts.knows_stars && !facts.knows_patches;
}

SplitBounds::SplitBounds(const Hierarchy<float>& hierarchy, const Executor& executor) {
    prepare(hierarchy, executor);
}

SplitBounds::SplitBounds(const Hierarchy<double>& hierarchy, const Executor& executor) {
    prepare(hierarchy, executor);
}

template <class Real>
void SplitBounds::prepare(const Hierarchy<Real>& hierarchy, const Executor& executor) {
    hierarchy.facts().require_one_process("SplitBounds");
    epoch_ = hierarchy.epoch();
    hanging_ = engine::find_hanging_nodes(hierarchy);
    node_count_ = hierarchy.facts().node_count;
    if (node_count_ != 0) dense_ = std::make_unique<std::uint16_t[]>(node_count_);
    const engine::Walk<Real> walk(hierarchy, {}, hanging());
    engine::with_places(hierarchy, [&] {
        facts_ =
            engine::walk_ranges(walk, executor, [&](const engine::SplitName& name, float beyond) {
                std::uint16_t& kept = place_of(name.key, name.is_node);
                kept = std::max(kept, detail::bfloat16_above(beyond));
            });
    });
}

std::uint16_t& SplitBounds::place_of(NodeKey name, bool is_node) {
    if (dense_ == nullptr || !is_node) return *sparse_.insert(name, 0).first;
    engine::require_dense(name, node_count_);
    return dense_[static_cast<std::size_t>(name)];
}

double SplitBounds::bound(const Rule& rule, std::span<const NodeKey> nodes) const {
    const engine::SplitName name = engine::name_of_split(rule, nodes);
    if (dense_ != nullptr && name.is_node) {
        return detail::bfloat16_value(dense_[static_cast<std::size_t>(name.key)]);
    }
    const std::uint16_t* const kept = sparse_.find(name.key);
    return detail::bfloat16_value(kept == nullptr ? detail::bfloat16_infinity : *kept);
}

std::size_t SplitBounds::memory_bytes() const {
    return node_count_ * sizeof(std::uint16_t) + sparse_.memory_bytes() + hanging_.memory_bytes();
}

}  // namespace nestgrid
