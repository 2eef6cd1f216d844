// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <height_fields/element_sides.hpp>

#include <utility>

namespace nestgrid::engine {

template <class Real>
void ElementSides<Real>::load(const View& view) {
    view_ = &view;
    walk_->corners(view, key_.data(), x_.data());
}

template <class Real>
ElementSide ElementSides<Real>::side(std::size_t edge) const {
    const auto [a, b] = view_->topology().edge[edge];
    const MaximalEdge<Real>& maximal = *view_->closed.edge(edge);
    const KeyPair around(maximal.key(0), maximal.key(1));
    auto [from, to] = walk_->positions(maximal);
    if (maximal.key(0) != around.low) std::swap(from, to);
    return {{a, b}, around, {dot(x_[a] - from, to - from), dot(x_[b] - from, to - from)}};
}

template <class Real>
void ElementSides<Real>::record(EdgeNodes& nodes) {
    for (std::size_t e = 0; e < view_->topology().edges; ++e) {
        if (view_->closed.edge(e) == nullptr) continue;
        const ElementSide at = side(e);
        const std::size_t end = at.rises() ? 1 : 0;
        const std::size_t corner = at.corner[end];
        if (key_[corner] == at.around.low || key_[corner] == at.around.high) continue;
        nodes.add({at.around, at.place[end], key_[corner], x_[corner], 0}, values(corner));
    }
}

template class ElementSides<float>;
template class ElementSides<double>;

}  // namespace nestgrid::engine
