// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/path_cuts.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <contours/cell_contour.hpp>
#include <indicators/diameter.hpp>
#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

template <class Real>
bool PathCuts<Real>::is_below_skipped(const View& view) {
    if (skipped_.level < 0) return false;
    const View* at = &view;
    while (at != nullptr && at->level > skipped_.level) at = at->father;
    const bool below = at != &view && at != nullptr && at->coarse == skipped_.coarse &&
                       at->level == skipped_.level && at->path == skipped_.path;
    if (!below) skipped_.level = -1;
    return below;
}

template <class Real>
bool PathCuts<Real>::enter(const View& view, const Split& split) {
    if (is_below_skipped(view)) return false;
    const View* const above = PathRows<Real>::split_above(view);
    while (rows_.depth() > 0 && (above == nullptr || !rows_.last().is(*above))) leave();
    if (above != nullptr && rows_.depth() == 0 && !enter_all(*above)) return false;
    return enter_one(view, split);
}

/// Enters an element and all above it, where the walk begins below.
template <class Real>
bool PathCuts<Real>::enter_all(const View& view) {
    const View* const above = PathRows<Real>::split_above(view);
    if (above != nullptr && !enter_all(*above)) return false;
    SplitKeys keys;
    const Split of_view = PathRows<Real>::split_of(view, keys);
    if (!enter_one(view, of_view)) return false;
    split(of_view, view.stack->frame(view.level).value.data());
    return true;
}

template <class Real>
bool PathCuts<Real>::enter_one(const View& view, const Split& split) {
    const bool leaf = split.rule == nullptr;
    const std::size_t depth = rows_.depth();
    const bool for_above = depth > 0 && rows_.last().rule->new_nodes.size() > 1;
    const std::size_t own = leaf ? 0 : is_simplex(view.shape) ? 1 : 2;
    rows_.enter(view, (for_above ? 2 : 0) + own);
    begin_columns(view, own);
    const double bound =
        leaf ? 0 : static_cast<double>(request_.bounds->bound(*split.rule, split.keys));
    const bool seen = measure_.look(corners_, leaf, bound);
    if (leaf || !seen) leave_unsplit();
    if (!leaf && !seen) skipped_ = {view.coarse, view.level, view.path};
    return seen;
}

/// Begins the functions of an element.
/// \param own how many of them are its own
template <class Real>
void PathCuts<Real>::begin_columns(const View& view, std::size_t own) {
    const std::size_t depth = rows_.depth();
    auto& at = rows_.last();
    if (cuts_.size() < depth) cuts_.emplace_back();
    Cuts& cuts = cuts_[depth - 1];
    cuts.below = 0;
    cuts.own = at.columns - own;
    cuts.for_above = depth < 2 ? 0 : rows_.above_last().columns;
    set_corners(view);
    const auto u = std::span<const double>(corners_.value).first(at.corners);
    measure_.begin(cuts.for_above, at.columns,
                   request_.distances ? diameter_of(corners_.position) : 0);
    if (cuts.own > cuts.for_above) begin_for_above(view);
    if (own == 0) return;
    const double off = own == 1 ? 0 : 2 * affine_residual(corners_.position, u);
    for (std::size_t k = 0; k < at.corners; ++k) {
        at.row(k)[cuts.own] = u[k] - off;
        at.row(k)[at.columns - 1] = u[k] + off;
    }
}

/// Shows the measure the corners of the last element.
template <class Real>
void PathCuts<Real>::set_corners(const View& view) {
    const auto& at = rows_.last();
    corners_.count = at.corners;
    corners_.columns = at.columns;
    corners_.dimension = view.topology().dimension;
    for (std::size_t k = 0; k < at.corners; ++k) {
        corners_.row[k] = at.row(k);
        corners_.value[k] = static_cast<double>(view.value[k * walk_->components()]);
    }
    const bool measures = request_.distances || !is_simplex(view.shape);
    if (measures) walk_->corners(view, nullptr, position_.data());
    corners_.position = std::span<const Point>(position_).first(measures ? at.corners : 0);
}

/// Begins the least and the greatest function that a child of the last element but one may draw
/// where some of its corners are dropped.
template <class Real>
void PathCuts<Real>::begin_for_above(const View& view) {
    auto& at = rows_.last();
    const Cuts& above = cuts_[rows_.depth() - 2];
    const std::size_t column = cuts_[rows_.depth() - 1].for_above;
    std::array<double, max_corners> middle;
    double width = 0;
    for (std::size_t k = 0; k < at.corners; ++k) {
        const auto low = static_cast<double>(above.least[at.node[k]]);
        const auto high = static_cast<double>(above.greatest[at.node[k]]);
        at.row(k)[column] = low;
        at.row(k)[column + 1] = high;
        middle[k] = 0.5 * (low + high);
        width = std::max(width, high - low);
    }
    if (width == 0 || is_simplex(view.shape)) return;
    const double off =
        2 * (affine_residual(corners_.position, std::span<const double>(middle).first(at.corners)) +
             0.5 * width);
    for (std::size_t k = 0; k < at.corners; ++k) {
        at.row(k)[column] -= off;
        at.row(k)[column + 1] += off;
    }
}

template <class Real>
void PathCuts<Real>::split(const Split& split, const Real* value) {
    const Rule& rule = *split.rule;
    rows_.split(rule, split.keys);
    if (rule.new_nodes.size() == 1) return;
    Cuts& cuts = cuts_[rows_.depth() - 1];
    const std::size_t corners = rows_.last().corners;
    const std::size_t components = walk_->components();
    cuts.least.resize(corners + rule.new_nodes.size());
    for (std::size_t k = 0; k < cuts.least.size(); ++k) cuts.least[k] = value[k * components];
    cuts.greatest = cuts.least;
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        const Stencil& stencil = rule.new_nodes[n];
        const Real low = nestgrid::detail::interpolate(stencil, cuts.least.data(), 1);
        const Real high = nestgrid::detail::interpolate(stencil, cuts.greatest.data(), 1);
        Real& least = cuts.least[corners + n];
        Real& greatest = cuts.greatest[corners + n];
        least = std::min(least, low);
        greatest = std::max(greatest, high);
    }
}

/// Leaves an element whose children were shown.
template <class Real>
void PathCuts<Real>::leave() {
    const auto& at = rows_.last();
    const Cuts& cuts = cuts_[rows_.depth() - 1];
    const double eta = std::max(cuts.below, measure_.greatest(cuts.own, at.columns));
    if (eta > 0) report_(at.made, eta);
    leave_unsplit();
}

template <class Real>
void PathCuts<Real>::leave_unsplit() {
    const std::size_t depth = rows_.depth();
    const Cuts& cuts = cuts_[depth - 1];
    if (cuts.own > cuts.for_above) {
        double& below = cuts_[depth - 2].below;
        below = std::max(below, measure_.greatest(cuts.for_above, cuts.own));
    }
    rows_.leave();
}

template class PathCuts<float>;
template class PathCuts<double>;

}  // namespace nestgrid::engine
