// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's hyper tree grids, in place: forests of quadrilaterals or hexahedra on a rectilinear coarse
// grid, which are divided into two or three in each direction, with data of cells.
//
// A node is named by its place on the lattice of the deepest level, so that trees agree about
// it. Masked cells and ghost cells are hidden. Data of cells get to the nodes by CellAverages
// (cell_data.hpp). Ghost cells are those that another process draws, and their data count for the
// nodes between the two: make the averages on a grid that shows them,
//
//     const HyperTreeGrid<3> all(*trees, GhostCells::shown);
//     const CellAverages density(all, [&](const auto& e) { return values[all.index(e)]; });
//     isosurface(HyperTreeGrid<3>(*trees), density, 0.5);
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <vtkBitArray.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkHyperTree.h>
#include <vtkHyperTreeGrid.h>
#include <vtkUnsignedCharArray.h>

#include <nestgrid/adapters/tree_rules.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/optional.hpp>

namespace nestgrid {

/// Whether cells are drawn that another process has, too.
enum class GhostCells : std::uint8_t { hidden, shown };

/// A hyper tree grid of dimension 2 or 3 and of branch factor 2 or 3, down to the limit of its
/// depth, where it has one (SetDepthLimiter). It must outlive this object, which must be made anew
/// when the grid has changed: when trees were refined, when it has another mask, other ghost cells
/// or coordinates, or when one of these was told to be Modified().
template <int dim, int factor = 2>
class HyperTreeGrid {
    static_assert((dim == 2 || dim == 3) && (factor == 2 || factor == 3));
    static constexpr int power(int base) { return dim == 2 ? base * base : base * base * base; }

public:
    static constexpr int dimension = dim;
    static constexpr int max_corners = 1 << dim;
    static constexpr int max_children = power(factor);
    static constexpr int max_new_nodes = power(factor + 1) - max_corners;
    static constexpr Shape only_shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;
    using Place = std::array<std::uint32_t, 3>;
    struct Element {
        vtkHyperTree* tree = nullptr;
        vtkIdType vertex = 0;  ///< in the tree
        int level = 0;
        Place place{};  ///< of its first corner, in lattice steps of its own level
    };

    /// \throw InvalidInput for a grid of another dimension or branch factor, with more than 2^31
    ///        steps along a side at its deepest level, or with a mask that is too short
    explicit HyperTreeGrid(vtkHyperTreeGrid& grid, GhostCells ghosts = GhostCells::hidden);

    std::size_t coarse_count() const { return trees_.size(); }
    /// \throw GridError where the grid has changed since this object was made
    CoarseElement<Element> coarse(std::size_t i) const {
        require_same(trees_[i]);
        CoarseElement<Element> c;
        std::array<unsigned, 3> at{};
        grid_->GetLevelZeroCoordinatesFromIndex(trees_[i].index, at[0], at[1], at[2]);
        c.element = {trees_[i].tree, 0, 0, {at[0], at[1], at[2]}};
        c.shape = rule_->parent;
        for (std::size_t k = 0; k < max_corners; ++k) {
            const Place corner = step(c.element.place, k, 2);
            std::uint64_t id = 0;
            for (std::size_t d = 3; d-- > 0;) {
                c.corners[k][d] = coordinates_[d][corner[d]];
                id = id * coordinates_[d].size() + corner[d];
            }
            c.ids[k] = id;
        }
        const Point v = measure_vector(c.shape, c.corners);
        if (dim == 3 && v[2] < 0) c.orientation = -1;  // where a coordinate decreases
        return c;
    }
    const Rule* split(const Element& e) const { return is_leaf(e) ? nullptr : rule_; }
    void children(const Element& e, std::span<Element> out) const {
        const vtkIdType first = e.tree->GetElderChildIndex(static_cast<unsigned>(e.vertex));
        for (std::size_t c = 0; c < out.size(); ++c) {
            out[c] = {e.tree, first + static_cast<vtkIdType>(c), e.level + 1, e.place};
            for (std::uint32_t& x : out[c].place) x *= factor;
            out[c].place = step(out[c].place, c, factor);
        }
    }

    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = corner_key(e, k);
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const {
        std::array<Element, static_cast<std::size_t>(max_children)> child;
        children(e, child);
        for (std::size_t n = 0; n < out.size(); ++n) {
            const ChildCorner at = rule_->new_corner[n];
            out[n] = corner_key(child[at.child], at.corner);
        }
    }

    /// New nodes on a face or edge of an element that is no larger than e, is no part of the next
    /// level, and is not hidden.
    NodeMask constrained(const Element& e) const;
    /// What is masked.
    Hidden hidden(const Element& e) const {
        return hidden_.empty() ? Hidden::not_at_all : hidden_[static_cast<std::size_t>(index(e))];
    }

