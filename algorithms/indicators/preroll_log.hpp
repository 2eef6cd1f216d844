// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <indicators/sweeps.hpp>

namespace nestgrid::engine {

/// Logs the splits and leaves that a part of a preroll meets, and tells Sweeps of them in this
/// order.
class PrerollLog {
public:
    template <class Offset>
    void split(const MetSplit& s, Offset&& offset) {
        items_.push_back({s.rule, s.level, s.outside, s.reach, s.keys.size()});
        keys_.insert(keys_.end(), s.keys.begin(), s.keys.end());
        for (std::size_t n = 0; n < s.rule->new_nodes.size(); ++n) numbers_.push_back(offset(n));
    }
    void leaf(std::span<const NodeKey> corners, float error) {
        items_.push_back({nullptr, 0, 0, 0, corners.size()});
        keys_.insert(keys_.end(), corners.begin(), corners.end());
        numbers_.push_back(error);
    }

    void repeat(Sweeps& sweeps) const {
        std::span<const NodeKey> keys(keys_);
        std::span<const float> numbers(numbers_);
        for (const Item& i : items_) {
            const auto of = keys.first(i.keys);
            keys = keys.subspan(i.keys);
            if (i.rule == nullptr) {
                sweeps.leaf(of, numbers.front());
                numbers = numbers.subspan(1);
            } else {
                sweeps.split({i.rule, i.level, i.outside, i.reach, of},
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
        float reach;
        std::size_t keys;
    };
    std::vector<Item> items_;
    std::vector<NodeKey> keys_;
    std::vector<float> numbers_;  // offsets of new nodes, errors of leaves
};

}  // namespace nestgrid::engine
