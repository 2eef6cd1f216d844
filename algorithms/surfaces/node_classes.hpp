// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Classes of the vertices of a surface at one node, which edges of the surface connect.
//
// Invariants:
//   - a vertex at no node is a class of its own; the least vertex of a class is its root;
//   - a class is merged, and then its root stands for it at the node; or it is taken apart, for
//     good, and its vertices keep their places.
#pragma once

#include <span>
#include <vector>

#include <nestgrid/detail/union_find.hpp>
#include <surfaces/collinear_triangles.hpp>
#include <surfaces/surface_builder.hpp>
#include <surfaces/vertex_links.hpp>

namespace nestgrid::engine {

class NodeClasses {
public:
    using Vertex = std::uint32_t;

    /// Merges all classes at nodes. Borrows both; the surface keeps its vertices while it does.
    NodeClasses(const Surface<3>& surface, const VerticesAtNodes& at_nodes);

    /// The vertex that stands for a vertex: the root of a merged class, or the vertex itself.
    Vertex renamed(Vertex v) {
        const Vertex root = classes_.root(v);
        return merged_[root] ? root : v;
    }
    /// Whether a vertex stands for a merged class.
    bool is_merged(Vertex v) const { return merged_[v]; }
    /// By vertex: whether it stands for a merged class.
    const std::vector<bool>& merged() const { return merged_; }

    /// Where a vertex that stands for itself or for a class lies.
    const Point& position(Vertex v) const {
        return merged_[v] ? at_nodes_.node[entry_[v]].x : surface_.vertices[v];
    }
    /// Its attributes.
    /// \param stride the number of them
    const double* attributes(Vertex v, std::size_t stride) const {
        return merged_[v] ? at_nodes_.attributes.data() + entry_[v] * stride
                          : surface_.attributes.data() + v * stride;
    }

    /// Joins merged classes at one node that have come to share a side of a triangle.
    /// \return whether there were any
    bool join_neighbours(std::span<const NumberedTriangle> triangles);
    /// Takes the classes apart at which the surface is no manifold: where two triangles run along
    /// an edge the same way, and where the triangles around a vertex are not one fan. Also those
    /// whose fan is folded, so that no normal agrees with all of its triangles.
    /// \param links of all vertices that stand for classes, at least
    /// \return whether there were any
    bool split_nonmanifold_classes(const VertexLinks& links);

private:
    NodeKey key(Vertex v) const { return at_nodes_.node[entry_[v]].key; }
    bool is_folded(Vertex v, VertexLink link) const;

    const Surface<3>& surface_;
    const VerticesAtNodes& at_nodes_;
    std::vector<std::uint32_t> entry_;  // by vertex: its place in at_nodes_, or none
    nestgrid::detail::UnionFind classes_;
    std::vector<bool> merged_;  // by root
};

}  // namespace nestgrid::engine
