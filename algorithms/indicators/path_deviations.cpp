// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/path_deviations.hpp>

#include <algorithm>
#include <cmath>

#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

namespace {

constexpr std::size_t lanes = 4;  // rows are padded to a multiple of this

/// The row of a new node: the means of its parents' rows.
void take_mean(const Stencil& stencil, const double* rows, std::size_t stride, double* row) {
    if (stencil.mean == Mean::midpoint) {
        const double* const a = rows + stencil.parent[0] * stride;
        const double* const b = rows + stencil.parent[1] * stride;
        for (std::size_t i = 0; i < stride; ++i) row[i] = 0.5 * (a[i] + b[i]);
        return;
    }
    std::fill_n(row, stride, 0.0);
    for (std::size_t p = 0; p < stencil.count; ++p) {
        const double weight = stencil.weight[p];
        const double* const of = rows + stencil.parent[p] * stride;
        for (std::size_t i = 0; i < stride; ++i) row[i] += weight * of[i];
    }
}

}  // namespace

template <class Real>
auto PathDeviations<Real>::split_above(const View& view) -> const View* {
    const View* above = view.father;
    while (above != nullptr && above->member->rule->new_nodes.empty()) above = above->father;
    return above;
}

/// Enters an element and all above it, where the walk begins below.
template <class Real>
void PathDeviations<Real>::push_all(const View& view) {
    const View* const above = split_above(view);
    if (above != nullptr) push_all(*above);
    SplitKeys keys;
    Split split;
    split.rule = view.member->rule;
    const std::size_t corners = view.corner_count();
    Frame<Real>& frame = view.stack->frame(view.level);
    split.keys = view.family->new_keys(*view.member);
    if (split.keys.empty()) {
        std::copy_n(frame.key.begin() + static_cast<std::ptrdiff_t>(corners),
                    split.rule->new_nodes.size(), keys.begin());
        split.keys = std::span(keys).first(split.rule->new_nodes.size());
    }
    push(view, split, frame.value.data());
}

template <class Real>
void PathDeviations<Real>::push(const View& view, const Split& split, const Real* value) {
    if (levels_.size() == depth_) levels_.emplace_back();
    Level& at = levels_[depth_];
    at.coarse = view.coarse;
    at.level = view.level;
    at.path = view.path;
    at.rule = split.rule;
    at.corners = view.corner_count();
    at.stride = (depth_ + lanes) / lanes * lanes;
    at.rows.resize((at.corners + split.rule->new_nodes.size()) * at.stride);
    at.made.assign(split.keys.begin(), split.keys.end());
    at.below = 0;
    deviation_.resize(std::max(deviation_.size(), at.stride));
    deviation_[depth_] = 0;
    take_corners(view, value, at);
    take_new_nodes(value, at);
    ++depth_;
}

/// Takes the rows of the corners from the element above, with the values there for its own
/// interpolant.
template <class Real>
void PathDeviations<Real>::take_corners(const View& view, const Real* value, Level& at) {
    const std::size_t components = walk_->components();
    std::array<std::uint8_t, max_corners> node;  // of the element above
    for (std::size_t k = 0; k < at.corners; ++k) node[k] = static_cast<std::uint8_t>(k);
    for (const View* v = &view; v->father != nullptr; v = v->father) {
        for (std::size_t k = 0; k < at.corners; ++k) node[k] = v->as->corner[node[k]];
        if (!v->made_by->new_nodes.empty()) break;
    }
    at.corner_offset = 0;
    for (std::size_t k = 0; k < at.corners; ++k) {
        double* const row = at.rows.data() + k * at.stride;
        std::fill_n(row + depth_, at.stride - depth_, static_cast<double>(value[k * components]));
        if (depth_ == 0) continue;
        const Level& above = levels_[depth_ - 1];
        std::copy_n(above.rows.data() + node[k] * above.stride, depth_, row);
        if (node[k] < above.corners) continue;
        at.corner_offset = std::max(at.corner_offset, above.offset[node[k] - above.corners]);
    }
}

template <class Real>
void PathDeviations<Real>::take_new_nodes(const Real* value, Level& at) {
    const std::size_t components = walk_->components();
    const auto& stencils = at.rule->new_nodes;
    at.offset.resize(stencils.size());
    double* const deviation = deviation_.data();
    for (std::size_t n = 0; n < stencils.size(); ++n) {
        double* const row = at.rows.data() + (at.corners + n) * at.stride;
        take_mean(stencils[n], at.rows.data(), at.stride, row);
        const auto u = static_cast<double>(value[(at.corners + n) * components]);
        for (std::size_t i = 0; i < at.stride; ++i) {
            deviation[i] = std::max(deviation[i], std::abs(u - row[i]));
        }
        const auto mean =
            static_cast<double>(nestgrid::detail::interpolate(stencils[n], value, components));
        double of_parents = 0;
        for (std::size_t p = 0; p < stencils[n].count; ++p) {
            const std::size_t parent = stencils[n].parent[p];
            if (parent < at.corners) continue;
            of_parents = std::max(of_parents, at.offset[parent - at.corners]);
        }
        at.offset[n] = std::abs(u - mean) + of_parents;
    }
}

/// Where a split makes several nodes, S may keep some of them and drop others: then a child may
/// stop at once, with dropped corners, whose offsets add to its own deviation.
template <class Real>
double PathDeviations<Real>::stop_of(const Level& at, double deviation) {
    if (at.rule->new_nodes.size() == 1) return deviation;
    double greatest = std::max(deviation, at.below);
    if (at.rule->steps == 1) return greatest;
    for (const double offset : at.offset) greatest = std::max(greatest, offset);
    return greatest;
}

template class PathDeviations<float>;
template class PathDeviations<double>;

}  // namespace nestgrid::engine
