// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A block-structured adaptive grid, which knows its boxes and nothing else: quadrilaterals or
// hexahedra that are halved. A cell that a finer box covers is divided, k times where the ratio is
// 2^k. Above level 0 the hierarchy goes on: a root is a cube of 2^m cells of level 0, m the number
// of times that two divides all sides of the domain.
//
// Places are counted from the first cell or node of the domain, in cells of some depth; the roots
// have depth 0, the cells of level 0 depth m. A *finest* place is one in cells of the last level.
//
// Invariants:
//   - a cell of a level is covered by one box of the next level, or by none, for boxes are aligned
//     to the ratio;
//   - a node belongs to the first box that touches it, of the coarsest level on whose lattice it
//     lies. A node of level 0 belongs to the domain.
// Consequences: an element knows by the number of the covering box whether it is divided; node keys
// are dense, a number of the box plus a place in it, without a table; which nodes hang follows from
// the boxes. Memory: O(boxes).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/adapters/block_boxes.hpp>
#include <nestgrid/adapters/block_finder.hpp>
#include <nestgrid/optional.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// A cell of a level, in the box that holds it.
template <int dim>
struct BlockCell {
    std::int32_t level = 0;
    std::int32_t box = -1;  ///< of the level; -1 outside the domain
    std::array<std::int32_t, static_cast<std::size_t>(dim)> place{};  ///< in its box
    std::array<std::int32_t, static_cast<std::size_t>(dim)> low{};    ///< finest, of its first node
};

/// A cube or square of places for cells of one level.
template <int dim>
struct BlockPatch {
    std::int32_t level = 0;
    std::int32_t box = -1;   ///< that holds the middle
    bool is_in_box = false;  ///< all of the patch is
    bool is_whole = false;   ///< at all places there are leaves of the level
    bool has_finer = false;  ///< at some there are finer leaves
    std::array<std::int32_t, static_cast<std::size_t>(dim)> low{};  ///< of the level
};

/// The grid. What boxes it is made of does not change: after a regrid make another one.
template <int dim>
class BlockGrid {
    static_assert(dim == 2 || dim == 3);
    static constexpr auto size_ = static_cast<std::size_t>(dim);

public:
    static constexpr int dimension = dim;
    static constexpr int max_corners = 1 << dim;
    static constexpr int max_new_nodes = dim == 2 ? 5 : 19;
    static constexpr int max_children = 1 << dim;
    static constexpr Shape only_shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;
    using Place = detail::BlockPlace<dim>;
    /// The cells around a node, one for each corner that they have there, as in tensor order.
    using Around = std::array<BlockCell<dim>, static_cast<std::size_t>(max_corners)>;

    /// A node: its finest place, and a cell near it, of which level and box are known at most.
    struct Node {
        Place place{};
        BlockCell<dim> near;
    };

    struct Element {
        Place cell{};             ///< in cells of its depth
        std::int32_t finer = -1;  ///< the box of the next level that covers it, or -1
        std::uint8_t depth = 0;
    };

    /// Keeps the boxes, not the argument.
    ///
    /// \throw InvalidInput naming level and box: boxes that are empty, overlap, are not aligned to
    /// the ratio or not within the level before; ratios that are no power of two or differ by
    /// direction; level 0 with holes; more than 2^30 cells along a side
    explicit BlockGrid(const Blocks<dim>& blocks);

    std::size_t coarse_count() const;
    CoarseElement<Element> coarse(std::size_t i) const;
    const Rule* split(const Element& e) const {
        return e.finer >= 0 || e.depth < levels_[0].depth ? rule_ : nullptr;
    }
    void children(const Element& e, std::span<Element> out) const;

    // Optional operations.
    std::size_t node_count() const { return node_count_; }
    void corner_keys(const Element& e, std::span<NodeKey> out) const;
    void new_keys(const Element& e, std::span<NodeKey> out) const;
    void corner_positions(const Element& e, std::span<Point> out) const;
    NodeMask constrained(const Element& e) const;
    /// Of the boxes, so that what was made for other ones is refused.
    std::uint64_t epoch() const { return epoch_; }

    /// Cells that no finer box covers.
    std::uint64_t leaf_count() const;
    /// Nodes that are a corner of some element; fewer than node_count().
    std::uint64_t used_node_count() const;

