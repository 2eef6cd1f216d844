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

namespace {

bool is_simplex(const Topology& t) { return t.corners == t.dimension + 1U; }

bool is_between(double isovalue, double low, double high) {
    return low < isovalue && high >= isovalue;
}

/// 1 / slope; the greatest number where that is none.
double inverse(double slope) {
    constexpr double most = std::numeric_limits<double>::max();
    return slope > 1 / most ? 1 / slope : most;
}

}  // namespace

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
    const std::size_t own = leaf ? 0 : is_simplex(view.topology()) ? 1 : 2;
    rows_.enter(view, (for_above ? 2 : 0) + own);
    begin_columns(view, own);
    const double bound =
        leaf ? 0 : static_cast<double>(request_.bounds->bound(*split.rule, split.keys));
    const bool seen = is_to_be_seen(view, bound);
    if (leaf && seen) measure_leaf(view);
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
    for (std::size_t k = 0; k < at.corners; ++k) {
        cuts.value[k] = static_cast<double>(view.value[k * walk_->components()]);
    }
    const std::size_t room = std::max(greatest_.size(), at.stride);
    greatest_.resize(room);
    most_.resize(room);
    std::fill(greatest_.begin() + static_cast<std::ptrdiff_t>(cuts.for_above),
              greatest_.begin() + static_cast<std::ptrdiff_t>(at.stride), 0.0);
    if (cuts.own > cuts.for_above) begin_for_above(view);
    if (own > 0) {
        const auto u = std::span<const double>(cuts.value).first(at.corners);
        const double off = own == 1 ? 0 : 2 * residual(view, u);
        for (std::size_t k = 0; k < at.corners; ++k) {
            at.row(k)[cuts.own] = u[k] - off;
            at.row(k)[at.columns - 1] = u[k] + off;
        }
    }
    if (!request_.distances) return;
    std::array<Point, max_corners> x;
    walk_->corners(view, nullptr, x.data());
    std::fill(most_.begin() + static_cast<std::ptrdiff_t>(cuts.for_above),
              most_.begin() + static_cast<std::ptrdiff_t>(at.stride),
              diameter_of(std::span(x).first(at.corners)));
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
    if (width == 0 || is_simplex(view.topology())) return;
    const double off = 2 * (residual(view, std::span(middle).first(at.corners)) + 0.5 * width);
    for (std::size_t k = 0; k < at.corners; ++k) {
        at.row(k)[column] -= off;
        at.row(k)[column + 1] += off;
    }
}

