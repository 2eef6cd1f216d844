// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Adaptive bisection of any conforming coarse grid of triangles or tetrahedra: Maubach's rule
// (1995), which is newest-vertex bisection in two dimensions.
//
// Invariants:
//   - the corners of every coarse element are sorted by a colouring of the nodes in which no two
//     nodes of an element share a colour; its tag is the dimension;
//   - a leaf has no split edge: the grid conforms.
// Consequence: no further condition on the coarse grid. With c colours its elements are faces of
// one simplex of dimension c - 1 whose corners are the colours, and bisecting that simplex bisects
// each of its faces exactly as Maubach's rule does with the sorted corners. So neighbours always
// agree about the face between them, and the closure ends. docs/hierarchies.md has the argument
// (the idea is that of Diening, Gehring and Storn, 2025).
#pragma once

#include <numeric>

#include <nestgrid/adapters/stored_grid.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// The family of simplices that are halved: what StoredGrid asks of it.
template <int dim>
struct Bisection {
    static_assert(dim == 2 || dim == 3);
    static constexpr int dimension = dim;
    static constexpr int max_corners = dim + 1;
    static constexpr int max_new_nodes = 1;
    static constexpr int max_children = 2;
    static constexpr int pattern_height =
        dim;  // after as many bisections the tag is the same again
    static constexpr bool conforming = true;
    static constexpr const char* name = "bisection";
    static constexpr Shape shape = dim == 2 ? Shape::triangle : Shape::tetrahedron;

    static bool refines(Shape s) { return s == shape; }

    /// Rule number `descriptor`, the tag.
    static std::shared_ptr<const Rule> make_rule(std::uint64_t descriptor) {
        if (descriptor < 1 || descriptor > dim) {
            throw InvalidInput("there is no bisection with the tag " + std::to_string(descriptor));
        }
        return {std::shared_ptr<const Rule>(),
                &bisection_rule(shape, static_cast<int>(descriptor))};
    }

    /// Sorts the corners of every element by colour.
    std::vector<std::int8_t> prepare(CoarseGrid& grid) const {
        const std::vector<std::uint32_t> colour = node_colours(grid);
        std::vector<std::int8_t> orientation(grid.element_count(), 1);
        for (std::size_t e = 0; e < grid.element_count(); ++e) {
            const auto nodes = grid.element(e);
            for (std::size_t i = 1; i < nodes.size(); ++i) {
                for (std::size_t k = i; k > 0 && colour[nodes[k]] < colour[nodes[k - 1]]; --k) {
                    std::swap(nodes[k], nodes[k - 1]);
                    orientation[e] = static_cast<std::int8_t>(-orientation[e]);
                }
            }
        }
        return orientation;
    }
    /// Whether the corners of all elements are sorted by one order of the nodes.
    bool is_prepared(const CoarseGrid& grid) const { return has_common_order(grid); }

    template <class Tree>
    static std::uint16_t bisect(Tree& tree, const typename Tree::Element& e) {
        const auto tag = static_cast<std::uint64_t>(dim - e.level % dim);
        return tree.table.rule(tag, false, [&] { return make_rule(tag); });
    }

    template <class Tree>
    static std::uint16_t rule_for(Tree& tree, const typename Tree::Element& e, Mark mark) {
        if (mark != Mark::refine) throw InvalidInput("bisection has no rule for this mark");
        return bisect(tree, e);
    }

    template <class Tree>
    void close(Tree& tree) const {
        tree.close([&](const typename Tree::Element& e) -> std::uint16_t {
            for (std::size_t i = 0; i <= dim; ++i) {
                for (std::size_t k = 0; k < i; ++k) {
                    if (tree.midpoint(e.corner[i], e.corner[k]) != no_node) return bisect(tree, e);
                }
            }
            return 0;
        });
    }
};

/// Adaptive triangles (dim = 2, in the plane or in space) or tetrahedra (3).
template <int dim>
using BisectionGrid = StoredGrid<Bisection<dim>>;

// Compiled in the library.
extern template class StoredGrid<Bisection<2>>;
extern template class StoredGrid<Bisection<3>>;
namespace detail {
extern template class Rewrite<Bisection<2>>;
extern template class Rewrite<Bisection<3>>;
extern template class ErasedHierarchy<BisectionGrid<2>, NodeField<BisectionGrid<2>, float>>;
extern template class ErasedHierarchy<BisectionGrid<2>, NodeField<BisectionGrid<2>, double>>;
extern template class ErasedHierarchy<BisectionGrid<3>, NodeField<BisectionGrid<3>, float>>;
extern template class ErasedHierarchy<BisectionGrid<3>, NodeField<BisectionGrid<3>, double>>;
}  // namespace detail

}  // namespace nestgrid
