// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Linear quadtrees and octrees: a solver's own array of leaves, sorted along the Morton curve, as
// the hierarchy it implies. Nothing is copied; an element is a range of the array.
//
// Invariants, checked once: the leaves of every tree are aligned to their level, sorted, and fill
// the tree without gap or overlap. They may differ by any number of levels.
// Trees may also be divided by three in each direction. Then nodes hang at thirds of edges, where
// they are not looked for, so that a grid with changes of level must offer `constrained` itself.
// A node is named by where it lies: inside a tree by the place in it, on the border of trees by the
// coarse nodes around it and its weights, so that trees agree about it however they are turned.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <nestgrid/adapters/coarse_checks.hpp>
#include <nestgrid/adapters/tree_rules.hpp>
#include <nestgrid/optional.hpp>

namespace nestgrid {

/// \tparam LeafType any struct with integers x, y, z (in two dimensions x, y) and level; a tree is
///         factor^max_level wide, its root has level 0
/// \tparam factor into how many parts elements are divided in each direction: 2 or 3
template <int dim, class LeafType, int factor = 2>
class LinearOctree {
    static_assert((dim == 2 || dim == 3) && (factor == 2 || factor == 3));
    static constexpr int power(int base) { return dim == 2 ? base * base : base * base * base; }

public:
    static constexpr int dimension = dim;
    static constexpr int max_corners = 1 << dim;
    static constexpr int max_new_nodes = power(factor + 1) - max_corners;
    static constexpr int max_children = power(factor);
    /// The levels that a tree may have at most, so that its finest cells have numbers.
    static constexpr int most_levels = (factor == 2 ? 62 : 39) / dim;
    static constexpr Shape only_shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;

    struct Element {
        std::size_t first;  ///< leaf of the whole array
        std::size_t last;   ///< one behind
        std::uint8_t level;
    };

    /// \param coarse quadrilaterals or hexahedra, one per tree
    /// \param trees leaves of each tree; the arrays must outlive the grid and stay as they are
    /// \throw InvalidInput where these are no trees, naming the first wrong leaf
    LinearOctree(CoarseGrid coarse, std::vector<std::span<const LeafType>> trees, int max_level)
        : coarse_{std::move(coarse)},
          trees_{std::move(trees)},
          max_level_{max_level},
          rule_{&detail::rule_of_trees<dim, factor>()} {
        CoarseGrid oriented = coarse_;
        check_and_orient(oriented);
        for (std::size_t t = 0; t < coarse_.element_count(); ++t) {
            const bool same = std::equal(oriented.element(t).begin(), oriented.element(t).end(),
                                         coarse_.element(t).begin());
            orientation_.push_back(same ? 1 : -1);
        }
        if (trees_.size() != coarse_.element_count()) {
            throw InvalidInput("there are " + std::to_string(trees_.size()) + " trees, but " +
                               std::to_string(coarse_.element_count()) + " coarse elements");
        }
        if (max_level < 0 || max_level > most_levels) {
            throw InvalidInput("trees of " + std::to_string(max_level) + " levels");
        }
        first_.push_back(0);
        for (std::size_t t = 0; t < trees_.size(); ++t) {
            if (coarse_.shapes[t] != rule_->parent) {
                throw InvalidInput("coarse element " + std::to_string(t) + " is a " +
                                   std::string(topology(coarse_.shapes[t]).name));
            }
            check(t);
            first_.push_back(first_.back() + trees_[t].size());
        }
    }

    std::size_t coarse_count() const { return coarse_.element_count(); }
    CoarseElement<Element> coarse(std::size_t i) const {
        CoarseElement<Element> c;
        c.shape = rule_->parent;
        c.orientation = orientation_[i];
        c.element = {first_[i], first_[i + 1], 0};
        const auto nodes = coarse_.element(i);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            c.corners[k] = coarse_.nodes[nodes[k]];
            c.ids[k] = nodes[k];
        }
        return c;
    }
    const Rule* split(const Element& e) const { return e.last - e.first == 1 ? nullptr : rule_; }
    void children(const Element& e, std::span<Element> out) const {
        const std::size_t tree = tree_of(e);
        std::size_t first = e.first;
        for (std::size_t c = 0; c < static_cast<std::size_t>(max_children); ++c) {
            const bool is_last = c + 1 == static_cast<std::size_t>(max_children);
            const std::size_t last = is_last ? e.last : bound(tree, e, first, c + 1);
            out[c] = {first, last, static_cast<std::uint8_t>(e.level + 1)};
            first = last;
        }
    }

    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        const std::size_t tree = tree_of(e);
        const Place low = place_of(tree, e);
        const std::uint64_t width = cells_in(max_level_ - e.level);
        for (std::size_t k = 0; k < out.size(); ++k) {
            Place node = low;
            for (std::size_t d = 0; d < node.size(); ++d) node[d] += (k >> d & 1U) * width;
            out[k] = key(tree, node);
        }
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const {
        const std::size_t tree = tree_of(e);
        const Place low = place_of(tree, e);
        const std::uint64_t part = cells_in(max_level_ - e.level - 1);
        for (std::size_t n = 0; n < out.size(); ++n) {
            std::size_t child = rule_->new_corner[n].child;
            const std::size_t corner = rule_->new_corner[n].corner;
            Place node = low;
            for (std::size_t d = 0; d < node.size(); ++d, child /= factor) {
                node[d] += (child % factor + (corner >> d & 1U)) * part;
            }
            out[n] = key(tree, node);
        }
    }

