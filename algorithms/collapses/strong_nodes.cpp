// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/strong_nodes.hpp>

namespace nestgrid::engine {

namespace {

/// Whether a point lies in a tetrahedron, or nearly; never in one without volume.
bool is_in(const Tetrahedron& x, const Point& p) {
    const Point a = x[1] - x[0];
    const Point b = x[2] - x[0];
    const Point c = x[3] - x[0];
    const Point d = p - x[0];
    const double volume = dot(a, cross(b, c));
    const double sign = volume < 0 ? -1 : 1;
    const std::array<double, 3> part{sign * dot(d, cross(b, c)), sign * dot(d, cross(c, a)),
                                     sign * dot(d, cross(a, b))};
    const double all = std::abs(volume);
    const double tolerance = 1e-9 * all;
    const double rest = all - part[0] - part[1] - part[2];
    return all > 0 && std::min({part[0], part[1], part[2], rest}) >= -tolerance;
}

}  // namespace

StrongNodes::StrongNodes(const NearLeaves& leaves) {
    std::vector<bool> strong(leaves.node_count());
    for (std::uint32_t n = 0; n < leaves.node_count(); ++n) {
        strong[n] = std::abs(leaves.value(n)) > leaves.error();
    }
    for (const NearLeaf& leaf : leaves.leaves()) {
        const auto nodes = leaves.nodes(leaf);
        const Topology& t = topology(leaf.shape);
        for (std::size_t e = 0; e < t.edges; ++e) {
            const std::uint32_t a = nodes[t.edge[e][0]];
            const std::uint32_t b = nodes[t.edge[e][1]];
            const double at_a = leaves.value(a);
            const double at_b = leaves.value(b);
            if ((at_a > 0) != (at_b > 0)) continue;
            if (std::abs(at_a) < std::abs(at_b)) strong[a] = false;
            if (std::abs(at_b) < std::abs(at_a)) strong[b] = false;
        }
    }
    for (std::uint32_t n = 0; n < leaves.node_count(); ++n) {
        if (!strong[n]) continue;
        position_.push_back(leaves.position(n));
        tree_.add({position_.back(), position_.back()});
    }
    tree_.finish();
}

bool StrongNodes::any_in(const Box& box) const {
    return !tree_.for_each([&](const Box& b) { return box.meets(b); },
                           [&](std::size_t i) { return !box.contains(position_[i]); });
}

bool StrongNodes::any_in(const Tetrahedron& x) const {
    const Box box = Box::around(x);
    return !tree_.for_each(
        [&](const Box& b) { return box.meets(b); },
        [&](std::size_t i) { return !box.contains(position_[i]) || !is_in(x, position_[i]); });
}

}  // namespace nestgrid::engine
