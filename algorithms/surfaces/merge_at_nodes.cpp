// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/merge_at_nodes.hpp>

#include <algorithm>

#include <surfaces/collapsed_fans.hpp>
#include <surfaces/collinear_triangles.hpp>
#include <surfaces/node_classes.hpp>
#include <surfaces/vertex_links.hpp>

namespace nestgrid::engine {

namespace {

using Vertex = std::uint32_t;
using Edge = std::array<Vertex, 2>;

class NodeMerge {
public:
    NodeMerge(Surface<3>& surface, const VerticesAtNodes& at_nodes)
        : surface_{surface}, classes_{surface, at_nodes} {}

    std::vector<std::uint32_t> run() {
        do {
            rename();
            on_line_ = remove_collapsed_fans(triangles_, classes_);
            remove_collinear(
                triangles_, [&](Vertex v) { return classes_.position(v); },
                [&](Vertex v) { return bool{on_line_[v]}; });
            links_.find(triangles_, on_line_);
            if (cancel_pairs()) links_.find(triangles_, on_line_);
        } while (classes_.join_neighbours(triangles_) ||
                 classes_.split_nonmanifold_classes(links_));
        find_boundary();
        return rewrite();
    }

private:
    void rename();
    bool cancel_pairs();
    void find_boundary();
    std::vector<std::uint32_t> rewrite();

    Surface<3>& surface_;
    NodeClasses classes_;
    std::vector<NumberedTriangle> triangles_;
    std::vector<bool> on_line_;  // by vertex: whether merging and flips may have changed its link
    VertexLinks links_;          // of the vertices marked in on_line_
};

/// Renames the vertices of all triangles, and leaves out those that repeat a vertex.
void NodeMerge::rename() {
    triangles_.clear();
    for (std::uint32_t s = 0; s < surface_.simplices.size(); ++s) {
        const auto& v = surface_.simplices[s];
        const NumberedTriangle t{
            {classes_.renamed(v[0]), classes_.renamed(v[1]), classes_.renamed(v[2])}, s};
        if (t.v[0] != t.v[1] && t.v[1] != t.v[2] && t.v[2] != t.v[0]) triangles_.push_back(t);
    }
}

/// Removes pairs of triangles with the same merged vertices and opposite orientations.
/// \return whether there were any
bool NodeMerge::cancel_pairs() {
    const auto is_merged = [&](Vertex v) { return classes_.is_merged(v); };
    links_.for_each([&](Vertex v, VertexLink link) {
        for (const OppositeSide& side : link) {
            const auto [a, b] = side.edge;
            if (v > a || v > b || a > b) continue;
            if (!is_merged(v) || !is_merged(a) || !is_merged(b)) continue;
            const Edge turned{b, a};
            const auto back = std::ranges::find_if(link, [&](const OppositeSide& other) {
                return other.edge == turned &&
                       triangles_[other.triangle].from != NumberedTriangle::removed;
            });
            if (back == link.end()) continue;
            triangles_[side.triangle].from = NumberedTriangle::removed;
            triangles_[back->triangle].from = NumberedTriangle::removed;
        }
    });
    return erase_removed(triangles_) > 0;
}

/// Keeps the boundary edges that nothing changed, and adds those changed ones that one triangle
/// alone has.
void NodeMerge::find_boundary() {
    auto& boundary = surface_.boundary;
    for (auto& ridge : boundary) ridge = {classes_.renamed(ridge[0]), classes_.renamed(ridge[1])};
    const auto is_changed = [&](const Edge& edge) {
        return on_line_[edge[0]] || on_line_[edge[1]];
    };
    std::erase_if(boundary, is_changed);
    links_.for_each([&](Vertex v, VertexLink link) {
        const auto any = [&](std::size_t end, Vertex at) {
            return std::ranges::any_of(link,
                                       [&](const OppositeSide& s) { return s.edge[end] == at; });
        };
        for (const OppositeSide& side : link) {
            const auto [from, to] = side.edge;
            if (!any(1, from)) boundary.push_back({v, from});
            if (!on_line_[to] && !any(0, to)) boundary.push_back({to, v});
        }
    });
}

/// Writes the result into the surface, vertices in their old order. \return their numbers
std::vector<std::uint32_t> NodeMerge::rewrite() {
    std::vector<Vertex> number(surface_.vertices.size(), dropped);
    for (const NumberedTriangle& t : triangles_) {
        for (const Vertex v : t.v) number[v] = 0;
    }
    const std::size_t stride =
        number.empty() ? 0 : surface_.attributes.size() / surface_.vertices.size();
    Vertex next = 0;
    for (Vertex v = 0; v < number.size(); ++v) {
        if (number[v] == dropped) continue;
        std::copy_n(classes_.attributes(v, stride), stride,
                    surface_.attributes.data() + next * stride);
        surface_.vertices[next] = classes_.position(v);
        if (!surface_.normals.empty()) surface_.normals[next] = surface_.normals[v];
        number[v] = next++;
    }
    surface_.vertices.resize(next);
    surface_.attributes.resize(next * stride);
    if (!surface_.normals.empty()) surface_.normals.resize(next);
    std::vector<Surface<3>::Simplex> simplices;
    std::vector<std::uint32_t> element_of;
    for (const NumberedTriangle& t : triangles_) {
        simplices.push_back({number[t.v[0]], number[t.v[1]], number[t.v[2]]});
        if (!surface_.element_of.empty()) element_of.push_back(surface_.element_of[t.from]);
    }
    surface_.simplices = std::move(simplices);
    surface_.element_of = std::move(element_of);
    for (auto& [a, b] : surface_.boundary) {
        a = number[a];
        b = number[b];
    }
    return number;
}

}  // namespace

std::vector<std::uint32_t> merge_at_nodes(Surface<3>& surface, const VerticesAtNodes& at_nodes) {
    if (at_nodes.vertex.empty()) return {};
    return NodeMerge(surface, at_nodes).run();
}

}  // namespace nestgrid::engine
