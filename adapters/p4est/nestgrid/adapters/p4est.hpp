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

#include <algorithm>
#include <cmath>
#include <span>

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
    int rank_count() const { return forest_->mpisize; }
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

template <int dim, class Map>
P4estGrid<dim, Map>::P4estGrid(const Forest* forest, Map map)
    : forest_{forest},
      map_{std::move(map)},
      trees_{checked(forest)},
      rule_{&dyadic_rule(dim == 2 ? Shape::quadrilateral : Shape::hexahedron)} {
    const std::vector<Point> reference = reference_nodes(*rule_);
    for (std::size_t k = 0; k < max_new_nodes; ++k) {
        for (std::size_t d = 0; d < dim; ++d) {
            new_node_[k][d] = static_cast<std::int8_t>(2 * reference[max_corners + k][d]);
        }
    }
    orientation_.assign(coarse_count(), 1);
    for (std::size_t t = 0; t < coarse_count(); ++t) check_place(t);
    orient();
}

template <int dim, class Map>
const typename P4estTypes<dim>::Connectivity& P4estGrid<dim, Map>::checked(const Forest* forest) {
    if (forest == nullptr) throw InvalidInput("there is no forest");
    if (!curved && forest->connectivity->vertices == nullptr) {
        throw InvalidInput(
            "the connectivity of the forest has no vertices; give a map of its trees");
    }
    return *forest->connectivity;
}

/// One node, one place, and trees that are not flat.
template <int dim, class Map>
void P4estGrid<dim, Map>::check_place(std::size_t t) {
    const CoarseElement<Element> c = coarse(t);
    const std::span<const Point> x(c.corners.data(), max_corners);
    double size = 0;
    for (const Point& corner : x) size = std::max(size, norm(corner - x[0]));
    for (unsigned k = 0; k < max_corners; ++k) {
        const Point own = corner_position(Trees::corner(t, k));
        if (!(norm(own - x[k]) <= 1e-9 * size)) {
            throw InvalidInput("corner " + std::to_string(k) + " of tree " + std::to_string(t) +
                               " is at another place than in tree " +
                               std::to_string(c.ids[k] / max_corners) +
                               ": the forest is periodic, or needs a map of its trees");
        }
    }
    const Point volume = measure_vector(c.shape, x);
    if (!(norm(volume) > 1e-14 * std::pow(size, dim))) {
        throw InvalidInput("tree " + std::to_string(t) + " is flat");
    }
    if (volume[2] < 0) orientation_[t] = -1;
}

/// Surfaces in space consistently, from the first tree of each connected part on, as far as they
/// can be oriented; trees with a volume, and in the plane, keep their sign.
template <int dim, class Map>
void P4estGrid<dim, Map>::orient() {
    if constexpr (dim == 2) {
        const auto& c = *forest_->connectivity;
        std::vector<bool> done(coarse_count(), false);
        std::vector<std::size_t> queue;
        for (std::size_t seed = 0; seed < coarse_count(); ++seed) {
            if (!done[seed]) queue.push_back(seed);
            done[seed] = true;
            while (!queue.empty()) {
                const std::size_t t = queue.back();
                queue.pop_back();
                for (std::size_t f = 0; f < 4; ++f) {
                    const auto other = static_cast<std::size_t>(c.tree_to_tree[4 * t + f]);
                    if (done[other]) continue;
                    done[other] = true;
                    queue.push_back(other);
                    // Neighbours run through their common side in opposite senses.
                    const int across = c.tree_to_face[4 * t + f];
                    const auto& side = topology(Shape::quadrilateral).face;
                    const int begin = Types::corner_across_face(
                        side[f].corner[0], static_cast<int>(f), across % 4, across / 4);
                    const bool turned =
                        side[static_cast<std::size_t>(across % 4)].corner[0] == begin;
                    orientation_[other] =
                        static_cast<std::int8_t>(turned ? -orientation_[t] : orientation_[t]);
                }
            }
        }
    }
}

