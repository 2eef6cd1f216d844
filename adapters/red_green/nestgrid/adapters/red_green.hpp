// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Red-green refinement (Bank, Sherman, Weiser 1983; Bey 1995): elements are refined red, into 4 or
// 8 of their own shape; what would hang is closed green. Green elements are never refined: where
// they should be, their father is refined red instead.
//
// Invariants after every adaptation:
//   - the grid conforms;
//   - an element with a split edge is red or green, and one with an edge split twice is red.
// Grids of mixed shapes: triangles with quadrilaterals; the closure of hexahedra brings
// tetrahedra, pyramids and prisms (green_rules.hpp).
#pragma once

#include <bit>
#include <tuple>

#include <nestgrid/adapters/green_rules.hpp>
#include <nestgrid/adapters/stored_grid.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// \tparam corners at most as many has a coarse element
template <int dim, int corners = 1 << dim>
struct RedGreen {
    static_assert(dim == 2 || dim == 3);
    static constexpr int dimension = dim;
    static constexpr int max_corners = corners;
    static constexpr int max_new_nodes = dim == 2 ? 5 : corners == 4 ? 6 : 19;
    static constexpr int max_children = dim == 2 ? 4 : corners == 4 ? 8 : 30;
    static constexpr int pattern_height = 1;
    static constexpr bool conforming = true;
    static constexpr const char* name = "red-green";

    static bool refines(Shape s) {
        return topology(s).dimension == dim && topology(s).corners <= corners &&
               (is_simplex(s) || s == Shape::quadrilateral || s == Shape::hexahedron);
    }

    /// Red rules are the shape, and the diagonal times 16; green ones a GreenState.
    static std::shared_ptr<const Rule> make_rule(std::uint64_t descriptor) {
        const auto shape = static_cast<Shape>(descriptor & 0xFU);
        if ((descriptor & 0xFU) >= static_cast<unsigned>(shape_count)) {
            throw InvalidInput("there is no shape " + std::to_string(descriptor & 0xFU));
        }
        if (is_temporary(descriptor)) {
            const GreenState state = GreenState::from(descriptor);
            const Topology& t = topology(shape);
            if (state.descriptor() != descriptor || !refines(shape) ||
                state.edges >> t.edges != 0 || (state.faces != 0 && shape != Shape::hexahedron)) {
                throw InvalidInput("there is no such green rule");
            }
            return green_rule(state);
        }
        const auto diagonal = static_cast<int>(descriptor >> 4U);
        if (descriptor > 0x2FU || !refines(shape) ||
            (diagonal > 0 && shape != Shape::tetrahedron)) {
            throw InvalidInput("there is no such red rule");
        }
        const Rule& rule = shape == Shape::triangle      ? red_triangle_rule()
                           : shape == Shape::tetrahedron ? red_tetrahedron_rule(diagonal)
                                                         : dyadic_rule(shape);
        return {std::shared_ptr<const Rule>(), &rule};
    }
    static bool is_temporary(std::uint64_t descriptor) {
        return (descriptor & GreenState::green) != 0;
    }

    template <class Tree>
    static std::uint16_t rule_for(Tree& tree, const typename Tree::Element& e, Mark mark) {
        if (mark != Mark::refine) throw InvalidInput("red-green has no rule for this mark");
        return red(tree, e);
    }

    template <class Tree>
    void close(Tree& tree) const {
        tree.close([&](const typename Tree::Element& e) -> std::uint16_t {
            return must_be_red(tree, e) ? red(tree, e) : std::uint16_t{0};
        });
        const auto count = static_cast<std::uint32_t>(tree.elements.size());
        for (std::uint32_t e = 0; e < count; ++e) {
            if (!tree.is_leaf(tree.elements[e])) continue;
            const std::uint16_t rule = green(tree, tree.elements[e]);
            if (rule != 0) tree.refine(e, rule);
        }
    }

private:
    /// The red rule; for a tetrahedron that with the shortest diagonal.
    template <class Tree>
    static std::uint16_t red(Tree& tree, const typename Tree::Element& e) {
        std::size_t diagonal = 0;
        if (e.shape == Shape::tetrahedron) {
            std::array<Point, 4> x;
            for (std::size_t i = 0; i < 4; ++i) x[i] = tree.position[e.corner[i]];
            // Twice the diagonals of the inner octahedron.
            const std::array<double, 3> length{norm(x[0] + x[2] - x[1] - x[3]),
                                               norm(x[0] + x[1] - x[2] - x[3]),
                                               norm(x[0] + x[3] - x[1] - x[2])};
            for (const std::size_t d : {1U, 2U}) {
                if (length[d] < length[diagonal] * (1 - 1e-12)) diagonal = d;
            }
        }
        const std::uint64_t descriptor =
            static_cast<std::uint64_t>(e.shape) | std::uint64_t{diagonal} << 4U;
        return tree.table.rule(descriptor, false, [&] { return make_rule(descriptor); });
    }

    /// Midpoints of split edges, and which edges are split.
    template <class Tree>
    static std::uint32_t split_edges(const Tree& tree, const typename Tree::Element& e,
                                     std::array<std::uint32_t, 12>& middle) {
        const Topology& t = topology(e.shape);
        std::uint32_t split = 0;
        for (std::size_t i = 0; i < t.edges; ++i) {
            middle[i] = tree.midpoint(e.corner[t.edge[i][0]], e.corner[t.edge[i][1]]);
            if (middle[i] != no_node) split |= 1U << i;
        }
        return split;
    }