    /// From the times at which VTK says that the grid, its mask, ghost cells and coordinates were
    /// changed, and from the sizes that trees had when this object was made. That trees were
    /// refined since is noticed by coarse().
    std::uint64_t epoch() const;

    /// Number of an element, leaf or not, in the arrays of cell data.
    vtkIdType index(const Element& e) const { return e.tree->GetGlobalIndexFromLocal(e.vertex); }

private:
    struct Tree {
        vtkHyperTree* tree;
        vtkIdType index;     ///< in the grid
        vtkIdType vertices;  ///< that it had when it was read
    };

    void require_same(const Tree& tree) const {
        const bool is_same = grid_->GetTree(tree.index) == tree.tree &&
                             tree.tree->GetNumberOfVertices() == tree.vertices && epoch() == epoch_;
        if (!is_same) refuse_changed();
    }
    [[noreturn]] static void refuse_changed() {
        throw GridError(
            "the hyper tree grid has changed since its adapter was made: make another one");
    }
    Hidden read_mask(const Element& e, bool masked);

    /// The steps in which item k lies from the first one of a lattice of so many along each side:
    /// corners, or children.
    Place step(Place from, std::size_t k, std::size_t along) const {
        for (std::size_t a = 0; a < dim; ++a) {
            from[axis_[a]] += static_cast<std::uint32_t>(k % along);
            k /= along;
        }
        return from;
    }
    NodeKey corner_key(const Element& e, std::size_t k) const {
        NodeKey key = 0;
        for (const std::uint32_t x : step(e.place, k, 2))
            key = detail::mix(key + NodeKey{x} * cells_in(depth_ - e.level));
        return key;
    }
    /// Along a side of an element that is divided so many times.
    static std::uint32_t cells_in(int levels) {
        std::uint32_t cells = 1;
        for (; levels > 0; --levels) cells *= factor;
        return cells;
    }
    bool is_leaf(const Element& e) const { return e.level >= depth_ || e.tree->IsLeaf(e.vertex); }
    /// Whether a leaf that is not hidden fills the place of an element of a level.
    bool is_undivided(const Place& place, int level) const;

    vtkHyperTreeGrid* grid_;
    GhostCells ghost_cells_;
    const Rule* rule_;
    detail::NodesOfTrees<dim, factor> nodes_;
    int depth_ = 0;                      // of the deepest leaves
    std::array<std::size_t, 3> axis_{};  // directions in which there is more than one point
    std::array<std::vector<double>, 3> coordinates_;
    std::vector<Tree> trees_;
    NodeKey sizes_ = 0;                       // of all trees, mixed
    std::uint64_t epoch_ = 0;                 // when this object was made
    vtkBitArray* mask_ = nullptr;             // where there is one
    vtkUnsignedCharArray* ghosts_ = nullptr;  // where there are any
    std::vector<Hidden> hidden_;              // by index; empty without a mask and ghosts
};

template <int dim, int factor>
HyperTreeGrid<dim, factor>::HyperTreeGrid(vtkHyperTreeGrid& grid, GhostCells ghosts)
    : grid_{&grid}, ghost_cells_{ghosts}, rule_{&detail::rule_of_trees<dim, factor>()} {
    if (grid.GetDimension() != dim) {
        throw InvalidInput("the hyper tree grid has dimension " +
                           std::to_string(grid.GetDimension()) + ", not " + std::to_string(dim));
    }
    if (grid.GetBranchFactor() != factor) {
        throw InvalidInput("the hyper tree grid has the branch factor " +
                           std::to_string(grid.GetBranchFactor()) + ", not " +
                           std::to_string(factor));
    }
    depth_ = static_cast<int>(std::min(grid.GetNumberOfLevels() - 1, grid.GetDepthLimiter()));
    const std::array<vtkDataArray*, 3> x{grid.GetXCoordinates(), grid.GetYCoordinates(),
                                         grid.GetZCoordinates()};
    const unsigned* points = grid.GetDimensions();
    std::size_t axes = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        if (points[d] == 1) continue;
        if (std::pow(factor, depth_) * points[d] >= 0x1p31) {
            throw InvalidInput("the hyper tree grid is too deep for its " +
                               std::to_string(points[d] - 1) + " trees along a side");
        }
        axis_[axes++] = d;
    }
    for (std::size_t d = 0; d < 3; ++d) {
        for (unsigned i = 0; i < points[d]; ++i) coordinates_[d].push_back(x[d]->GetTuple1(i));
    }
    for (vtkIdType i = 0; i < grid.GetMaxNumberOfTrees(); ++i) {
        if (vtkHyperTree* tree = grid.GetTree(i)) {
            trees_.push_back({tree, i, tree->GetNumberOfVertices()});
            sizes_ = detail::mix(sizes_ + static_cast<NodeKey>(trees_.back().vertices));
        }
    }
    const vtkIdType cells = grid.GetGlobalNodeIndexMax() + 1;
    const auto require_entry_for_each = [&](const char* name, vtkIdType entries) {
        if (entries >= cells) return;
        throw InvalidInput(std::string(name) + " of the hyper tree grid has " +
                           std::to_string(entries) + " entries for " + std::to_string(cells) +
                           " cells");
    };
    if (grid.HasMask() && grid.GetMask()->GetNumberOfValues() > 0) {
        mask_ = grid.GetMask();
        require_entry_for_each("the mask", mask_->GetNumberOfValues());
    }
    ghosts_ = grid.GetGhostCells();
    if (ghosts_ != nullptr) {
        require_entry_for_each("the ghost array", ghosts_->GetNumberOfValues());
    }
    if (mask_ != nullptr || ghosts_ != nullptr) {
        hidden_.resize(static_cast<std::size_t>(cells));
        for (const Tree& tree : trees_) read_mask({tree.tree, 0, 0, {}}, false);
    }
    epoch_ = epoch();
}

