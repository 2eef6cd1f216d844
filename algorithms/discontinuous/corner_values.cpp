// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <discontinuous/corner_values.hpp>

#include <bit>
#include <cmath>

#include <nestgrid/error.hpp>

namespace nestgrid::engine {

CornerValues::CornerValues(const DiscontinuousData& data)
    : data_{&data},
      components_{static_cast<std::size_t>(data.components())},
      task_{data.grid().open()},
      of_leaf_(max_corners * components_) {}

std::span<const double> CornerValues::of_leaf(const Handle& leaf, std::size_t corners) {
    const std::span<double> values = std::span(of_leaf_).first(corners * components_);
    data_->leaf_values(leaf, values);
    for (const double value : values) {
        if (std::isfinite(value)) continue;
        throw InvalidInput("a value at a corner of a leaf is not a finite number");
    }
    return values;
}

void CornerValues::put(const Handle& element, const Rule* rule, Shape shape, double* out,
                       std::size_t stride) {
    Places places{};
    for (std::size_t k = 0; k < topology(shape).corners; ++k) places[k] = out + k * stride;
    put(element, rule, shape, places, 0);
}

void CornerValues::put(const Handle& element, const Rule* rule, Shape shape, const Places& places,
                       std::size_t depth) {
    const std::size_t corners = topology(shape).corners;
    if (rule == nullptr) {
        const std::span<const double> values = of_leaf(element, corners);
        for (std::size_t k = 0; k < corners; ++k) {
            if (places[k] == nullptr) continue;
            std::copy_n(values.data() + k * components_, components_, places[k]);
        }
        return;
    }
    NodeMask wanted = 0;
    for (std::size_t k = 0; k < corners; ++k) {
        if (places[k] != nullptr) wanted |= NodeMask{1} << rule->old_corner[k].child;
    }
    if (families_.size() <= depth) families_.emplace_back();
    Family& family = families_[depth];
    data_->grid().enter(task_.get(), element, *rule, 0, nullptr, wanted, family);
    for (NodeMask left = wanted; left != 0; left &= left - 1) {
        const auto c = static_cast<std::size_t>(std::countr_zero(left));
        Places of_child{};
        for (std::size_t k = 0; k < corners; ++k) {
            const ChildCorner& at = rule->old_corner[k];
            if (at.child == c) of_child[at.corner] = places[k];
        }
        const Member& child = family.members[c];
        put(child.element, child.rule, rule->children[c].shape, of_child, depth + 1);
    }
}

}  // namespace nestgrid::engine
