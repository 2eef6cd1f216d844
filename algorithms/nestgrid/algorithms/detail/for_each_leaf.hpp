// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::detail {

/// Takes a leaf and the keys of its corners.
using LeafFunction = std::function<void(const Handle& leaf, std::span<const NodeKey> corner_keys)>;

/// Calls a function for every leaf that is not hidden, in order.
void for_each_leaf(const Hierarchy<float>& hierarchy, const LeafFunction& function);

}  // namespace nestgrid::detail