template <int dim, int factor>
std::uint64_t HyperTreeGrid<dim, factor>::epoch() const {
    NodeKey sum = detail::mix(sizes_ + static_cast<NodeKey>(grid_->GetMTime()));
    sum = detail::mix(sum + static_cast<NodeKey>(ghost_cells_));
    for (vtkObject* part : std::initializer_list<vtkObject*>{
             grid_->GetMask(), grid_->GetGhostCells(), grid_->GetXCoordinates(),
             grid_->GetYCoordinates(), grid_->GetZCoordinates()}) {
        const auto time = part == nullptr ? vtkMTimeType{0} : part->GetMTime();
        sum = detail::mix(sum + static_cast<NodeKey>(time));
    }
    return static_cast<std::uint64_t>(sum);
}

template <int dim, int factor>
bool HyperTreeGrid<dim, factor>::is_undivided(const Place& place, int level) const {
    std::array<unsigned, 3> root{};
    for (std::size_t d = 0; d < 3; ++d) root[d] = place[d] / cells_in(level);
    for (std::size_t d = 0; d < 3; ++d) {
        const std::size_t trees = std::max<std::size_t>(coordinates_[d].size(), 2) - 1;
        if (root[d] >= trees) return false;
    }
    vtkIdType index = 0;
    grid_->GetIndexFromLevelZeroCoordinates(index, root[0], root[1], root[2]);
    Element e{grid_->GetTree(index), 0, 0, {root[0], root[1], root[2]}};
    if (e.tree == nullptr) return false;
    while (!is_leaf(e)) {
        if (e.level == level) return false;
        std::size_t child = 0;
        const std::uint32_t below = cells_in(level - e.level - 1);
        for (std::size_t a = dim; a-- > 0;) {
            child = factor * child + place[axis_[a]] / below % factor;
        }
        std::array<Element, static_cast<std::size_t>(max_children)> children_of;
        children(e, children_of);
        e = children_of[child];
    }
    return hidden(e) != Hidden::wholly;
}

template <int dim, int factor>
NodeMask HyperTreeGrid<dim, factor>::constrained(const Element& e) const {
    return nodes_.hanging([&](const std::array<int, 3>& steps) {
        Place beside = e.place;
        for (std::size_t a = 0; a < dim; ++a) {
            if (steps[a] < 0 && beside[axis_[a]] == 0) return false;
            beside[axis_[a]] += static_cast<std::uint32_t>(steps[a]);
        }
        return is_undivided(beside, e.level);
    });
}

template <int dim, int factor>
Hidden HyperTreeGrid<dim, factor>::read_mask(const Element& e, bool masked) {
    masked = masked || (mask_ != nullptr && mask_->GetValue(index(e)) != 0);
    const int shown = ghost_cells_ == GhostCells::shown ? vtkDataSetAttributes::DUPLICATECELL : 0;
    if (split(e) == nullptr && ghosts_ != nullptr && (ghosts_->GetValue(index(e)) & ~shown) != 0) {
        masked = true;
    }
    Hidden result = masked ? Hidden::wholly : Hidden::not_at_all;
    if (split(e) != nullptr) {
        std::array<Element, static_cast<std::size_t>(max_children)> child;
        children(e, child);
        result = read_mask(child[0], masked);
        for (std::size_t c = 1; c < child.size(); ++c) {
            if (read_mask(child[c], masked) != result) result = Hidden::partly;
        }
    }
    return hidden_[static_cast<std::size_t>(index(e))] = result;
}

}  // namespace nestgrid
