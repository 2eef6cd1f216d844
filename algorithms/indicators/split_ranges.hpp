// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The least and the greatest value in every divided element, from one walk over all of them.
#pragma once

#include <functional>
#include <span>

#include <nestgrid/algorithms/indicator.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// What tells a divided element from others: its new node, where there is one, or one is inside;
/// else a hash of all of them. Elements that share their only new node share the name.
struct SplitName {
    NodeKey key;
    bool is_node;
};
inline SplitName name_of_split(const Rule& rule, std::span<const NodeKey> nodes) {
    if (rule.inside != no_new_node) return {nodes[rule.inside], true};
    if (nodes.size() == 1) return {nodes.front(), true};
    NodeKey all{0};
    for (const NodeKey node : nodes) all = detail::mix(all + node);
    return {all, false};
}

/// Takes how far the values in a divided element leave the range of its corners, rounded up.
using TakeRange = std::function<void(const SplitName& name, float beyond)>;

/// Walks all elements and tells of the divided ones, by one thread at a time.
///
/// \throw InvalidInput as SplitBounds
template <class Real>
detail::PrerollFacts walk_ranges(const Walk<Real>& walk, const Executor& executor,
                                 const TakeRange& take);

}  // namespace nestgrid::engine
