// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fields on a BlockGrid, whose values stay where the solver has them: a pointer and a stride in
// each direction for each box.
//
// Of cells that a finer level covers, and of ghost cells, nothing is ever read: they may hold
// anything. An array of a box without a pointer is not here, as on another process: nodes that need
// it have no value.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>

#include <nestgrid/adapters/block_grid.hpp>
#include <nestgrid/adapters/block_patch.hpp>
#include <nestgrid/algorithms/cell_data.hpp>

namespace nestgrid {

/// The memory of the numbers of one box, which need not be aligned.
/// \tparam Real float or double
template <int dim, class Real>
struct BlockArray {
    const void* first = nullptr;  ///< of the first cell, or node, of the box; behind ghost cells
    std::array<std::ptrdiff_t, static_cast<std::size_t>(dim)> stride{};  ///< in bytes

    /// The number of a cell or node, counted from the first one of the box.
    Real at(const detail::BlockPlace<dim>& place) const {
        std::ptrdiff_t bytes = 0;
        for (std::size_t d = 0; d < stride.size(); ++d) bytes += stride[d] * place[d];
        Real value;
        std::memcpy(&value, static_cast<const std::byte*>(first) + bytes, sizeof(Real));
        return value;
    }
};

/// The arrays of all boxes, by level and number of the box.
template <int dim, class Real>
using BlockArrays = std::vector<std::vector<BlockArray<dim, Real>>>;

/// Whether an array has one number for each cell of its box, or for each node.
enum class BlockCentring : std::uint8_t { cells, nodes };

/// An array whose numbers stand one behind the other, x fastest.
/// \param ghosts layers of cells, or nodes, around those of the box
///
/// \throw InvalidInput where there are more or fewer numbers than that
template <int dim, class Real>
BlockArray<dim, Real> block_array(const BlockBox<dim>& box, std::span<const Real> values,
                                  int ghosts = 0, BlockCentring centring = BlockCentring::cells) {
    BlockArray<dim, Real> array;
    std::size_t count = 1;
    std::size_t first = 0;
    for (std::size_t d = 0; d < array.stride.size(); ++d) {
        array.stride[d] = static_cast<std::ptrdiff_t>(count * sizeof(Real));
        first += count * static_cast<std::size_t>(ghosts);
        const std::int64_t cells = std::int64_t{box.upper[d]} - box.lower[d] + 1;
        const std::int64_t more = centring == BlockCentring::nodes ? 1 : 0;
        count *= static_cast<std::size_t>(std::max<std::int64_t>(cells + more + 2 * ghosts, 0));
    }
    if (count != values.size()) {
        throw InvalidInput("there are " + std::to_string(values.size()) + " values for a box " +
                           detail::text_of_place(box.lower) + " to " +
                           detail::text_of_place(box.upper) + " that has " + std::to_string(count) +
                           " with its ghosts");
    }
    array.first = values.data() + first;
    return array;
}

/// Whether a leaf has no number (NaN). Nobody looks at that of a cell which a finer box covers.
template <int dim, class Real>
bool is_leaf_missing(const BlockGrid<dim>& grid, const BlockArrays<dim, Real>& arrays);

namespace detail {

/// How many cells of a patch have numbers.
enum class Patch : std::uint8_t { none, some, all };

/// Reads numbers of boxes.
template <int dim, class Real>
class BlockReader {
public:
    /// \throw InvalidInput where there is not one array for each box, or numbers of one lie on each
    /// other
    BlockReader(const BlockGrid<dim>& grid, BlockArrays<dim, Real> arrays, BlockCentring centring);

