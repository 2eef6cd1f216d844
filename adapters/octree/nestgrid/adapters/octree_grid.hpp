// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Adaptive quadtrees and octrees over any coarse grid of quadrilaterals or hexahedra, straight or
// deformed. Nodes hang where neighbours differ; the grid knows which.
#pragma once

#include <nestgrid/adapters/stored_grid.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// The family of quadrilaterals and hexahedra in halves: what StoredGrid asks of it.
template <int dim>
struct Octree {
    static_assert(dim == 2 || dim == 3);
    static constexpr int dimension = dim;
    static constexpr int max_corners = 1 << dim;
    static constexpr int max_new_nodes = dim == 2 ? 5 : 19;
    static constexpr int max_children = 1 << dim;
    static constexpr int pattern_height = 1;
    static constexpr bool conforming = false;
    static constexpr const char* name = "octree";
    static constexpr Shape only_shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;

    /// Elements that share an edge or a face differ by one level at most.
    bool balanced = true;

    std::uint32_t options() const { return balanced ? 1 : 0; }
    static Octree from_options(std::uint32_t options) { return {.balanced = options == 1}; }

    static bool refines(Shape s) { return s == only_shape; }

    static std::shared_ptr<const Rule> make_rule(std::uint64_t descriptor) {
        if (descriptor != 1) throw InvalidInput("an octree has one rule only");
        return {std::shared_ptr<const Rule>(), &dyadic_rule(only_shape)};
    }

    template <class Tree>
    static std::uint16_t halve(Tree& tree) {
        return tree.table.rule(1, false, [] { return make_rule(1); });
    }

    template <class Tree>
    static std::uint16_t rule_for(Tree& tree, const typename Tree::Element&, Mark mark) {
        if (mark != Mark::refine) throw InvalidInput("an octree has no rule for this mark");
        return halve(tree);
    }

    template <class Tree>
    void close(Tree& tree) const {
        if (!balanced) return;
        const Topology& t = topology(only_shape);
        // A face whose other side is two levels finer has halves of its edges split.
        tree.close([&](const typename Tree::Element& e) -> std::uint16_t {
            for (std::size_t i = 0; i < t.edges; ++i) {
                const std::uint32_t m =
                    tree.midpoint(e.corner[t.edge[i][0]], e.corner[t.edge[i][1]]);
                if (m != no_node && tree.half_split(m)) return halve(tree);
            }
            return 0;
        });
    }
};

/// Adaptive quadrilaterals (dim = 2, in the plane or in space) or hexahedra (3).
template <int dim>
using OctreeGrid = StoredGrid<Octree<dim>>;

// Compiled in the library.
extern template class StoredGrid<Octree<2>>;
extern template class StoredGrid<Octree<3>>;
namespace detail {
extern template class Rewrite<Octree<2>>;
extern template class Rewrite<Octree<3>>;
extern template class ErasedHierarchy<OctreeGrid<2>, NodeField<OctreeGrid<2>, float>>;
extern template class ErasedHierarchy<OctreeGrid<2>, NodeField<OctreeGrid<2>, double>>;
extern template class ErasedHierarchy<OctreeGrid<3>, NodeField<OctreeGrid<3>, float>>;
extern template class ErasedHierarchy<OctreeGrid<3>, NodeField<OctreeGrid<3>, double>>;
}  // namespace detail

}  // namespace nestgrid