    template <class Tree>
    static bool must_be_red(const Tree& tree, const typename Tree::Element& e) {
        std::array<std::uint32_t, 12> middle;
        const std::uint32_t split = split_edges(tree, e, middle);
        if (split == 0) return false;
        if (!has_green_rule(e.shape, split)) return true;
        const Topology& t = topology(e.shape);
        for (std::size_t i = 0; i < t.edges; ++i) {
            if (middle[i] != no_node && tree.half_split(middle[i])) return true;
        }
        if (e.shape != Shape::tetrahedron || std::popcount(split) != 3) return false;
        // A face refined red on its other side: its inner edges may be split, too.
        std::array<std::uint32_t, 3> m;
        std::size_t n = 0;
        for (std::size_t i = 0; i < t.edges; ++i) {
            if (middle[i] != no_node) m[n++] = middle[i];
        }
        return tree.midpoint(m[0], m[1]) != no_node || tree.midpoint(m[1], m[2]) != no_node ||
               tree.midpoint(m[2], m[0]) != no_node;
    }

    template <class Tree>
    static std::uint16_t green(Tree& tree, const typename Tree::Element& e) {
        std::array<std::uint32_t, 12> middle;
        GreenState state{e.shape, split_edges(tree, e, middle), 0, false};
        if (state.edges == 0) return 0;
        const Topology& t = topology(e.shape);
        if (e.shape == Shape::tetrahedron && std::popcount(state.edges) == 2) {
            const auto first = static_cast<std::size_t>(std::countr_zero(state.edges));
            const auto second = static_cast<std::size_t>(31 - std::countl_zero(state.edges));
            const auto [a, b] = t.edge[first];
            const auto [c, d] = t.edge[second];
            if (a == c || a == d || b == c || b == d) {
                const Point& p = tree.position[e.corner[a == c || a == d ? b : a]];
                const Point& q = tree.position[e.corner[c == a || c == b ? d : c]];
                const double from_p = norm(tree.position[middle[second]] - p);
                const double from_q = norm(tree.position[middle[first]] - q);
                state.other_diagonal = std::tie(from_q, q) < std::tie(from_p, p);
            }
        }
        for (std::size_t f = 0; e.shape == Shape::hexahedron && f < t.faces; ++f) {
            state.faces |= std::uint32_t{has_centre(tree, e, t.face[f])} << f;
        }
        const std::uint64_t descriptor = state.descriptor();
        return tree.table.rule(descriptor, true, [&] { return green_rule(state); });
    }

    template <class Tree>
    static bool has_centre(const Tree& tree, const typename Tree::Element& e,
                           const FaceTopology& face) {
        const auto at = [&](int i) { return e.corner[face.tensor_corner(i)]; };
        const std::array<std::uint32_t, 4> m{
            tree.midpoint(at(0), at(1)), tree.midpoint(at(2), at(3)), tree.midpoint(at(0), at(2)),
            tree.midpoint(at(1), at(3))};
        return std::find(m.begin(), m.end(), no_node) == m.end() && tree.centre(m) != no_node;
    }
};

/// Adaptive triangles and quadrilaterals (dim = 2, in the plane or in space), tetrahedra and
/// hexahedra (3).
template <int dim>
using RedGreenGrid = StoredGrid<RedGreen<dim>>;

/// Triangles (2) or tetrahedra (3) only: smaller and faster.
template <int dim>
using RedGreenSimplices = StoredGrid<RedGreen<dim, dim + 1>>;

// Compiled in the library.
extern template class StoredGrid<RedGreen<2>>;
extern template class StoredGrid<RedGreen<3>>;
extern template class StoredGrid<RedGreen<2, 3>>;
extern template class StoredGrid<RedGreen<3, 4>>;
namespace detail {
extern template class Rewrite<RedGreen<2>>;
extern template class Rewrite<RedGreen<3>>;
extern template class Rewrite<RedGreen<2, 3>>;
extern template class Rewrite<RedGreen<3, 4>>;
extern template class ErasedHierarchy<RedGreenGrid<2>, NodeField<RedGreenGrid<2>, float>>;
extern template class ErasedHierarchy<RedGreenGrid<2>, NodeField<RedGreenGrid<2>, double>>;
extern template class ErasedHierarchy<RedGreenGrid<3>, NodeField<RedGreenGrid<3>, float>>;
extern template class ErasedHierarchy<RedGreenGrid<3>, NodeField<RedGreenGrid<3>, double>>;
extern template class ErasedHierarchy<RedGreenSimplices<2>, NodeField<RedGreenSimplices<2>, float>>;
extern template class ErasedHierarchy<RedGreenSimplices<2>,
                                      NodeField<RedGreenSimplices<2>, double>>;
extern template class ErasedHierarchy<RedGreenSimplices<3>, NodeField<RedGreenSimplices<3>, float>>;
extern template class ErasedHierarchy<RedGreenSimplices<3>,
                                      NodeField<RedGreenSimplices<3>, double>>;
}  // namespace detail

}  // namespace nestgrid