    const BlockGrid<dim>& grid() const { return *grid_; }
    bool has(const BlockCell<dim>& cell) const { return array(cell).first != nullptr; }
    /// \param offset from the cell or its first node
    Real read(const BlockCell<dim>& cell, const BlockPlace<dim>& offset = {}) const {
        BlockPlace<dim> place = cell.place;
        for (std::size_t d = 0; d < offset.size(); ++d) place[d] += offset[d];
        return array(cell).at(place);
    }
    /// The numbers of the cells that an element is divided into, and of those around them; NaN
    /// where they are not here, or not leaves of the level that has such cells.
    /// \tparam width of the patch, in cells: 2 and twice the layers around
    template <std::size_t width>
    Patch read_patch(const typename BlockGrid<dim>::Element& divided,
                     PatchNumbers<dim, width>& numbers) const;
    /// Calls write(i, its finest place, a cell near it) for the nodes that are asked for. Returns
    /// those for which it answers false.
    template <class Write>
    NodeMask at_corners(std::size_t i, const Write& write) const {
        const auto e = grid_->coarse(i).element;
        NodeMask missing = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(1 << dim); ++k) {
            if (!write(k, grid_->corner(e, k), BlockCell<dim>{})) missing |= NodeMask{1} << k;
        }
        return missing;
    }
    template <class Write>
    NodeMask at_new_nodes(const typename BlockGrid<dim>::Element& e, NodeMask which,
                          const Write& write) const {
        NodeMask missing = 0;
        BlockCell<dim> near = grid_->cover(e);
        if (near.box < 0) near = grid_->leaf_at(grid_->new_node(e, grid_->centre()), near);
        for (std::size_t n = 0; n < static_cast<std::size_t>(BlockGrid<dim>::max_new_nodes); ++n) {
            if ((which >> n & 1U) == 0) continue;
            if (!write(n, grid_->new_node(e, n), near)) missing |= NodeMask{1} << n;
        }
        return missing;
    }

private:
    const BlockArray<dim, Real>& array(const BlockCell<dim>& cell) const {
        return arrays_[static_cast<std::size_t>(cell.level)][static_cast<std::size_t>(cell.box)];
    }

    const BlockGrid<dim>* grid_;
    BlockArrays<dim, Real> arrays_;
};

}  // namespace detail

/// Data of cells, whose value at a node is that of CellAverages (cell_data.hpp) without its tables:
/// the mean of the leaves around the node by weights 1/size. At walls the mean lies beside the
/// node, and a line through it and the next node inside is followed to the wall: linear functions
/// are reproduced, and no value leaves the range of all cells by more than its length. A node that
/// hangs has the interpolant.
///
/// Reads 4^dim cells for all nodes of a split among leaves of one level, 6^dim where the rule is
/// sharp. Elsewhere it reads 2^dim cells a node, and up to 2^(3 dim) where the rule is sharp.
template <int dim, class Real>
class BlockCells {
public:
    using value_type = Real;
    using Element = typename BlockGrid<dim>::Element;

    /// \param grid borrowed
    ///
    /// \throw InvalidInput where there is not one array for each box, or numbers of one lie on each
    /// other
    BlockCells(const BlockGrid<dim>& grid, BlockArrays<dim, Real> arrays,
               CellRule rule = CellRule::smooth)
        : reader_(grid, std::move(arrays), BlockCentring::cells), rule_{rule} {}

    /// The value of the cell itself.
    double leaf_value(const Element& leaf) const {
        return static_cast<double>(reader_.read(reader_.grid().cell_of(leaf)));
    }
    NodeMask coarse_values(std::size_t i, std::span<Real> out) const {
        Smooth known(*this);
        return reader_.at_corners(i, writer(out, known));
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<Real> out) const {
        const NodeMask left = rule_ == CellRule::smooth ? smooth_in_patch(e, which, out)
                                                        : sharp_in_patch(e, which, out);
        if (left == 0) return 0;
        Smooth known(*this);
        return reader_.at_new_nodes(e, left, writer(out, known));
    }
    /// Gradients of the data themselves, not of what the values at nodes make of them: those of
    /// quadratic functions inside, also where levels meet, of linear ones at walls. 0 where numbers
    /// of cells are missing. Unless the rule is sharp_means, numbers are taken as those at centres.
    void corner_gradients(const Element& e, std::span<Point> out) const;
    /// The gradient at a node, with the bits that corner_gradients() has there.
    Point gradient_at(const typename BlockGrid<dim>::Node& node) const {
        return finite_gradient(node.place, reader_.grid().leaves_around(node.place, node.near));
    }

private:
    static constexpr auto size_ = static_cast<std::size_t>(dim);
    using Place = detail::BlockPlace<dim>;
    using Around = typename BlockGrid<dim>::Around;

