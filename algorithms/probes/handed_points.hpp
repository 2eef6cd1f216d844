// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an element hands to its children: points with their reference coordinates in a child, and
// the number of that child in the place of an element's.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <probes/child_maps.hpp>
#include <probes/coarse_search.hpp>

namespace nestgrid::engine {

/// Hands each point of a group to the child that it is deepest in; those without any are left out.
void hand_to_deepest(const ChildMaps& maps, std::span<const PointInElement> group,
                     std::vector<PointInElement>& handed);

/// Points that were handed to children, child by child. Keeps its memory.
class HandedPoints {
public:
    /// Takes points in the place of those it has. \return the children that have any
    NodeMask sort(std::span<const PointInElement> handed, std::size_t children);
    /// The points of a child.
    std::span<PointInElement> of(std::size_t child) {
        return std::span(points_).subspan(first_[child], first_[child + 1] - first_[child]);
    }

private:
    std::vector<PointInElement> points_;
    std::array<std::size_t, max_children + 1> first_{};  // of each child
};

}  // namespace nestgrid::engine
