// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which nodes of an unpacked hierarchy hang: those on edges and faces of leaves. As in
// HangingProbe, but by node numbers, and faces of prisms and hexahedra only: a triangle is refined
// into four, so no triangle is met on two ways.
#pragma once

#include <nestgrid/adapters/work_tree.hpp>

namespace nestgrid::detail {

template <class Tree>
class HangingMask {
public:
    explicit HangingMask(const Tree& tree)
        : tree_{tree}, mask_((tree.position.size() + 31) / 32, 0) {
        find();
    }
    /// One bit per node.
    std::vector<std::uint32_t> take() { return std::move(mask_); }

private:
    void find();
    bool hang_edge(std::uint32_t a, std::uint32_t b);
    void hang_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    void hang_quadrilateral(const std::array<std::uint32_t, 4>& corner);
    bool hang(std::uint32_t node);

    const Tree& tree_;
    std::vector<std::uint32_t> mask_;
};

/// \return whether the node is there, which then hangs
template <class Tree>
bool HangingMask<Tree>::hang(std::uint32_t node) {
    if (node == no_node) return false;
    mask_[node / 32] |= 1U << node % 32;
    return true;
}

template <class Tree>
bool HangingMask<Tree>::hang_edge(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t m = tree_.midpoint(a, b);
    if (!hang(m)) return false;
    hang_edge(a, m);
    hang_edge(m, b);
    return true;
}

template <class Tree>
void HangingMask<Tree>::hang_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::uint32_t ab = tree_.midpoint(a, b);
    const std::uint32_t bc = tree_.midpoint(b, c);
    const std::uint32_t ca = tree_.midpoint(c, a);
    if (ab == no_node || bc == no_node || ca == no_node) return;
    hang_edge(ab, bc);
    hang_edge(bc, ca);
    hang_edge(ca, ab);
    hang_triangle(a, ab, ca);
    hang_triangle(ab, b, bc);
    hang_triangle(ca, bc, c);
    hang_triangle(ab, bc, ca);
}

/// \param corner in tensor order
template <class Tree>
void HangingMask<Tree>::hang_quadrilateral(const std::array<std::uint32_t, 4>& corner) {
    const auto [a, b, c, d] = corner;
    const std::uint32_t ab = tree_.midpoint(a, b);
    const std::uint32_t cd = tree_.midpoint(c, d);
    const std::uint32_t ac = tree_.midpoint(a, c);
    const std::uint32_t bd = tree_.midpoint(b, d);
    const bool across = ab != no_node && cd != no_node;
    const bool along = ac != no_node && bd != no_node;
    const std::uint32_t m = across && along ? tree_.centre({ab, cd, ac, bd}) : no_node;
    if (m != no_node && tree_.is_centre(m)) {
        hang(m);
        for (const std::uint32_t side : {ab, cd, ac, bd}) hang_edge(side, m);
        hang_quadrilateral({a, ab, ac, m});
        hang_quadrilateral({ab, b, m, bd});
        hang_quadrilateral({ac, m, c, cd});
        hang_quadrilateral({m, bd, cd, d});
        return;
    }
    if (across) {
        hang_edge(ab, cd);
        hang_quadrilateral({a, ab, c, cd});
        hang_quadrilateral({ab, b, cd, d});
    }
    if (along) {
        hang_edge(ac, bd);
        hang_quadrilateral({a, b, ac, bd});
        hang_quadrilateral({ac, bd, c, d});
    }
}

template <class Tree>
void HangingMask<Tree>::find() {
    for (const auto& e : tree_.elements) {
        if (!tree_.is_leaf(e)) continue;
        const Topology& t = topology(e.shape);
        bool whole = true;
        for (std::size_t i = 0; i < t.edges; ++i) {
            if (hang_edge(e.corner[t.edge[i][0]], e.corner[t.edge[i][1]])) whole = false;
        }
        if (whole) continue;  // a face is refined with its edges
        for (std::size_t f = 0; t.dimension == 3 && f < t.faces; ++f) {
            const auto at = [&](int i) { return e.corner[t.face[f].tensor_corner(i)]; };
            if (t.face[f].corners == 3) {
                hang_triangle(at(0), at(1), at(2));
            } else {
                hang_quadrilateral({at(0), at(1), at(2), at(3)});
            }
        }
    }
}

template <class Tree>
std::vector<std::uint32_t> hanging_nodes(const Tree& tree) {
    return HangingMask<Tree>(tree).take();
}

}  // namespace nestgrid::detail
