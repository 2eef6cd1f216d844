// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <indicators/sweeps.hpp>

namespace nestgrid::engine {

/// Logs the splits, leaves and deviations that a part of a preroll meets, and tells a receiver of
/// them in this order.
class PrerollLog {
public:
    template <class Offset>
    void split(const PrerollSplit& s, Offset&& offset) {
        items_.push_back({s.rule, s.level, s.outside, s.reach, s.keys.size()});
        keys_.insert(keys_.end(), s.keys.begin(), s.keys.end());
        for (std::size_t n = 0; n < s.rule->new_nodes.size(); ++n) numbers_.push_back(offset(n));
    }
    void leaf(std::span<const NodeKey> corners, float error) {
        items_.push_back({nullptr, leaf_level, 0, 0, corners.size()});
        keys_.insert(keys_.end(), corners.begin(), corners.end());
        numbers_.push_back(error);
    }
    void deviation(const Deviation& d) {
        items_.push_back({nullptr, deviation_level, 0, 0, d.made.size()});
        keys_.insert(keys_.end(), d.made.begin(), d.made.end());
        numbers_.push_back(detail::float_above(d.deviation));
        numbers_.push_back(detail::float_above(d.stop));
    }

    /// \param sweeps has the three functions above
    template <class Receiver>
    void repeat(Receiver& sweeps) const {
        std::span<const NodeKey> keys(keys_);
        std::span<const float> numbers(numbers_);
        for (const Item& i : items_) {
            const auto of = keys.first(i.keys);
            keys = keys.subspan(i.keys);
            if (i.rule == nullptr && i.level == leaf_level) {
                sweeps.leaf(of, numbers.front());
                numbers = numbers.subspan(1);
            } else if (i.rule == nullptr) {
                sweeps.deviation({of, numbers[0], numbers[1]});
                numbers = numbers.subspan(2);
            } else {
                sweeps.split({i.rule, i.level, i.outside, i.reach, of},
                             [&](std::size_t n) { return numbers[n]; });
                numbers = numbers.subspan(i.rule->new_nodes.size());
            }
        }
    }

    void clear() { *this = {}; }

private:
    static constexpr int leaf_level = -1;
    static constexpr int deviation_level = -2;

    struct Item {
        const Rule* rule;  // null for a leaf or a deviation
        int level;         // or one of the two above
        NodeMask outside;
        float reach;
        std::size_t keys;
    };
    std::vector<Item> items_;
    std::vector<NodeKey> keys_;
    std::vector<float> numbers_;  // offsets of new nodes, errors of leaves, deviations
};

}  // namespace nestgrid::engine