template <class Real>
double PathCuts<Real>::residual(const View& view, std::span<const double> u) const {
    std::array<Point, max_corners> x;
    walk_->corners(view, nullptr, x.data());
    return affine_residual(std::span<const Point>(x).first(u.size()), u);
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

/// Whether C lies between the data and any function, in the last element or below it.
/// \param bound the data stay within their corner values +- this
template <class Real>
bool PathCuts<Real>::is_to_be_seen(const View& view, double bound) {
    const auto& at = rows_.last();
    column_low_.assign(at.row(0), at.row(0) + at.stride);
    column_high_ = column_low_;
    for (std::size_t k = 1; k < at.corners; ++k) {
        const double* const row = at.row(k);
        for (std::size_t i = 0; i < at.stride; ++i) {
            column_low_[i] = std::min(column_low_[i], row[i]);
            column_high_[i] = std::max(column_high_[i], row[i]);
        }
    }
    return std::ranges::any_of(
        request_.isovalues, [&](double isovalue) { return is_to_be_seen(view, isovalue, bound); });
}

template <class Real>
bool PathCuts<Real>::is_to_be_seen(const View& view, double isovalue, double bound) {
    const auto& at = rows_.last();
    const auto u = std::span(cuts_[rows_.depth() - 1].value).first(at.corners);
    const auto [least, greatest] = std::ranges::minmax(u);
    if (is_between(isovalue, least - bound, greatest + bound)) return true;
    const bool inside = least >= isovalue;
    const double error = std::max(std::abs(least - isovalue), std::abs(greatest - isovalue));
    bool seen = false;
    for (std::size_t i = 0; i < at.columns; ++i) {
        const bool differs = inside ? column_low_[i] < isovalue : column_high_[i] >= isovalue;
        if (!differs) continue;
        seen = is_between(isovalue, column_low_[i], column_high_[i]) ||
               raise_one_sided(view, i, error, bound) || seen;
    }
    return seen;
}

/// Measures a function that lies on one side in the last element while the data lie on the other.
/// \param error the greatest one at corners; `bound` what it may grow by below the element
/// \return whether elements below may have a greater error than is known of this function
template <class Real>
bool PathCuts<Real>::raise_one_sided(const View& view, std::size_t column, double error,
                                     double bound) {
    constexpr double rounding = 1 + 0x1p-50;
    double& greatest = greatest_[column];
    if (!request_.distances) return greatest < (error + bound) * rounding;
    if (greatest >= most_[column]) return false;
    const double distance = error * data_per_slope(slopes(view));
    greatest = std::max(greatest, std::min(distance, most_[column]));
    return false;
}

template <class Real>
void PathCuts<Real>::measure_leaf(const View& view) {
    const auto& at = rows_.last();
    if (request_.distances) find_slopes(view);
    if (!request_.distances) per_slope_.assign(at.stride, 1);
    for (const double isovalue : request_.isovalues) {
        for (std::size_t k = 0; k < at.corners; ++k) {
            measure_corner(k, isovalue);
            for (std::size_t j = 0; j < k; ++j) measure_pair(j, k, isovalue);
        }
    }
    if (!request_.distances) return;
    for (std::size_t i = 0; i < at.columns; ++i) greatest_[i] = std::min(greatest_[i], most_[i]);
}

/// Where the data and a function are on different sides at a corner of the leaf.
template <class Real>
void PathCuts<Real>::measure_corner(std::size_t k, double isovalue) {
    const auto& at = rows_.last();
    const double* const row = at.row(k);
    const double u = cuts_[rows_.depth() - 1].value[k] - isovalue;
    const double error = std::abs(u) * data_per_slope_;
    const bool inside = u >= 0;
    for (std::size_t i = 0; i < at.stride; ++i) {
        const double off = (row[i] >= isovalue) != inside ? error : 0.0;
        greatest_[i] = greatest_[i] < off ? off : greatest_[i];
    }
}

/// Between two corners of the leaf: the data where a function has the isovalue, and the function
/// where the data have it.
template <class Real>
void PathCuts<Real>::measure_pair(std::size_t j, std::size_t k, double isovalue) {
    const auto& at = rows_.last();
    const Cuts& cuts = cuts_[rows_.depth() - 1];
    const double* const a = at.row(j);
    const double* const b = at.row(k);
    const double* const per_slope = per_slope_.data();
    double* const greatest = greatest_.data();
    const double u0 = cuts.value[j] - isovalue;
    const double u1 = cuts.value[k] - isovalue;
    const bool cut = (u0 >= 0) != (u1 >= 0);
    const double t = cut ? u0 / (u0 - u1) : 0;
    const double of_data = data_per_slope_;
    const double of_function = cut ? 1 : 0;
    for (std::size_t i = 0; i < at.stride; ++i) {
        const double v0 = a[i] - isovalue;
        const double v1 = b[i] - isovalue;
        const bool crosses = (v0 >= 0) != (v1 >= 0);
        const double w = v0 / (crosses ? v0 - v1 : 1.0);
        const double drawn = std::abs(u0 + w * (u1 - u0)) * of_data;
        const double back = std::abs(v0 + t * (v1 - v0)) * of_function * per_slope[i];
        const double error = crosses && drawn > back ? drawn : back;
        greatest[i] = greatest[i] < error ? error : greatest[i];
    }
}

template <class Real>
AffineSlopes PathCuts<Real>::slopes(const View& view) const {
    std::array<Point, max_corners> x;
    walk_->corners(view, nullptr, x.data());
    return {std::span<const Point>(x).first(view.corner_count()), view.topology().dimension};
}

template <class Real>
double PathCuts<Real>::data_per_slope(const AffineSlopes& slopes) const {
    const auto& u = cuts_[rows_.depth() - 1].value;
    return inverse(slopes.slope([&](std::size_t k) { return u[k]; }));
}

/// The slopes of the data and of all functions in a leaf.
template <class Real>
void PathCuts<Real>::find_slopes(const View& view) {
    const auto& at = rows_.last();
    const AffineSlopes in_leaf = slopes(view);
    data_per_slope_ = data_per_slope(in_leaf);
    per_slope_.assign(at.stride, 0);
    for (std::size_t i = 0; i < at.columns; ++i) {
        per_slope_[i] = inverse(in_leaf.slope([&](std::size_t k) { return at.row(k)[i]; }));
    }
}

template <class Real>
double PathCuts<Real>::greatest_of(std::size_t first, std::size_t last) const {
    double greatest = 0;
    for (std::size_t i = first; i < last; ++i) greatest = std::max(greatest, greatest_[i]);
    return greatest;
}

/// Leaves an element whose children were shown.
template <class Real>
void PathCuts<Real>::leave() {
    const auto& at = rows_.last();
    const Cuts& cuts = cuts_[rows_.depth() - 1];
    const double eta = std::max(cuts.below, greatest_of(cuts.own, at.columns));
    if (eta > 0) report_(at.made, eta);
    leave_unsplit();
}

template <class Real>
void PathCuts<Real>::leave_unsplit() {
    const std::size_t depth = rows_.depth();
    const Cuts& cuts = cuts_[depth - 1];
    if (cuts.own > cuts.for_above) {
        double& below = cuts_[depth - 2].below;
        below = std::max(below, greatest_of(cuts.for_above, cuts.own));
    }
    rows_.leave();
}

template class PathCuts<float>;
template class PathCuts<double>;

}  // namespace nestgrid::engine
