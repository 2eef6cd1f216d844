// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::detail {

/// A leaf, and the keys and positions of its corners.
struct LeafView {
    Handle element;
    Shape shape = Shape::point;
    std::span<const NodeKey> keys;
    std::span<const Point> positions;
};

using LeafFunction = std::function<void(const LeafView&)>;

/// Calls a function for every leaf of this rank that is not hidden, in order.
void for_each_leaf(const Hierarchy<float>& hierarchy, const LeafFunction& function);

}  // namespace nestgrid::detail
