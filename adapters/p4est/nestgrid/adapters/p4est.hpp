// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forests of p4est (quadrilaterals) and p8est (hexahedra), read in place: the hierarchy is the one
// that the sorted arrays of leaves imply, an element is a range of the array of its tree. Balanced
// or not, over any number of trees rotated against each other.
//
// Nodes are named by p4est's own coordinates in the first tree that has them, so keys agree on
// every process; where the forest is distributed, `presence` says which leaves are here, and
// distributed.hpp reaches the others. The forest must stay where it is; after it was refined or
// coarsened, indicators and fields must be made anew (its revision and number of leaves are the
// grid's epoch).
#pragma once

#include <cmath>

#include <nestgrid/adapters/p4est_maps.hpp>
#include <nestgrid/adapters/p4est_trees.hpp>
#include <nestgrid/optional.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// \tparam Map P4estVertices, or any function Point(std::size_t tree, const Point& reference) of
///         coordinates in [0, 1]^dim that is continuous across trees: then positions are those of
///         a curved grid
template <int dim, class Map = P4estVertices>
class P4estGrid {
public:
    using Types = P4estTypes<dim>;
    using Forest = typename Types::Forest;
    using Quadrant = typename Types::Quadrant;
    static constexpr int dimension = dim;
    static constexpr int max_corners = 1 << dim;
    static constexpr int max_new_nodes = dim == 2 ? 5 : 19;
    static constexpr int max_children = 1 << dim;
    static constexpr Shape only_shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;
    static constexpr bool curved = !std::is_same_v<Map, P4estVertices>;

    struct Element {
        std::uint32_t tree;
        std::uint32_t first;  ///< leaf of the tree
        std::uint32_t last;   ///< one behind
        std::array<std::int32_t, 3> anchor;
        std::uint8_t level;
        Presence presence;
    };

    /// \throw InvalidInput where the connectivity has no vertices (and there is no map) or puts one
    ///        node at two places, for flat trees, and as P4estTrees
    explicit P4estGrid(const Forest* forest, Map map = {});

    std::size_t coarse_count() const {
        return static_cast<std::size_t>(forest_->connectivity->num_trees);
    }
    CoarseElement<Element> coarse(std::size_t i) const;
    const Rule* split(const Element& e) const {
        return e.last - e.first == 1 && e.presence == Presence::here ? nullptr : rule_;
    }
    Presence presence(const Element& e) const { return e.presence; }
    void children(const Element& e, std::span<Element> out) const {
        std::uint32_t first = e.first;
        for (unsigned c = 0; c < max_children; ++c) {
            out[c] = child(e, c, first);
            first = out[c].last;
        }
    }
    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        for (unsigned k = 0; k < max_corners; ++k) {
            out[k] = key(
                node(e, {static_cast<std::int8_t>(2 * (k & 1U)), static_cast<std::int8_t>(k & 2U),
                         static_cast<std::int8_t>((k & 4U) / 2)}));
        }
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const {
        for (std::size_t k = 0; k < max_new_nodes; ++k) out[k] = key(node(e, new_node_[k]));
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out) const
        requires(curved) {
        for (std::size_t k = 0; k < max_new_nodes; ++k) {
            if ((which >> k & 1U) != 0) out[k] = mapped(trees_.canonical(node(e, new_node_[k])));
        }
    }
    std::uint64_t epoch() const {
        const auto leaves = static_cast<std::uint64_t>(forest_->global_num_quadrants);
        return leaves << 32U ^ static_cast<std::uint64_t>(forest_->revision);
    }

    // What fields need.
    const Forest& forest() const { return *forest_; }
    std::size_t leaf_count() const {
        return static_cast<std::size_t>(forest_->local_num_quadrants);
    }
    /// Number of a leaf in p4est's order of all leaves here.
    std::size_t leaf_index(const Element& leaf) const {
        return static_cast<std::size_t>(tree(leaf.tree).quadrants_offset) + leaf.first;
    }
    /// p4est's own record of a leaf, with the user's data.
    const Quadrant& quadrant(const Element& leaf) const { return leaf_of(leaf.tree, leaf.first); }
    /// Number of the leaf in a corner of an element, in p4est's order of all leaves here.
    /// \return no_leaf where that is elsewhere
    std::size_t corner_leaf(Element e, unsigned corner) const {
        while (e.presence == Presence::partly || e.presence == Presence::partly_first) {
            e = child(e, corner, bound(e, e.first, corner));
        }
        if (e.presence == Presence::elsewhere) return no_leaf;
        if (corner + 1 == max_corners) e.first = e.last - 1;
        while (corner != 0 && e.last - e.first > 1) {
            e = child(e, corner, bound(e, e.first, corner));
        }
        return leaf_index(e);
    }
    static constexpr std::size_t no_leaf = ~std::size_t{0};

private:
    using Trees = P4estTrees<dim>;

    static const typename Types::Connectivity& checked(const Forest* forest);
    void check_place(std::size_t t);
    void orient();

    const typename Types::Tree& tree(std::size_t t) const {
        return reinterpret_cast<const typename Types::Tree*>(forest_->trees->array)[t];
    }
    const Quadrant& leaf_of(std::size_t t, std::size_t i) const {
        return reinterpret_cast<const Quadrant*>(tree(t).quadrants.array)[i];
    }

    Presence find_presence(const Element& e) const;
    static unsigned child_of(const Quadrant& leaf, unsigned bit);
    std::uint32_t bound(const Element& e, std::uint32_t low, unsigned c) const;
    Element child(const Element& e, unsigned c, std::uint32_t first) const;

    /// The node of an element at `halves` half lengths from its anchor.
    static P4estNode node(const Element& e, const std::array<std::int8_t, 3>& halves) {
        const std::int32_t half = Trees::length >> e.level >> 1;
        P4estNode node{e.tree, e.anchor};
        for (std::size_t d = 0; d < dim; ++d) node.x[d] += halves[d] * half;
        return node;
    }
    NodeKey key(const P4estNode& node) const {
        const auto [t, x] = trees_.canonical(node);
        const auto wide = [](std::int32_t i) { return static_cast<std::uint64_t>(i); };
        return detail::mix(detail::mix(NodeKey{t} << 32U | wide(x[0])) +
                           (wide(x[1]) << 32U | wide(x[2])));
    }

    Point mapped(const P4estNode& node) const requires(curved) {
        Point reference{0, 0, 0};
        for (std::size_t d = 0; d < dim; ++d) {
            reference[d] = static_cast<double>(node.x[d]) / Trees::length;
        }
        return map_(std::size_t{node.tree}, reference);
    }
    Point corner_position(const P4estNode& node) const;

    const Forest* forest_;
    Map map_;
    Trees trees_;
    const Rule* rule_;
    std::array<std::array<std::int8_t, 3>, static_cast<std::size_t>(max_new_nodes)>
        new_node_{};  // in half lengths
    std::vector<std::int8_t> orientation_;
};

P4estGrid(const p4est_t*)->P4estGrid<2>;
P4estGrid(const p8est_t*)->P4estGrid<3>;
template <class Map>
P4estGrid(const p4est_t*, Map) -> P4estGrid<2, Map>;
template <class Map>
P4estGrid(const p8est_t*, Map) -> P4estGrid<3, Map>;

}  // namespace nestgrid

#include <nestgrid/adapters/p4est_balanced.hpp>
#include <nestgrid/adapters/p4est_fields.hpp>
#include <nestgrid/adapters/p4est_steps.hpp>
