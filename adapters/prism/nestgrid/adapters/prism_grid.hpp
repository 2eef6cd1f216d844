// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Prisms, triangle times segment, refined into 8 (isotropic), 4 (horizontal) or 2 (vertical).
//
// Invariants:
//   - the isotropic rule is horizontal, then vertical; so the node in the middle of a
//     quadrilateral face lies between the midpoints of its lower and its upper edge;
//   - where a face is refined in both directions, all elements at it did so in the same order.
// Consequence: every node has one stencil. A mixture that would give a node two is refused.
#pragma once

#include <nestgrid/adapters/stored_grid.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// The family of prisms in eight parts: what StoredGrid asks of it.
struct Prism {
    static constexpr int dimension = 3;
    static constexpr int max_corners = 6;
    static constexpr int max_new_nodes = 12;
    static constexpr int max_children = 8;
    static constexpr Shape only_shape = Shape::prism;
    static constexpr int pattern_height = 1;
    static constexpr bool conforming = false;
    static constexpr const char* name = "prism";

    static bool refines(Shape s) { return s == Shape::prism; }

    static std::shared_ptr<const Rule> make_rule(std::uint64_t descriptor) {
        if (descriptor > 2) throw InvalidInput("there is no such refinement of a prism");
        return {std::shared_ptr<const Rule>(), &prism_rule(static_cast<PrismSplit>(descriptor))};
    }

    template <class Tree>
    static std::uint16_t rule_for(Tree& tree, const typename Tree::Element&, Mark mark) {
        const PrismSplit split = mark == Mark::refine_horizontally ? PrismSplit::horizontal
                                 : mark == Mark::refine_vertically ? PrismSplit::vertical
                                                                   : PrismSplit::isotropic;
        const auto number = static_cast<std::uint64_t>(split);
        return tree.table.rule(number, false, [&] { return make_rule(number); });
    }

    /// \throw InvalidInput where a node would get two stencils
    template <class Tree>
    void close(const Tree& tree) const {
        for (const auto& e : tree.elements) {
            if (!e.alive || e.rule == 0) continue;
            const auto split = static_cast<PrismSplit>(tree.table.rule(e.rule).descriptor);
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t k = (i + 1) % 3;
                const Face face{e.corner[i], e.corner[k], e.corner[i + 3], e.corner[k + 3]};
                if (split == PrismSplit::vertical) {
                    check_columns(tree, face);
                    continue;
                }
                check_layers(tree, face);
                if (split == PrismSplit::horizontal) continue;
                const std::uint32_t below = tree.midpoint(face[0], face[1]);
                const std::uint32_t above = tree.midpoint(face[2], face[3]);
                check_columns(tree, {face[0], below, face[2], above});
                check_columns(tree, {below, face[1], above, face[3]});
            }
        }
    }

private:
    using Face = std::array<std::uint32_t, 4>;  // in tensor order, the second direction upwards

    /// A face whose layers meet columns on one side: no layer of it may be cut into columns, for
    /// the node there would lie between the sides of the face, not between top and bottom.
    template <class Tree>
    static void check_layers(const Tree& tree, const Face& f) {
        const std::uint32_t p = tree.midpoint(f[0], f[2]);
        const std::uint32_t q = tree.midpoint(f[1], f[3]);
        if (p == no_node || q == no_node) return;
        refuse_if_there(tree, tree.midpoint(p, q));
        check_layers(tree, {f[0], f[1], p, q});
        check_layers(tree, {p, q, f[2], f[3]});
    }
    /// check_layers() with layers and columns exchanged.
    template <class Tree>
    static void check_columns(const Tree& tree, const Face& f) {
        const std::uint32_t p = tree.midpoint(f[0], f[1]);
        const std::uint32_t q = tree.midpoint(f[2], f[3]);
        if (p == no_node || q == no_node) return;
        refuse_if_there(tree, tree.midpoint(p, q));
        check_columns(tree, {f[0], p, f[2], q});
        check_columns(tree, {p, f[1], q, f[3]});
    }
    template <class Tree>
    static void refuse_if_there(const Tree& tree, std::uint32_t node) {
        if (node == no_node) return;
        throw InvalidInput("prisms at the face around " + text_of(tree.position[node]) +
                           " are refined horizontally and then vertically, and the other way "
                           "round: the node in its middle would have two stencils");
    }
};

/// Adaptive prisms.
using PrismGrid = StoredGrid<Prism>;

// Compiled in the library.
extern template class StoredGrid<Prism>;
namespace detail {
extern template class Rewrite<Prism>;
extern template class ErasedHierarchy<PrismGrid, NodeField<PrismGrid, float>>;
extern template class ErasedHierarchy<PrismGrid, NodeField<PrismGrid, double>>;
}  // namespace detail

/// Unit normals at the nodes of an oriented surface: the mean of those around, by area.
std::vector<Point> node_normals(const CoarseGrid& surface);

/// Layers of prisms over a surface of triangles.
/// \param surface oriented; its nodes move along `direction` for each layer
/// \param thickness of each layer, from the surface on, > 0
/// \param direction of any length; where there is none, along the normals at the nodes
/// \throw InvalidInput for other shapes, no layer, or a thickness or direction that is no positive
///        number
CoarseGrid extrude(const CoarseGrid& surface, std::span<const double> thickness,
                   const std::optional<Point>& direction = std::nullopt);

}  // namespace nestgrid
