// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/path_rows.hpp>

#include <algorithm>

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
    const double* const first = rows + stencil.parent[0] * stride;
    for (std::size_t i = 0; i < stride; ++i) {
        double sum = stencil.weight[0] * first[i];
        double low = first[i];
        double high = first[i];
        for (std::size_t p = 1; p < stencil.count; ++p) {
            const double of = rows[stencil.parent[p] * stride + i];
            sum += stencil.weight[p] * of;
            low = std::min(low, of);
            high = std::max(high, of);
        }
        row[i] = std::clamp(sum, low, high);  // rounding leads no mean out of the range
    }
}

}  // namespace

template <class Real>
auto PathRows<Real>::split_above(const View& view) -> const View* {
    const View* above = view.father;
    while (above != nullptr && above->member->rule->new_nodes.empty()) above = above->father;
    return above;
}

template <class Real>
Split PathRows<Real>::split_of(const View& view, SplitKeys& keys) {
    Split split;
    split.rule = view.member->rule;
    const std::size_t corners = view.corner_count();
    const Frame<Real>& frame = view.stack->frame(view.level);
    if (!view.family->keys.empty()) {
        split.keys = view.family->new_keys(*view.member);
    } else {  // the grid has no keys of its own
        std::copy_n(frame.key.begin() + static_cast<std::ptrdiff_t>(corners),
                    split.rule->new_nodes.size(), keys.begin());
        split.keys = std::span(keys).first(split.rule->new_nodes.size());
    }
    return split;
}

template <class Real>
auto PathRows<Real>::enter(const View& view, std::size_t begun) -> Element& {
    if (elements_.size() == depth_) elements_.emplace_back();
    Element& at = elements_[depth_];
    at.coarse = view.coarse;
    at.level = view.level;
    at.path = view.path;
    at.corners = view.corner_count();
    const std::size_t taken = depth_ == 0 ? 0 : elements_[depth_ - 1].columns;
    at.columns = taken + begun;
    at.stride = (at.columns + lanes - 1) / lanes * lanes;
    at.rows.resize(at.corners * at.stride);
    for (std::size_t k = 0; k < at.corners; ++k) at.node[k] = static_cast<std::uint8_t>(k);
    for (const View* v = &view; v->father != nullptr; v = v->father) {
        for (std::size_t k = 0; k < at.corners; ++k) at.node[k] = v->as->corner[at.node[k]];
        if (!v->made_by->new_nodes.empty()) break;
    }
    for (std::size_t k = 0; k < at.corners; ++k) {
        double* const row = at.row(k);
        if (taken > 0) std::copy_n(elements_[depth_ - 1].row(at.node[k]), taken, row);
        std::fill_n(row + taken, at.stride - taken, 0.0);
    }
    ++depth_;
    return at;
}

template <class Real>
void PathRows<Real>::split(const Rule& rule, std::span<const NodeKey> made) {
    Element& at = last();
    at.rule = &rule;
    at.made.assign(made.begin(), made.end());
    at.rows.resize((at.corners + rule.new_nodes.size()) * at.stride);
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        take_mean(rule.new_nodes[n], at.rows.data(), at.stride, at.row(at.corners + n));
    }
}

template class PathRows<float>;
template class PathRows<double>;

}  // namespace nestgrid::engine
