// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Invariant: an edge or face is covered where some leaf has it, or where it lies in a covered one
// of the father. New nodes of covered edges and faces hang.
#include <ranks/hanging_across.hpp>

#include <algorithm>
#include <bit>
#include <optional>
#include <string>

#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid::engine {

namespace {

NodeKey part_key(std::span<const NodeKey> corners) {
    FaceKey key;
    for (const NodeKey corner : corners) key.add_corner(corner);
    return key.key() + corners.size();
}

/// Calls function(is face, number, keys of the corners) for the edges and faces of an element.
template <class Function>
void for_each_part(const Topology& t, std::span<const NodeKey> keys, Function&& function) {
    std::array<NodeKey, 4> part;
    for (std::size_t e = 0; e < t.edges; ++e) {
        for (std::size_t i = 0; i < 2; ++i) part[i] = keys[t.edge[e][i]];
        function(false, e, std::span<const NodeKey>(part).first(2));
    }
    for (std::size_t f = 0; t.dimension == 3 && f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        for (std::size_t i = 0; i < face.corners; ++i) part[i] = keys[face.corner[i]];
        function(true, f, std::span<const NodeKey>(part).first(face.corners));
    }
}

/// Edges and faces of an element, one bit each.
struct Parts {
    std::uint32_t edges = 0;
    std::uint32_t faces = 0;
};

/// Whether both ends of an edge of a child lie in a part of its father.
/// \param corners of the part
/// \param inner new nodes inside the part, one bit each
bool lies_in(const Rule& rule, std::span<const std::uint8_t> ends,
             std::span<const std::uint8_t> corners, NodeMask inner) {
    const auto count = static_cast<std::size_t>(rule.corner_count());
    return std::all_of(ends.begin(), ends.end(), [&](std::uint8_t node) {
        if (node >= count) return (inner >> (node - count) & 1U) != 0;
        return std::find(corners.begin(), corners.end(), node) != corners.end();
    });
}

bool edge_lies_in(const Parts& covered, const Rule& rule, std::span<const std::uint8_t> ends) {
    const Topology& father = topology(rule.parent);
    for (std::uint32_t left = covered.edges; left != 0; left &= left - 1) {
        const RuleEdge& edge = rule.edges[static_cast<std::size_t>(std::countr_zero(left))];
        if (lies_in(rule, ends, edge.end, edge.inner)) return true;
    }
    for (std::uint32_t left = father.dimension == 3 ? covered.faces : 0; left != 0;
         left &= left - 1) {
        const RuleFace& face = rule.faces[static_cast<std::size_t>(std::countr_zero(left))];
        if (lies_in(rule, ends, std::span(face.corner).first(face.corners), face.inner))
            return true;
    }
    return false;
}

/// The edges and faces of a child that lie in covered ones of its father.
Parts handed_down(const Parts& covered, const Rule& rule, const Child& child, const Topology& t) {
    Parts parts;
    if ((covered.edges | covered.faces) == 0) return parts;
    for (std::size_t e = 0; e < t.edges; ++e) {
        const std::array<std::uint8_t, 2> ends{child.corner[t.edge[e][0]],
                                               child.corner[t.edge[e][1]]};
        parts.edges |= std::uint32_t{edge_lies_in(covered, rule, ends)} << e;
    }
    for (std::size_t f = 0; t.dimension == 3 && f < t.faces; ++f) {
        const std::uint8_t g = child.parent_face[f];
        if (g != no_face && (covered.faces >> g & 1U) != 0) parts.faces |= 1U << f;
    }
    return parts;
}

NodeMask nodes_inside(const Parts& covered, const Rule& rule) {
    NodeMask nodes = 0;
    for (std::uint32_t left = covered.edges; left != 0; left &= left - 1) {
        nodes |= rule.edges[static_cast<std::size_t>(std::countr_zero(left))].inner;
    }
    for (std::uint32_t left = rule.faces.empty() ? 0 : covered.faces; left != 0; left &= left - 1) {
        nodes |= rule.faces[static_cast<std::size_t>(std::countr_zero(left))].inner;
    }
    return nodes;
}

class HangingAcross {
public:
    HangingAcross(const Hierarchy<float>& grid, const SharedNodes& shared)
        : walk_(grid, {.values = false, .keys = true, .on_ranks = true}),
          shared_{&shared},
          box_(shared.ranks().size()) {}

    /// Collects the edges and faces of own leaves, and notes those that others may have, too.
    void collect() {
        for_each_element(walk_, false, [&](const ElementView<float>& view, const Split& split) {
            if (split.rule != nullptr) return;
            walk_.corners(view, keys_.data(), nullptr);
            for_each_part(view.topology(), keys_,
                          [&](bool, std::size_t, std::span<const NodeKey> corners) {
                              const NodeKey key = part_key(corners);
                              if (!of_leaves_.insert(key, {}).second) return;
                              shared_->route(corners, box_, [&](Bytes& out) { put(out, key); });
                          });
        });
    }
    void exchange() {
        shared_->send(box_, [&](int, Reader& in) {
            while (in.more()) of_leaves_.insert(in.get<NodeKey>(), {});
        });
    }
    HangingNodes find() {
        for_each_element(walk_, true, [&](const ElementView<float>& view, const Split& split) {
            if (split.rule != nullptr) add_split(view, split);
        });
        return std::move(hanging_);
    }

private:
    struct Present {};

    void add_split(const ElementView<float>& view, const Split& split) {
        Parts parts;
        if (view.father != nullptr) {
            const auto above = static_cast<std::size_t>(view.level) - 1;
            parts = handed_down(covered_[above], *view.made_by, *view.as, view.topology());
        }
        walk_.corners(view, keys_.data(), nullptr);
        for_each_part(view.topology(), keys_,
                      [&](bool is_face, std::size_t i, std::span<const NodeKey> corners) {
                          if (of_leaves_.find(part_key(corners)) == nullptr) return;
                          (is_face ? parts.faces : parts.edges) |= 1U << i;
                      });
        covered_.resize(static_cast<std::size_t>(view.level) + 1);
        covered_.back() = parts;
        for (NodeMask left = nodes_inside(parts, *split.rule); left != 0; left &= left - 1) {
            const auto n = static_cast<std::size_t>(std::countr_zero(left));
            if (split.rule->new_nodes[n].mean == Mean::weighted) refuse_weights(view);
            hanging_.insert(split.keys[n]);
        }
    }
    [[noreturn]] static void refuse_weights(const ElementView<float>& view) {
        throw GridError("below coarse element " + std::to_string(view.coarse) +
                        " a node hangs that is not in the middle of its parents, which is not made "
                        "for distributed grids yet");
    }

    Walk<float> walk_;
    const SharedNodes* shared_;
    Outbox box_;
    KeyTable<NodeKey, Present> of_leaves_;
    std::vector<Parts> covered_;  // of the elements above, by level
    std::array<NodeKey, max_corners> keys_{};
    HangingNodes hanging_;
};

}  // namespace

HangingNodes hanging_across(const Hierarchy<float>& grid, const SharedNodes& shared) {
    std::optional<HangingAcross> search;
    together(&shared, [&] {
        search.emplace(grid, shared);
        search->collect();
    });
    search->exchange();
    HangingNodes hanging;
    together(&shared, [&] { hanging = search->find(); });
    return hanging;
}

}  // namespace nestgrid::engine
