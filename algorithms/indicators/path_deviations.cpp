// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/path_deviations.hpp>

#include <algorithm>
#include <cmath>

#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

/// Enters an element and all above it, where the walk begins below.
template <class Real>
void PathDeviations<Real>::push_all(const View& view) {
    const View* const above = PathRows<Real>::split_above(view);
    if (above != nullptr) push_all(*above);
    SplitKeys keys;
    push(view, PathRows<Real>::split_of(view, keys), view.stack->frame(view.level).value.data());
}

template <class Real>
void PathDeviations<Real>::push(const View& view, const Split& split, const Real* value) {
    const std::size_t depth = rows_.depth();
    auto& at = rows_.enter(view, 1);
    for (std::size_t k = 0; k < at.corners; ++k) {
        std::fill_n(at.row(k) + depth, at.stride - depth,
                    static_cast<double>(value[k * walk_->components()]));
    }
    rows_.split(*split.rule, split.keys);
    if (offsets_.size() == depth) offsets_.emplace_back();
    offsets_[depth].below = 0;
    offsets_[depth].of_corners = corner_offset();
    deviation_.resize(std::max(deviation_.size(), at.stride));
    deviation_[depth] = 0;
    compare_new_nodes(*split.rule, value);
}

/// The greatest offset of the father's new nodes among the corners of the last element.
template <class Real>
double PathDeviations<Real>::corner_offset() {
    if (rows_.depth() < 2) return 0;
    const auto& at = rows_.last();
    const std::size_t corners_above = rows_.above_last().corners;
    const std::vector<double>& offset = offsets_[rows_.depth() - 2].of_new;
    double greatest = 0;
    for (std::size_t k = 0; k < at.corners; ++k) {
        if (at.node[k] < corners_above) continue;
        greatest = std::max(greatest, offset[at.node[k] - corners_above]);
    }
    return greatest;
}

template <class Real>
void PathDeviations<Real>::compare_new_nodes(const Rule& rule, const Real* value) {
    const auto& at = rows_.last();
    const std::size_t components = walk_->components();
    std::vector<double>& offset = offsets_[rows_.depth() - 1].of_new;
    offset.resize(rule.new_nodes.size());
    double* const deviation = deviation_.data();
    for (std::size_t n = 0; n < offset.size(); ++n) {
        const Stencil& stencil = rule.new_nodes[n];
        const double* const row = at.row(at.corners + n);
        const auto u = static_cast<double>(value[(at.corners + n) * components]);
        for (std::size_t i = 0; i < at.stride; ++i) {
            deviation[i] = std::max(deviation[i], std::abs(u - row[i]));
        }
        const auto mean =
            static_cast<double>(nestgrid::detail::interpolate(stencil, value, components));
        double of_parents = 0;
        for (std::size_t p = 0; p < stencil.count; ++p) {
            const std::size_t parent = stencil.parent[p];
            if (parent < at.corners) continue;
            of_parents = std::max(of_parents, offset[parent - at.corners]);
        }
        offset[n] = std::abs(u - mean) + of_parents;
    }
}

/// Where a split makes several nodes, S may keep some of them and drop others: then a child may
/// stop at once, with dropped corners, whose offsets add to its own deviation.
template <class Real>
double PathDeviations<Real>::stop_of_last() {
    const std::size_t at = rows_.depth() - 1;
    const Rule& rule = *rows_.last().rule;
    if (rule.new_nodes.size() == 1) return deviation_[at];
    double greatest = std::max(deviation_[at], offsets_[at].below);
    if (rule.steps == 1) return greatest;
    for (const double offset : offsets_[at].of_new) greatest = std::max(greatest, offset);
    return greatest;
}

template class PathDeviations<float>;
template class PathDeviations<double>;

}  // namespace nestgrid::engine
