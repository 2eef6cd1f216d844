// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/crossed_parts.hpp>

#include <algorithm>
#include <bit>

#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <walk/crossing_nodes.hpp>

namespace nestgrid::engine {

namespace {

/// Puts the field's value at a node that does not hang into `to`.
/// \param values room for a split
template <class Real>
void ask_field(const Hierarchy<Real>& hierarchy, const CrossingNodes& crossing,
               const FixedNode& node, Task* task, std::vector<Real>& values, Real* to) {
    NodeMask missing = 0;
    std::size_t corners = 0;
    if (node.rule != nullptr) {
        if (hierarchy.facts().decodes) {
            throw GridError(
                "nodes hang on others than their parents, where a field cannot be decoded");
        }
        corners = static_cast<std::size_t>(node.rule->corner_count());
        missing = hierarchy.new_values(task, crossing.elements().handle(node.element), *node.rule,
                                       NodeMask{1} << node.node, values.data());
    } else {
        Coarse coarse;
        Family family;
        hierarchy.coarse(task, node.element, coarse, family);
        missing = hierarchy.coarse_values(task, node.element, topology(coarse.shape).corners,
                                          values.data());
    }
    if ((missing >> node.node & 1U) != 0) {
        throw GridError("the field has no value at a node between which another one hangs");
    }
    const auto components = static_cast<std::size_t>(hierarchy.facts().components);
    std::copy_n(values.data() + (corners + node.node) * components, components, to);
}

bool is_among(std::size_t node, NodeMask nodes, std::size_t corners) {
    return node >= corners && (nodes >> (node - corners) & 1U) != 0;
}

}  // namespace

template <class Real>
FixedNodes<Real>::FixedNodes(const Hierarchy<Real>& hierarchy, const CrossingNodes& crossing,
                             bool with_values, const PositionFunctions* functions)
    : crossing_{&crossing},
      components_{static_cast<std::size_t>(hierarchy.facts().components)},
      function_count_{functions == nullptr ? 0 : functions->count()} {
    const std::vector<FixedNode>& nodes = crossing.nodes();
    const std::unique_ptr<Task> task = hierarchy.open();
    std::vector<Real> values((max_corners + max_new_nodes) * components_);
    value_.resize(with_values ? nodes.size() * components_ : 0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const FixedNode& node = nodes[i];
        key_.push_back(node.key);
        position_.push_back(node.position);
        if (!with_values) continue;
        Real* const to = value_.data() + i * components_;
        if (!node.hangs) {
            ask_field(hierarchy, crossing, node, task.get(), values, to);
            if (functions != nullptr) functions->put(node.position, to);
            continue;
        }
        for (std::size_t p = 0; p < node.stencil.count; ++p) {
            std::copy_n(value_.data() + node.parent[p] * components_, components_,
                        values.data() + p * components_);
        }
        for (std::size_t c = 0; c < components_; ++c) {
            to[c] = detail::interpolate(node.stencil, values.data() + c, components_);
            if (c >= function_count_) continue;
            to[c] = static_cast<Real>(functions->rounded(c, static_cast<double>(to[c])));
        }
    }
    nodes_.key = key_.data();
    nodes_.value = value_.data();
    nodes_.components = components_;
    nodes_.places = position_.data();
}

template <class Real>
NodeMask FixedNodes<Real>::mask(std::span<const NodeKey> keys) const {
    NodeMask result = 0;
    for (std::size_t n = 0; n < keys.size(); ++n) {
        result |= NodeMask{crossing_->find(keys[n]) != nullptr} << n;
    }
    return result;
}

template <class Real>
void FixedNodes<Real>::put_values(const Split& split, Real* value) const {
    for (NodeMask left = split.crossing; left != 0; left &= left - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(left));
        const std::size_t number = *crossing_->find(split.keys[n]);
        std::copy_n(value_.data() + number * components_, components_, value + n * components_);
    }
}

template <class Real>
void FixedNodes<Real>::put_functions(NodeKey key, Real* out) const {
    const std::size_t number = *crossing_->find(key);
    std::copy_n(value_.data() + number * components_, function_count_, out);
}

template <class Real>
NodeMask FixedNodes<Real>::put_positions(std::span<const NodeKey> keys, Point* x) const {
    const NodeMask fixed = mask(keys);
    for (NodeMask left = fixed; left != 0; left &= left - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(left));
        x[n] = position_[*crossing_->find(keys[n])];
    }
    return fixed;
}

/// The longest edge that an edge is a part of because its ends hang; or null.
template <class Real>
const MaximalEdge<Real>* FixedNodes<Real>::around_edge(std::array<NodeKey, 2> edge,
                                                       CrossedParts<Real>& parts) const {
    if (!crossing_->extend(edge)) return nullptr;
    while (crossing_->extend(edge)) {
    }
    // Both ends are parents of fixed nodes that hang, so they are fixed.
    return &parts.edges.emplace_back(
        MaximalEdge<Real>{&nodes_, {*crossing_->find(edge[0]), *crossing_->find(edge[1])}});
}

