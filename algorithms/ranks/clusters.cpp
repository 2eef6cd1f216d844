// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/clusters.hpp>

#include <algorithm>

#include <surfaces/collinear_triangles.hpp>

namespace nestgrid::engine {

namespace {

constexpr std::uint32_t no_entry = ~std::uint32_t{0};

/// Whether a triangle comes to lie on one line where some of its vertices are put at their nodes.
/// \param node of each vertex, or null
bool may_collapse(const std::array<Point, 3>& x, const std::array<const Point*, 3>& node) {
    for (unsigned moved = 1; moved < 8; ++moved) {
        std::array<Point, 3> at = x;
        bool can = true;
        for (std::size_t k = 0; k < 3; ++k) {
            if ((moved >> k & 1U) == 0) continue;
            can = can && node[k] != nullptr;
            if (can) at[k] = *node[k];
        }
        if (can && are_collinear(at[0], at[1], at[2])) return true;
    }
    return false;
}

}  // namespace

Clusters::Clusters(Ranks& ranks, const Surface<3>& piece, const VerticesAtNodes& at_nodes,
                   std::span<const VertexCopy> copies)
    : strong_(piece.vertices.size(), false), classes_{piece.vertices.size()} {
    const auto is_strong = [&](std::uint32_t v) { return bool{strong_[v]}; };
    find_strong(piece, at_nodes);
    tell_copies(
        ranks, copies, is_strong, [](Bytes&, std::uint32_t) {},
        [&](std::uint32_t v, Reader&, int) { strong_[v] = true; });
    join(piece);
    across_.emplace(ranks, copies, is_strong, cluster_);
}

/// Vertices at nodes, and those of triangles that may collapse with one.
void Clusters::find_strong(const Surface<3>& piece, const VerticesAtNodes& at_nodes) {
    std::vector<std::uint32_t> entry(strong_.size(), no_entry);
    for (std::uint32_t i = 0; i < at_nodes.vertex.size(); ++i) {
        entry[at_nodes.vertex[i]] = i;
        strong_[at_nodes.vertex[i]] = true;
    }
    for (const auto& v : piece.simplices) {
        std::array<Point, 3> x;
        std::array<const Point*, 3> node{};
        for (std::size_t k = 0; k < 3; ++k) {
            x[k] = piece.vertices[v[k]];
            if (entry[v[k]] != no_entry) node[k] = &at_nodes.node[entry[v[k]]].x;
        }
        const auto moved = std::ranges::count(node, nullptr);
        if (moved == 0 || moved == 3 || !may_collapse(x, node)) continue;
        for (const std::uint32_t k : v) strong_[k] = true;
    }
}

void Clusters::join(const Surface<3>& piece) {
    for (const auto& v : piece.simplices) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = v[k];
            const std::uint32_t b = v[(k + 1) % 3];
            if (strong_[a] && strong_[b]) classes_.join(a, b);
        }
    }
    for (std::uint32_t v = 0; v < strong_.size(); ++v) cluster_.push_back(classes_.root(v));
}

int Clusters::rank_of(std::span<const std::uint32_t> vertices) const {
    const auto strong =
        std::ranges::find_if(vertices, [&](std::uint32_t v) { return bool{strong_[v]}; });
    if (strong == vertices.end()) return here;
    const int* const rank = across_->least_rank(cluster_[*strong]);
    return rank == nullptr ? here : *rank;
}

}  // namespace nestgrid::engine
