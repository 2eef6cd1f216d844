// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes that no collapse may take to the other side of a surface.
//
// Where a surface on which |U - C| <= e is replaced by another one, a connected part of U > C + e
// (of U < C - e) is swept wholly or not at all. If wholly, then with all of its nodes. One of these
// is a corner of a leaf near C, as such a part ends in leaves where |U - C| <= e somewhere. So it
// is enough to keep, of these nodes, those whose |U - C| no neighbour on the same side exceeds: the
// greatest one of each part is among them.
#pragma once

#include <collapses/near_leaves.hpp>

namespace nestgrid::engine {

using Tetrahedron = std::array<Point, 4>;

class StrongNodes {
public:
    explicit StrongNodes(const NearLeaves& leaves);

    std::size_t size() const { return position_.size(); }
    /// Whether any of the nodes lies in a box.
    bool any_in(const Box& box) const;
    /// Whether any of the nodes lies in a tetrahedron.
    bool any_in(const Tetrahedron& x) const;

private:
    std::vector<Point> position_;
    BoxTree tree_;
};

}  // namespace nestgrid::engine
