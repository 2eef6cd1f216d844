// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <nestgrid/algorithms/criterion.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// Whether an element stops without a question: a saturated criterion that is above 0 at a corner
/// is 1 at all new nodes. No element may stop at a new node that lies outside.
template <class Real>
bool stops_by_saturation(bool saturated, const ElementView<Real>& view, const Split& split) {
    return saturated && view.interpolated != 0 && split.outside == 0;
}

/// Asks a criterion about the new nodes of a split, and keeps the memory of questions and answers.
class CriterionQuestion {
public:
    /// \param walk must carry positions where the criterion wants them
    /// \return a decision whose weights are valid until the next question
    template <class Real>
    Decision ask(const Walk<Real>& walk, const Criterion& criterion, const ElementView<Real>& view,
                 const Split& split) {
        NewNodes nodes{*split.rule, split.keys, view.level + 1, split.outside};
        if (criterion.wants_positions()) {
            nodes.positions =
                walk.split_positions(view, split, positions_).subspan(view.corner_count());
        }
        const NodeMask mask = criterion.holds(nodes);
        Decision decision{mask == split.rule->all() ? Visit::stop : Visit::descend, mask};
        if (criterion.blends() && decision.visit == Visit::descend) {
            weights_.resize(split.rule->new_nodes.size());
            criterion.weights(nodes, weights_);
            decision.weights = weights_;
        }
        return decision;
    }

private:
    SplitPositions positions_;
    std::vector<float> weights_;
};

}  // namespace nestgrid::engine
