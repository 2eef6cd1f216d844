// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/finest_piece.hpp>

#include <algorithm>

namespace nestgrid::engine {

template <class Real>
std::size_t FinestPiece<Real>::Corners::find(NodeKey of) const {
    const auto end = key.begin() + static_cast<std::ptrdiff_t>(count);
    const auto at = std::find(key.begin(), end, of);
    return at == end ? none : static_cast<std::size_t>(at - key.begin());
}

template <class Real>
void FinestPiece<Real>::load(const View& view) {
    corners_.count = view.corner_count();
    walk_->corners(view, corners_.key.data(), corners_.x.data());
}

template <class Real>
auto FinestPiece<Real>::end(const View& view, std::size_t corner, double along) const -> End {
    const std::size_t components = walk_->components();
    const Real* const value = view.value + corner * components;
    return {corners_.key[corner], corners_.x[corner], along, {value, value + components}};
}

template <class Real>
auto FinestPiece<Real>::find(const View& view, std::size_t low, std::size_t high,
                             const Level<Real>& level) -> const std::array<End, 2>& {
    level_ = &level;
    load(view);
    piece_ = {end(view, low, 0), end(view, high, 1)};
    halves_ = finished_ = false;
    walk_->walk_below(view, *this);
    return piece_;
}

/// Goes down along the piece. The value of a new node is known once a child has it as a corner.
template <class Real>
Decision FinestPiece<Real>::inspect(const View& view, const Split& split) {
    if (finished_) return {Visit::skip, 0};
    load(view);
    if (halves_) {
        const std::size_t corner = corners_.find(middle_);
        if (corner == Corners::none) return {Visit::skip, 0};
        take_middle(view, corner);
    }
    const std::size_t low = corners_.find(piece_[0].key);
    const std::size_t high = corners_.find(piece_[1].key);
    if (low == Corners::none || high == Corners::none) return {Visit::skip, 0};
    finished_ = split.rule == nullptr;
    if (finished_) return {Visit::skip, 0};
    look_for_middle(split, low, high);
    return {Visit::descend, 0};
}

template <class Real>
void FinestPiece<Real>::take_middle(const View& view, std::size_t corner) {
    halves_ = false;
    End middle = end(view, corner, along_);
    const bool inside = middle.value[level_->component] >= level_->least_inside;
    piece_[inside ? 1 : 0] = std::move(middle);
}

template <class Real>
void FinestPiece<Real>::look_for_middle(const Split& split, std::size_t low, std::size_t high) {
    const auto& stencils = split.rule->new_nodes;
    for (std::size_t n = 0; n < stencils.size(); ++n) {
        const Stencil& s = stencils[n];
        if (s.count != 2) continue;
        const bool ahead = s.parent[0] == low && s.parent[1] == high;
        if (!ahead && (s.parent[0] != high || s.parent[1] != low)) continue;
        middle_ = split.keys[n];
        const double weight = s.weight[ahead ? 1 : 0];
        along_ = piece_[0].along + weight * (piece_[1].along - piece_[0].along);
        halves_ = true;
        return;
    }
}

template class FinestPiece<float>;
template class FinestPiece<double>;

}  // namespace nestgrid::engine