/// The least closed face that a quadrilateral is a part of because two of its corners halve edges
/// of that face; or null.
/// \param corner in tensor order
/// \param parts takes that face and the closed faces around it
template <class Real>
const ClosedFace* FixedNodes<Real>::around_face(std::array<NodeKey, 4> corner,
                                                CrossedParts<Real>& parts) const {
    const ClosedFace* least = nullptr;
    ClosedFace* last = nullptr;
    for (int failed = 0; failed < 2;) {
        std::array<NodeKey, 2> low{corner[0], corner[1]};
        std::array<NodeKey, 2> high{corner[2], corner[3]};
        const bool extends = crossing_->extend(low) && crossing_->extend(high);
        if (!extends || (low[0] == corner[0]) != (high[0] == corner[2])) {
            std::swap(corner[1], corner[2]);
            ++failed;
            continue;
        }
        failed = 0;
        const std::size_t halving = low[0] == corner[0] ? 1 : 0;
        const std::array between{corner[halving], corner[halving + 2]};
        corner = {low[0], low[1], high[0], high[1]};
        ClosedFace& face = parts.faces.emplace_back(corner, between).face;
        (last == nullptr ? least : last->outer) = &face;
        last = &face;
    }
    return least;
}

template <class Real>
void FixedNodes<Real>::close_parts(const Split& split, NodeMask mean, ClosingSplit<Real>& closing,
                                   CrossedSplit<Real>& crossed) const {
    const Rule& rule = *split.rule;
    const Topology& t = topology(rule.parent);
    const NodeKey* const key = closing.split.key;
    crossed.of_rule.clear();
    for (std::size_t e = t.edges; e < rule.edges.size(); ++e) {
        const auto& [a, b] = rule.edges[e].end;
        const bool crosses =
            is_among(a, split.crossing, t.corners) || is_among(b, split.crossing, t.corners);
        if (!crosses || closing.edge[e] == nullptr) continue;
        const auto* outer = around_edge({key[a], key[b]}, crossed.of_rule);
        if (outer != nullptr) closing.edge[e] = outer;
    }
    for (std::size_t f = t.faces; f < rule.faces.size(); ++f) {
        const RuleFace& face = rule.faces[f];
        const auto corners = std::span(face.corner).first(face.corners);
        const bool crosses = std::ranges::any_of(
            corners, [&](std::size_t n) { return is_among(n, split.crossing, t.corners); });
        if (!crosses || face.corners != 4) continue;
        const auto& c = face.corner;
        closing.closed_face[f].outer =
            around_face({key[c[0]], key[c[1]], key[c[3]], key[c[2]]}, crossed.of_rule);
        const bool closes = face.divided && (face.inner & ~mean) == 0;
        closing.face[f] = closes ? &closing.closed_face[f] : closing.closed_face[f].outer;
    }
}

template <class Real>
ClosedParts<Real> FixedNodes<Real>::around(const Split& split, const ClosingSplit<Real>& closing,
                                           const Child& child, CrossedSplit<Real>& crossed) const {
    ClosedParts<Real> parts = closing.around(child);
    const Topology& t = topology(child.shape);
    const auto corners = static_cast<std::size_t>(split.rule->corner_count());
    const NodeKey* const key = closing.split.key;
    const auto crosses = [&](std::size_t k) {
        return is_among(child.corner[k], split.crossing, corners);
    };
    crossed.of_child.clear();
    bool any = false;
    for (std::uint8_t e = 0; e < t.edges; ++e) {
        const auto& [a, b] = t.edge[e];
        crossed.child.rule_edge[e] = e;
        crossed.around_edge[e] = parts.edge(e);
        if (!crosses(a) && !crosses(b)) continue;
        any = true;
        const auto* around =
            around_edge({key[child.corner[a]], key[child.corner[b]]}, crossed.of_child);
        if (around != nullptr) crossed.around_edge[e] = around;
    }
    for (std::uint8_t f = 0; f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        crossed.child.rule_face[f] = f;
        crossed.around_face[f] = parts.face(f);
        if (face.corners != 4) continue;
        // close_parts() did what is to be done for nodes that are corners of a part around it.
        const std::uint8_t part = child.rule_face[f];
        const auto is_new = [&](std::uint8_t node) {
            return part == no_face || std::ranges::count(split.rule->faces[part].corner, node) == 0;
        };
        std::array<NodeKey, 4> corner{};
        bool has_crossing = false;
        for (int i = 0; i < 4; ++i) {
            const auto k = static_cast<std::size_t>(face.tensor_corner(i));
            corner[static_cast<std::size_t>(i)] = key[child.corner[k]];
            has_crossing = has_crossing || (crosses(k) && is_new(child.corner[k]));
        }
        if (has_crossing) crossed.around_face[f] = around_face(corner, crossed.of_child);
    }
    if (!any) return parts;
    return {true, true, &crossed.child, crossed.around_edge.data(), crossed.around_face.data()};
}

template class FixedNodes<float>;
template class FixedNodes<double>;

}  // namespace nestgrid::engine