    struct Mean {
        double value = 0;
        double offset = 0;  ///< of the mean from a wall, in finest places
        double low = 0;     ///< of the cells
        double high = 0;
    };
    using Node = typename BlockGrid<dim>::Node;
    /// The smooth values around the nodes of an element, each computed once, and whether all cells
    /// of one node are here.
    class Smooth;
    /// The numbers around a node that its gradient is made of.
    class Lattice;

    auto writer(std::span<Real> out, Smooth& known) const {
        return [this, out, &known](std::size_t i, const Place& node, const BlockCell<dim>& near) {
            known.is_missing = false;
            out[i] = static_cast<Real>(value({node, near}, known));
            return !known.is_missing;
        };
    }
    double cell_value(const BlockCell<dim>& cell, Smooth& known) const;
    /// The largest leaf that touches a node without having it for a corner, or null.
    const BlockCell<dim>* hangs_on(const Around& around, const Place& node) const;
    /// Calls use(corner, weight) for the corners of a leaf that count at a node within it.
    template <class Use>
    void for_each_weight(const BlockCell<dim>& leaf, const Place& node, const Use& use) const;
    /// What the corners of a leaf say at a node within it.
    template <class ValueAt>
    double interpolant(const BlockCell<dim>& leaf, const Place& node, const ValueAt& at) const;
    template <class ValueOf>
    Mean mean(const Around& around, const ValueOf& of) const;
    /// The mean, brought to the node where that lies in walls.
    template <class ValueOf>
    Mean brought(const Place& node, const Around& around, const ValueOf& of) const;
    double smooth(const Node& node, Smooth& known) const;
    double residual(const BlockCell<dim>& cell, Smooth& known) const;
    double value(const Node& node, Smooth& known) const;
    std::array<double, size_> even_slope(const Around& around) const;
    /// Per unit length; not finite where numbers are missing.
    Point gradient(const Place& node, const Around& around) const;
    /// 0 where numbers are missing.
    Point finite_gradient(const Place& node, const Around& around) const {
        const Point slope = gradient(node, around);
        return std::isfinite(dot(slope, slope)) ? slope : Point{0, 0, 0};
    }
    /// The share of the residuals that a sharp rule adds.
    double part() const { return rule_ == CellRule::sharp_centres ? 1.0 / 2 : 2.0 / 3; }
    /// Values at those new nodes of an element that lie among leaves of one level, with the same
    /// bits. Returns the nodes that are left: where levels meet, the domain ends, or cells have no
    /// numbers.
    NodeMask smooth_in_patch(const Element& e, NodeMask which, std::span<Real> out) const;
    NodeMask sharp_in_patch(const Element& e, NodeMask which, std::span<Real> out) const;

    detail::BlockReader<dim, Real> reader_;
    CellRule rule_;
};

/// Data at the nodes of each box. The value of a node is that of the finest leaf that has it.
template <int dim, class Real>
class BlockNodes {
public:
    using value_type = Real;
    using Element = typename BlockGrid<dim>::Element;

    /// \param grid borrowed
    ///
    /// \throw InvalidInput where there is not one array for each box, or numbers of one lie on each
    /// other
    BlockNodes(const BlockGrid<dim>& grid, BlockArrays<dim, Real> arrays)
        : reader_(grid, std::move(arrays), BlockCentring::nodes) {}

    NodeMask coarse_values(std::size_t i, std::span<Real> out) const {
        return reader_.at_corners(i, writer(out));
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<Real> out) const {
        return reader_.at_new_nodes(e, which, writer(out));
    }

private:
    using Place = detail::BlockPlace<dim>;

    auto writer(std::span<Real> out) const {
        return [this, out](std::size_t i, const Place& node, const BlockCell<dim>& near) {
            return write(node, near, out[i]);
        };
    }
    bool write(const Place& node, const BlockCell<dim>& near, Real& out) const;

    detail::BlockReader<dim, Real> reader_;
};

