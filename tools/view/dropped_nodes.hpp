// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

#include <nestgrid/algorithms/criterion.hpp>

namespace nestgrid::view {

/// A criterion that remembers the greatest number, by another indicator, of the nodes that it drops
/// where a drawing asks for them. A threshold of that number on the indicator drops them, too. May
/// be asked by several threads.
class DroppedNodes final : public Criterion {
public:
    /// Borrows both.
    DroppedNodes(const Criterion& inner, const Indicator* numbers)
        : inner_{&inner}, numbers_{numbers} {}

    double greatest() const { return greatest_; }

    NodeMask holds(const NewNodes& nodes) const override {
        const NodeMask mask = inner_->holds(nodes);
        for (std::size_t i = 0; i < nodes.keys.size(); ++i) {
            if ((mask >> i & 1U) != 0) raise(numbers_->stop(nodes.keys[i]));
        }
        return mask;
    }
    bool wants_positions() const override { return inner_->wants_positions(); }
    bool saturated() const override { return inner_->saturated(); }
    bool needs_one_level_a_node() const override { return inner_->needs_one_level_a_node(); }
    bool made_for(std::uint64_t epoch) const override { return inner_->made_for(epoch); }
    double surface_error(std::span<const double> isovalues) const override {
        return inner_->surface_error(isovalues);
    }

private:
    void raise(double number) const {
        double known = greatest_.load(std::memory_order_relaxed);
        while (number > known && !greatest_.compare_exchange_weak(known, number)) {
        }
    }

    const Criterion* inner_;
    const Indicator* numbers_;
    mutable std::atomic<double> greatest_ = 0;
};

}  // namespace nestgrid::view
