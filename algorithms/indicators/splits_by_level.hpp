// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// The splits that a walk has met, for sweeps over them level by level.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include <nestgrid/error.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid::engine {

/// The splits of a hierarchy by level, each as its rule and the numbers of its corners and new
/// nodes. Memory: 4 bytes a number, 5 where there are more than 2^32 nodes.
class SplitsByLevel {
public:
    static constexpr std::uint64_t narrow = std::uint64_t{1} << 32U;

    /// \param nodes their number; 0 where it is not known yet, and will not exceed 2^32
    explicit SplitsByLevel(std::size_t nodes) : wide_{std::uint64_t{nodes} > narrow} {}

    /// \param reach the greatest distance between a corner and a new node; 0 for all splits where
    ///        distances do not count
    /// \throw GridError for a node number of 2^32 or above where `nodes` did not exceed 2^32
    void add(std::size_t level, const Rule& rule, std::span<const std::size_t> nodes,
             float reach = 0) {
        if (level >= levels_.size()) levels_.resize(level + 1);
        std::deque<Part>& parts = levels_[level];
        if (parts.empty() || parts.back().rules.size() == Part::most) {
            parts.emplace_back(nodes.size(), wide_);
        }
        Part& to = parts.back();
        to.rules.push_back(&rule);
        if (reach > 0) {
            to.reach.resize(to.rules.size() - 1);
            to.reach.push_back(reach);
        }
        std::array<std::uint32_t, max_corners + max_new_nodes> low;
        std::uint64_t all = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            low[i] = static_cast<std::uint32_t>(nodes[i]);
            all |= nodes[i];
        }
        if (all >= narrow && !wide_) throw GridError("the grid has more than 2^32 nodes");
        to.low.insert(to.low.end(), low.begin(), low.begin() + nodes.size());
        for (std::size_t i = 0; wide_ && i < nodes.size(); ++i) {
            to.high.push_back(static_cast<std::uint8_t>(std::uint64_t{nodes[i]} >> 32U));
        }
    }

    std::size_t levels() const { return levels_.size(); }

    /// Calls function(rule, numbers, reach) for the splits of elements on a level.
    template <class Function>
    void for_each(std::size_t level, const Function& function) const {
        for (const Part& part : levels_[level]) for_each_of(part, function);
    }

private:
    /// Splits that follow each other, in arrays that do not grow where all have as many nodes.
    struct Part {
        static constexpr std::size_t most = 250;  // no power of two: equal places in caches

        /// \param nodes of the first split
        Part(std::size_t nodes, bool wide) {
            rules.reserve(most);
            low.reserve(most * nodes);
            if (wide) high.reserve(most * nodes);
        }
        std::vector<const Rule*> rules;
        std::vector<std::uint32_t> low;
        std::vector<std::uint8_t> high;
        std::vector<float> reach;  // by split; 0 for splits behind its end
    };

    template <class Function>
    void for_each_of(const Part& part, const Function& function) const {
        auto low = part.low.begin();
        auto high = part.high.begin();
        std::array<std::size_t, max_corners + max_new_nodes> nodes;
        for (std::size_t s = 0; s < part.rules.size(); ++s) {
            const Rule& rule = *part.rules[s];
            const std::size_t count =
                static_cast<std::size_t>(rule.corner_count()) + rule.new_nodes.size();
            for (std::size_t i = 0; i < count; ++i) {
                std::uint64_t node = *low++;
                if (wide_) node |= std::uint64_t{*high++} << 32U;
                nodes[i] = static_cast<std::size_t>(node);
            }
            function(rule, std::span<const std::size_t>(nodes).first(count),
                     s < part.reach.size() ? part.reach[s] : 0.0F);
        }
    }

    bool wide_;
    std::vector<std::deque<Part>> levels_;
};

}  // namespace nestgrid::engine
