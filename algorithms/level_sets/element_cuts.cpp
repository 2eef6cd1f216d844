// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/element_cuts.hpp>

#include <algorithm>

#include <nestgrid/detail/shape_functions.hpp>

namespace nestgrid::engine {

template <class Real>
SurfaceCut ElementCuts<Real>::cut(std::uint8_t edge) const {
    const auto* const maximal = view_->closed.edge(edge);
    const auto& corner = view_->topology().edge[edge];
    const auto value = [&](std::size_t end, std::size_t component) {
        return static_cast<double>(maximal != nullptr
                                       ? maximal->value(end, component)
                                       : view_->value[corner[end] * components_ + component]);
    };
    const auto key = [&](std::size_t end) {
        return maximal != nullptr ? maximal->key(end) : key_[corner[end]];
    };
    const std::array<Point, 2> x =
        maximal != nullptr ? walk_->positions(*maximal) : std::array{x_[corner[0]], x_[corner[1]]};
    const std::size_t component = level_->component;
    const std::size_t low = value(0, component) >= level_->value ? 1 : 0;
    const std::size_t high = 1 - low;
    if (maximal == nullptr && cuts_finest()) return finest_cut(corner[low], corner[high]);
    SurfaceCut cut;
    cut.node = {key(low), key(high)};
    cut.fraction = level_->fraction(value(low, component), value(high, component));
    cut.x = x[low] + cut.fraction * (x[high] - x[low]);
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
        const double from = value(low, first_attribute_ + i);
        attributes_[i] = from + cut.fraction * (value(high, first_attribute_ + i) - from);
    }
    cut.attributes = attributes_;
    return cut;
}

/// The cut of the edge between two corners on its finest piece.
template <class Real>
SurfaceCut ElementCuts<Real>::finest_cut(std::size_t low, std::size_t high) const {
    const auto& [from, to] = finest_.find(*view_, low, high, *level_);
    const auto value = [](const auto& end, std::size_t component) {
        return static_cast<double>(end.value[component]);
    };
    const std::size_t component = level_->component;
    const double fraction = level_->fraction(value(from, component), value(to, component));
    SurfaceCut cut;
    cut.node = {key_[low], key_[high]};
    cut.fraction = from.along + fraction * (to.along - from.along);
    cut.x = from.x + fraction * (to.x - from.x);
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
        const double a = value(from, first_attribute_ + i);
        attributes_[i] = a + fraction * (value(to, first_attribute_ + i) - a);
    }
    cut.attributes = attributes_;
    if (to.along - from.along < 1) {
        const double drawn = u(low) + cut.fraction * (u(high) - u(low));
        off_level_ = std::max(off_level_, std::abs(drawn));
    }
    return cut;
}

template <class Real>
void ElementCuts<Real>::positions_of_any(std::span<const std::uint8_t> edges, unsigned inside,
                                         Point* out) const {
    for (const std::uint8_t edge : edges) {
        const bool closed = view_->closed.edge(edge) != nullptr;
        *out++ = closed ? cut(edge).x : plain_cut(edge, inside).x;
    }
}

template <class Real>
SurfaceCut ElementCuts<Real>::node(std::size_t corner) const {
    const Real* const value = view_->value + corner * components_ + first_attribute_;
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
        attributes_[i] = static_cast<double>(value[i]);
    }
    return {x_[corner], {key_[corner], key_[corner]}, 0, attributes_};
}

template <class Real>
std::span<const double> ElementCuts<Real>::attributes_at(const Point& reference) const {
    if (attributes_.empty()) return {};
    std::ranges::fill(attributes_, 0.0);
    const auto weight = shape_functions(view_->shape, reference);
    for (std::size_t c = 0; c < view_->corner_count(); ++c) {
        const Real* const value = view_->value + c * components_ + first_attribute_;
        for (std::size_t i = 0; i < attributes_.size(); ++i) {
            attributes_[i] += weight[c] * static_cast<double>(value[i]);
        }
    }
    return attributes_;
}

template class ElementCuts<float>;
template class ElementCuts<double>;

}  // namespace nestgrid::engine