    // What fields need.
    /// The number of a leaf in the whole array.
    std::size_t leaf_index(const Element& leaf) const { return leaf.first; }
    std::size_t leaf_count() const { return first_.back(); }
    /// The leaf in a corner of an element.
    std::size_t corner_leaf(Element e, std::size_t corner) const {
        if (corner + 1 == max_corners) e.first = e.last - 1;
        if (corner == 0 || e.last - e.first == 1) return e.first;
        const std::size_t tree = tree_of(e);
        std::size_t child = 0;
        for (std::size_t d = static_cast<std::size_t>(dim); d-- > 0;) {
            child = factor * child + ((corner >> d & 1U) != 0 ? factor - 1 : 0);
        }
        while (e.last - e.first > 1) {
            e.first = bound(tree, e, e.first, child);
            e.last = bound(tree, e, e.first, child + 1);
            ++e.level;
        }
        return e.first;
    }

    /// Finest cells along a side of an element that is divided so many times.
    static constexpr std::uint64_t cells_in(int levels) {
        if constexpr (factor == 2) return std::uint64_t{1} << static_cast<unsigned>(levels);
        std::uint64_t cells = 1;
        for (; levels > 0; --levels) cells *= factor;
        return cells;
    }

private:
    using Place = std::array<std::uint64_t, static_cast<std::size_t>(dim)>;  // in finest cells

    /// The place of the first corner of an element, which is that of its first leaf.
    Place place_of(std::size_t tree, const Element& e) const {
        const LeafType& leaf = trees_[tree][e.first - first_[tree]];
        Place place;
        for (std::size_t d = 0; d < place.size(); ++d) place[d] = coordinate(leaf, d);
        return place;
    }
    NodeKey key(std::size_t tree, const Place& node) const {
        const std::uint64_t width = cells_in(max_level_);
        bool is_inside = true;
        NodeKey inside = detail::mix(tree);
        for (const std::uint64_t x : node) {
            is_inside = is_inside && 0 < x && x < width;
            inside = detail::mix(inside + x);
        }
        if (is_inside) return inside;
        NodeKey sum = 0;  // in any order, for trees number their corners in any order
        const auto corners = coarse_.element(tree);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            std::uint64_t weight = 1;
            for (std::size_t d = 0; d < node.size(); ++d) {
                weight *= (k >> d & 1U) != 0 ? node[d] : width - node[d];
            }
            if (weight != 0) sum += detail::mix(detail::mix(NodeKey{corners[k]} + 1) + weight);
        }
        return sum;
    }

    static std::uint64_t coordinate(const LeafType& leaf, std::size_t d) {
        if (d == 0) return static_cast<std::uint64_t>(leaf.x);
        if (d == 1) return static_cast<std::uint64_t>(leaf.y);
        if constexpr (dim == 3) return static_cast<std::uint64_t>(leaf.z);
        return 0;
    }
    /// In which child of an element a leaf lies.
    /// \param width of the children, which is a power of the factor
    static std::size_t child_of(const LeafType& leaf, std::uint64_t width) {
        std::size_t number = 0;
        for (std::size_t d = static_cast<std::size_t>(dim); d-- > 0;) {
            const std::uint64_t x = coordinate(leaf, d);
            number = factor * number + (factor == 2 ? (x & width) != 0 : x / width % factor);
        }
        return number;
    }

    std::size_t tree_of(const Element& e) const {
        return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), e.first) -
                                        first_.begin() - 1);
    }
    /// The first leaf of an element, from `low` on, in child `c` or a later one.
    std::size_t bound(std::size_t tree, const Element& e, std::size_t low, std::size_t c) const {
        const std::uint64_t width = cells_in(max_level_ - e.level - 1);
        const auto leaves = trees_[tree].subspan(low - first_[tree], e.last - low);
        const auto at =
            std::partition_point(leaves.begin(), leaves.end(),
                                 [&](const LeafType& leaf) { return child_of(leaf, width) < c; });
        return low + static_cast<std::size_t>(at - leaves.begin());
    }

    void check(std::size_t t) const {
        std::uint64_t expected = 0;  // place on the curve
        for (std::size_t i = 0; i < trees_[t].size(); ++i) {
            const LeafType& leaf = trees_[t][i];
            const auto fail = [&](const std::string& what) {
                throw InvalidInput("leaf " + std::to_string(i) + " of tree " + std::to_string(t) +
                                   " " + what);
            };
            const auto level = static_cast<long long>(leaf.level);
            if (level < 0 || level > max_level_) {
                fail("has the level " + std::to_string(level) + ", not 0 to " +
                     std::to_string(max_level_));
            }
            const int below = max_level_ - static_cast<int>(level);
            for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
                const std::uint64_t x = coordinate(leaf, d);
                if (x >= cells_in(max_level_)) fail("lies outside its tree");
                if (x % cells_in(below) != 0) fail("is not aligned to its level");
            }
            std::uint64_t place = 0;
            for (std::uint64_t width = cells_in(max_level_); width > 1;) {
                width /= factor;
                place = place * static_cast<std::uint64_t>(max_children) + child_of(leaf, width);
            }
            if (place < expected) fail("overlaps the one before it, or they are not sorted");
            if (place > expected) fail("leaves a gap before it");
            expected += cells_in(dim * below);
        }
        if (expected != cells_in(dim * max_level_)) {
            throw InvalidInput("the leaves of tree " + std::to_string(t) + " do not fill it");
        }
    }

    CoarseGrid coarse_;
    std::vector<std::int8_t> orientation_;
    std::vector<std::span<const LeafType>> trees_;
    std::vector<std::size_t> first_;  // leaf of each tree in the whole array, and the end
    int max_level_;
    const Rule* rule_;
};