    // What fields need.
    std::size_t level_count() const { return levels_.size(); }
    std::size_t box_count(std::size_t level) const { return levels_[level].finder.boxes().size(); }
    /// How many cells a box has in each direction.
    Place box_size(std::size_t level, std::size_t box) const;
    /// How many cells there are in each direction, were all as fine as the last level.
    Place finest_size() const;
    /// The extent of the cells of the last level, by index.
    Point finest_spacing() const { return (1.0 / extent(0)) * spacing_; }
    /// The axis of space along which index d goes.
    std::size_t axis(std::size_t d) const { return axes_[d]; }
    /// The node that has a key.
    Node place(NodeKey key) const;
    /// The place of a new node in its element, in halves of an edge.
    const Place& half(std::size_t n) const { return halves_[n]; }
    /// The number of the new node in the middle of an element.
    static constexpr std::size_t centre() { return max_new_nodes - 1; }
    /// The finest place of a new node of an element, and of a corner.
    Place new_node(const Element& e, std::size_t n) const;
    Place corner(const Element& e, std::size_t k) const;
    /// The cell that a leaf is.
    BlockCell<dim> cell_of(const Element& leaf) const;
    /// The box that covers a divided element: level and box alone; no box above level 0.
    BlockCell<dim> cover(const Element& e) const {
        return {std::int32_t{level_of_[e.depth]} + 1, e.finer, {}, {}};
    }
    /// The leaf at the first corner of a cell: the cell itself where no finer box covers it.
    /// \param cell with level, box, and place in it
    BlockCell<dim> first_leaf(const BlockCell<dim>& cell) const;
    /// The leaf that holds a finest cell of the domain.
    /// \param near whose box is looked at first
    BlockCell<dim> leaf_at(const Place& cell, const BlockCell<dim>& near) const;
    /// The cells that an element is divided into, with layers of cells around them; false where no
    /// level has cells of that size.
    bool patch_around(const Element& divided, std::int32_t layers, BlockPatch<dim>& patch) const;
    /// Calls f(first cell, range of cells) for each part of a patch that lies in one box of its
    /// level.
    /// \param side of the patch, in cells
    template <class Function>
    void for_each_part(const BlockPatch<dim>& patch, std::int32_t side, Function&& f) const;
    /// Calls f(cell) for the cells of a patch that finer boxes cover.
    template <class Function>
    void for_each_covered(const BlockPatch<dim>& patch, std::int32_t side, Function&& f) const;
    /// A cell of a level, in its box, which holds it or is looked for; no box where the level has
    /// no such cell.
    /// \param guess a box of the level, looked at first
    BlockCell<dim> cell_at(std::int32_t level, const Place& cell, std::int32_t guess) const;
    /// The leaves around a node.
    /// \param node its finest place
    /// \param near whose box is looked at first
    Around leaves_around(const Place& node, const BlockCell<dim>& near) const;
    /// Calls f(level, box) for the boxes that have leaves below an element, or at it, until f
    /// answers false. A box may come several times.
    template <class Function>
    void for_each_box_below(const Element& e, Function&& f) const;
    /// The extent of the cells of a level, in finest places.
    std::int32_t extent(std::size_t level) const {
        return std::int32_t{1} << (finest_depth() - levels_[level].depth);
    }

private:
    struct Level {
        unsigned depth = 0;
        detail::BlockFinder<dim> finder;
        std::vector<std::uint64_t> first_node;  // of each box
    };

    unsigned finest_depth() const { return levels_.back().depth; }
    void number_nodes();
    void mix_epoch(const Blocks<dim>& blocks);
    /// How the nodes of a box are numbered, or those of level 0: along x first.
    struct Numbering {
        std::uint64_t first = 0;
        detail::CellRange<dim> box;

        NodeKey key(const Place& node) const {
            std::uint64_t number = 0;
            for (std::size_t d = node.size(); d-- > 0;) {
                number = number * (static_cast<std::uint64_t>(box.high[d] - box.low[d]) + 1) +
                         static_cast<std::uint64_t>(node[d] - box.low[d]);
            }
            return NodeKey{first + number};
        }
    };
    Numbering numbering(std::size_t level, std::int32_t box) const;
    NodeKey key(Place node, unsigned depth, std::size_t level, std::int32_t guess) const;
    std::int32_t box_around(const Element& e, std::size_t level) const;
    std::uint64_t owned_at_border(const Level& level, std::int32_t box, std::int32_t ratio) const;
    bool is_within(const Place& node, const BlockCell<dim>& near, Around& around) const;
    BlockCell<dim> leaf_at(const Place& cell, std::span<std::int32_t> guess) const;
    std::int32_t first_touching(const Level& level, const Place& node, std::int32_t guess) const;
    bool is_divided(const Place& cell, const Element& beside) const;

    const Rule* rule_ = &dyadic_rule(only_shape);
    std::vector<Level> levels_;
    std::array<std::uint8_t, 64> level_of_{};   // the last level that is not deeper than a depth
    std::array<std::uint8_t, 64> level_for_{};  // the first level on whose lattice a depth's is
    Place cells_{};                             // of level 0
    Place roots_{};
    Point origin_{};
    Point spacing_{};
    std::array<std::size_t, size_> axes_{};
    std::array<Place, static_cast<std::size_t>(max_new_nodes)> halves_{};  // to the new nodes
    std::uint64_t node_count_ = 0;
    std::uint64_t epoch_ = 0;
};

}  // namespace nestgrid

#include <nestgrid/adapters/block_checks.hpp>
#include <nestgrid/adapters/block_grid_steps.hpp>
#include <nestgrid/adapters/block_leaves_steps.hpp>
