// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/algorithms/indicator.hpp>
#include <walk/hanging_nodes.hpp>

namespace nestgrid::engine {

/// What a walk at full resolution needs to know of a grid: the nodes that hang.
class LeafBounds final : public Bounds {
public:
    template <class Real>
    explicit LeafBounds(const Hierarchy<Real>& hierarchy)
        : epoch_{hierarchy.epoch()}, hanging_{find_hanging_nodes(hierarchy)} {}
    double offset_bound(NodeKey) const override { return 0; }
    double bound(const Rule&, std::span<const NodeKey>) const override { return 0; }
    const HangingNodes* hanging() const override { return hanging_.empty() ? nullptr : &hanging_; }
    bool made_for(std::uint64_t epoch) const override { return epoch == epoch_; }

private:
    std::uint64_t epoch_;
    HangingNodes hanging_;
};

}  // namespace nestgrid::engine