/// Nodal values of a linear octree, read in place: corner c (in tensor order) of leaf i of the
/// whole array is node element_nodes[2^dim * i + c].
template <class Grid, class Real, class Index>
class LinearOctreeField {
public:
    using value_type = Real;
    using Element = typename Grid::Element;

    /// \throw InvalidInput where there are not 2^dim nodes per leaf, or one has no value
    LinearOctreeField(const Grid& grid, std::span<const Index> element_nodes,
                      std::span<const Real> values)
        : grid_{&grid}, element_nodes_{element_nodes}, values_{values} {
        if (element_nodes.size() != corners_ * grid.leaf_count()) {
            throw InvalidInput("there are " + std::to_string(element_nodes.size()) +
                               " nodes of elements, not " + std::to_string(corners_) +
                               " for each of " + std::to_string(grid.leaf_count()) + " leaves");
        }
        for (std::size_t i = 0; i < element_nodes.size(); ++i) {
            if (static_cast<std::size_t>(element_nodes[i]) >= values.size()) {
                throw InvalidInput("corner " + std::to_string(i % corners_) + " of leaf " +
                                   std::to_string(i / corners_) + " is the node " +
                                   std::to_string(element_nodes[i]) + ", but there are " +
                                   std::to_string(values.size()) + " values");
            }
        }
    }

    NodeMask coarse_values(std::size_t i, std::span<Real> out) const {
        const Element e = grid_->coarse(i).element;
        for (std::size_t c = 0; c < corners_; ++c) out[c] = corner_value(e, c);
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<Real> out) const {
        const Rule& rule = *grid_->split(e);
        std::array<Element, static_cast<std::size_t>(Grid::max_children)> children;
        grid_->children(e, children);
        for (std::size_t k = 0; k < rule.new_corner.size(); ++k) {
            if ((which >> k & 1U) == 0) continue;
            const auto [child, corner] = rule.new_corner[k];
            out[k] = corner_value(children[child], corner);
        }
        return 0;
    }

private:
    static constexpr auto corners_ = static_cast<std::size_t>(Grid::max_corners);

    Real corner_value(const Element& e, std::size_t corner) const {
        const std::size_t leaf = grid_->corner_leaf(e, corner);
        return values_[static_cast<std::size_t>(element_nodes_[corners_ * leaf + corner])];
    }

    const Grid* grid_;
    std::span<const Index> element_nodes_;
    std::span<const Real> values_;
};

}  // namespace nestgrid