template <int dim, class Map>
auto P4estGrid<dim, Map>::coarse(std::size_t i) const -> CoarseElement<Element> {
    CoarseElement<Element> c;
    c.shape = rule_->parent;
    c.orientation = orientation_[i];
    c.element = {static_cast<std::uint32_t>(i),
                 0,
                 static_cast<std::uint32_t>(tree(i).quadrants.elem_count),
                 {},
                 0,
                 Presence::here};
    c.element.presence = find_presence(c.element);
    for (unsigned k = 0; k < max_corners; ++k) {
        const P4estNode node = trees_.canonical(Trees::corner(i, k));
        c.ids[k] = node.tree * std::uint64_t{max_corners} + Trees::corner_number(node);
        c.corners[k] = corner_position(node);
    }
    return c;
}

/// Number of the child of an element on the level above `bit` that a leaf lies in.
template <int dim, class Map>
unsigned P4estGrid<dim, Map>::child_of(const Quadrant& leaf, unsigned bit) {
    const auto at = [&](std::int32_t x) { return static_cast<unsigned>(x) >> bit & 1U; };
    if constexpr (dim == 2) {
        return at(leaf.x) | at(leaf.y) << 1U;
    } else {
        return at(leaf.x) | at(leaf.y) << 1U | at(leaf.z) << 2U;
    }
}

/// The first leaf of an element, from `low` on, in child `c` or a later one.
template <int dim, class Map>
std::uint32_t P4estGrid<dim, Map>::bound(const Element& e, std::uint32_t low, unsigned c) const {
    if (e.last - e.first == max_children && e.presence == Presence::here) return e.first + c;
    if (low == e.last) return low;
    const auto bit = static_cast<unsigned>(Types::max_level - e.level - 1);
    const std::span<const Quadrant> leaves(&leaf_of(e.tree, low), e.last - low);
    const auto at = std::partition_point(leaves.begin(), leaves.end(), [&](const Quadrant& leaf) {
        return child_of(leaf, bit) < c;
    });
    return low + static_cast<std::uint32_t>(at - leaves.begin());
}

template <int dim, class Map>
auto P4estGrid<dim, Map>::child(const Element& e, unsigned c, std::uint32_t first) const
    -> Element {
    const std::uint32_t last = c + 1 == max_children ? e.last : bound(e, first, c + 1);
    Element result{e.tree,    first, last, e.anchor, static_cast<std::uint8_t>(e.level + 1),
                   e.presence};
    const std::int32_t half = Trees::length >> result.level;
    for (unsigned d = 0; d < dim; ++d) result.anchor[d] += (c >> d & 1U) != 0 ? half : 0;
    if (e.presence != Presence::here) result.presence = find_presence(result);
    return result;
}

/// Which leaves of an element are here, whose range of leaves here is known: the order of leaves is
/// cut among the processes at known positions.
template <int dim, class Map>
Presence P4estGrid<dim, Map>::find_presence(const Element& e) const {
    if (forest_->local_num_quadrants == forest_->global_num_quadrants) return Presence::here;
    if (e.first == e.last) return Presence::elsewhere;
    // Whether a place of the tree, on the deepest level, lies before a position.
    const auto before = [&](std::int32_t up, const Quadrant& position) {
        const auto tree = static_cast<std::uint32_t>(position.p.which_tree);
        if (tree != e.tree) return e.tree < tree;
        Quadrant at = position;
        at.level = Types::deepest_level;
        at.x = e.anchor[0] + up;
        at.y = e.anchor[1] + up;
        if constexpr (dim == 3) at.z = e.anchor[2] + up;
        Quadrant begin = position;
        begin.level = Types::deepest_level;
        return Types::compare(&at, &begin) < 0;
    };
    const std::int32_t to_last =
        (Trees::length >> e.level) - (std::int32_t{1} << (Types::max_level - Types::deepest_level));
    const Quadrant* const mine = forest_->global_first_position + forest_->mpirank;
    if (before(0, mine[0])) return Presence::partly;
    return before(to_last, mine[1]) ? Presence::here : Presence::partly_first;
}

template <int dim, class Map>
Point P4estGrid<dim, Map>::corner_position(const P4estNode& node) const {
    if constexpr (curved) {
        return mapped(node);
    } else {
        const auto& c = *forest_->connectivity;
        const double* x =
            c.vertices +
            3 * static_cast<std::ptrdiff_t>(
                    c.tree_to_vertex[node.tree * max_corners + Trees::corner_number(node)]);
        return {x[0], x[1], x[2]};
    }
}

}  // namespace nestgrid

#include <nestgrid/adapters/p4est_balanced.hpp>
#include <nestgrid/adapters/p4est_fields.hpp>