template <int dim, class Real>
detail::BlockReader<dim, Real>::BlockReader(const BlockGrid<dim>& grid,
                                            BlockArrays<dim, Real> arrays, BlockCentring centring)
    : grid_{&grid}, arrays_{std::move(arrays)} {
    if (arrays_.size() != grid.level_count()) {
        throw InvalidInput("there are arrays of " + std::to_string(arrays_.size()) +
                           " levels, but the grid has " + std::to_string(grid.level_count()));
    }
    const std::int32_t more = centring == BlockCentring::nodes ? 1 : 0;
    for (std::size_t l = 0; l < arrays_.size(); ++l) {
        if (arrays_[l].size() != grid.box_count(l)) {
            throw InvalidInput("level " + std::to_string(l) + " has " +
                               std::to_string(grid.box_count(l)) + " boxes, but " +
                               std::to_string(arrays_[l].size()) + " arrays");
        }
        for (std::size_t b = 0; b < arrays_[l].size(); ++b) {
            const BlockArray<dim, Real>& array = arrays_[l][b];
            if (array.first == nullptr) continue;
            const auto size = grid.box_size(l, b);
            for (std::size_t d = 0; d < size.size(); ++d) {
                const auto stride = array.stride[d];
                const auto step = static_cast<std::ptrdiff_t>(sizeof(Real));
                if (size[d] + more == 1 || stride >= step || stride <= -step) continue;
                throw InvalidInput("the array of box " + std::to_string(b) + " of level " +
                                   std::to_string(l) + " has the stride " + std::to_string(stride) +
                                   " in direction " + std::to_string(d) +
                                   ", less than a number of " + std::to_string(step) + " bytes");
            }
        }
    }
}

template <int dim, class Real>
bool is_leaf_missing(const BlockGrid<dim>& grid, const BlockArrays<dim, Real>& arrays) {
    bool any = false;
    for (std::size_t l = 0; l < arrays.size(); ++l) {
        for (std::size_t b = 0; b < arrays[l].size(); ++b) {
            if (arrays[l][b].first == nullptr) continue;
            BlockCell<dim> cell{static_cast<std::int32_t>(l), static_cast<std::int32_t>(b), {}, {}};
            const detail::CellRange<dim> range{{}, grid.box_size(l, b)};
            detail::for_each_place(range, [&](const detail::BlockPlace<dim>& place) {
                if (any || !std::isnan(arrays[l][b].at(place))) return;
                cell.place = place;
                any = grid.first_leaf(cell).level == cell.level;
            });
        }
    }
    return any;
}

template <int dim, class Real>
template <std::size_t width>
detail::Patch detail::BlockReader<dim, Real>::read_patch(
    const typename BlockGrid<dim>::Element& divided, PatchNumbers<dim, width>& numbers) const {
    BlockPatch<dim> patch;
    if (!grid_->patch_around(divided, (width - 2) / 2, patch)) return Patch::none;
    constexpr auto side = static_cast<std::int32_t>(width);
    std::size_t i = 0;
    if (patch.is_in_box && patch.is_whole) {
        const BlockCell<dim> first = grid_->cell_at(patch.level, patch.low, patch.box);
        if (!has(first)) return Patch::none;
        CellRange<dim> range{first.place, first.place};
        for (std::int32_t& x : range.high) x += side;
        const BlockArray<dim, Real>& of_box = array(first);
        for_each_place(range, [&](const BlockPlace<dim>& place) {
            numbers[i++] = static_cast<double>(of_box.at(place));
        });
        return Patch::all;
    }
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const auto number = [&](const BlockPlace<dim>& place) -> double& {
        std::size_t at = 0;
        for (std::size_t d = place.size(); d-- > 0;) {
            at = at * width + static_cast<std::size_t>(place[d] - patch.low[d]);
        }
        return numbers[at];
    };
    numbers.fill(none);
    bool are_all_here = patch.is_whole;
    grid_->for_each_part(patch, side, [&](BlockCell<dim> cell, const CellRange<dim>& part) {
        are_all_here = are_all_here && has(cell);
        if (!has(cell)) return;
        const BlockPlace<dim> first = cell.place;
        for_each_place(part, [&](const BlockPlace<dim>& place) {
            for (std::size_t d = 0; d < first.size(); ++d) {
                cell.place[d] = first[d] + place[d] - part.low[d];
            }
            number(place) = static_cast<double>(read(cell));
        });
    });
    grid_->for_each_covered(patch, side, [&](const BlockPlace<dim>& cell) { number(cell) = none; });
    return are_all_here ? Patch::all : Patch::some;
}

}  // namespace nestgrid

#include <nestgrid/adapters/block_cells_steps.hpp>
#include <nestgrid/adapters/block_gradients_steps.hpp>
