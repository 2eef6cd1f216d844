// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which leaves the zero of a function of position may pass through, when it is drawn.
//
// A drawing takes the function's value at a node, or the mean of those at the node's parents, where
// the node hangs or elements may stop. So a corner has an interval: its value, and the mean of the
// intervals of its parents where that may take the place. An element is between the intervals of
// its corners, and what the function varies by around.
#pragma once

#include <algorithm>

#include <high_order/real_nodes.hpp>
#include <walk/position_functions.hpp>

namespace nestgrid::engine {

class FunctionRanges {
public:
    /// \param nodes of the field \param places of curved leaves, or null; all are borrowed
    /// \param tolerance elements may stop at nodes whose `stop` is at most this
    FunctionRanges(const PositionFunctions& functions, const RealNodes& nodes,
                   const RealNodes* places, double tolerance)
        : functions_{&functions}, nodes_{&nodes}, places_{places}, tolerance_{tolerance} {}

    /// Told every element of a walk with positions, fathers first.
    void enter(std::span<const BaseElement> way) {
        const std::size_t level = way.size() - 1;
        if (at_.size() <= level) at_.resize(level + 1);
        at_[level].resize(functions_->count());
        for (std::size_t f = 0; f < functions_->count(); ++f) {
            for (std::size_t k = 0; k < way.back().shape->corners; ++k) {
                at_[level][f][k] = at_corner(way, f, k);
            }
        }
    }
    /// Whether a function may be 0 in the last element on the way, a leaf.
    /// \param beyond how far it may leave the hull of its corners
    bool pass(const BaseElement& leaf, std::size_t level, double beyond) const {
        std::array<Point, max_corners> room;
        for (std::size_t k = 0; k < leaf.shape->corners; ++k) room[k] = position(leaf, k);
        const auto x = std::span<const Point>(room).first(leaf.shape->corners);
        for (std::size_t f = 0; f < functions_->count(); ++f) {
            Range all = at_[level][f][0];
            for (std::size_t k = 1; k < x.size(); ++k) all = joined(all, at_[level][f][k]);
            const auto first = functions_->at<double>(f, x[0]);
            const Range range = functions_->range(f, x, all, first, beyond);
            // A drawing rounds what is this near to 0.
            const double near = 4 * functions_->tolerance(f);
            if (range.least <= near && range.greatest >= -near) return true;
        }
        return false;
    }

private:
    using Range = PositionFunctions::Range;

    static Range joined(const Range& a, const Range& b) {
        return {std::min(a.least, b.least), std::max(a.greatest, b.greatest)};
    }
    Point position(const BaseElement& e, std::size_t corner) const {
        if (places_ == nullptr) return e.x[corner];
        const double* const x = places_->values(e.key[corner]);
        return {x[0], x[1], x[2]};
    }
    Range at_corner(std::span<const BaseElement> way, std::size_t f, std::size_t corner) const {
        const BaseElement& e = way.back();
        const auto value = functions_->at<double>(f, position(e, corner));
        if (way.size() == 1) return {value, value};
        const BaseElement& father = way[way.size() - 2];
        const Rule& rule = *father.member->rule;
        const std::size_t node = rule.children[e.number].corner[corner];
        const auto& above = at_[way.size() - 2][f];
        if (node < father.shape->corners) return above[node];
        const RealNode* const made = nodes_->find(e.key[corner]);
        const bool may_be_mean =
            made == nullptr || made->hangs || static_cast<double>(made->stop) <= tolerance_;
        if (!may_be_mean) return {value, value};
        const Stencil& stencil = rule.new_nodes[node - father.shape->corners];
        Range mean{0, 0};
        for (std::size_t i = 0; i < stencil.count; ++i) {
            mean.least += above[stencil.parent[i]].least / stencil.count;
            mean.greatest += above[stencil.parent[i]].greatest / stencil.count;
        }
        return joined(mean, {value, value});
    }

    const PositionFunctions* functions_;
    const RealNodes* nodes_;
    const RealNodes* places_;
    double tolerance_;
    std::vector<std::vector<std::array<Range, max_corners>>> at_;  // by level and function
};

}  // namespace nestgrid::engine
