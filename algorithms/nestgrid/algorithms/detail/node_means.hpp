// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Values at nodes from values of cells, each the mean of a cell or the value at its centre.
//
// The mean of the cells around a node, weighted by 1/size, lies at the node where the cells are
// cubes that fill all octants, whatever their sizes: each pulls by half its size times 1/size.
// Elsewhere, at walls, on other shapes and where spacings differ, the mean lies beside the node,
// and a gradient brings it there: of the linear function that fits best the cells around the node
// and those of their other corners that have a value already. Nodes inside come first, then walls,
// edges and corners of the domain. So a linear function is reproduced at every node whose cells,
// with those corners, span the space.
//
// Invariants:
//   - a value is within the range of the cells around it where the node lies between their centres;
//     beyond them, as at a wall, it leaves that range by no more than twice what the numbers differ
//     by that it is made of, and the range of all cells by no more than its length;
//   - equal values give that value, to the last bit;
//   - the numbering of cells, of nodes and of corners does not matter, to the last bit; nor does it
//     matter which rank has which cells.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid::engine {
class SharedNodes;
}

namespace nestgrid::detail {

/// A cell with its value, and the keys and positions of its corners.
struct CellWithValue {
    Shape shape = Shape::point;
    std::span<const NodeKey> keys;
    std::span<const Point> positions;
    double value = 0;
};

/// Calls a function for every cell; each time alike.
using ForEachCell = std::function<void(const std::function<void(const CellWithValue&)>&)>;

class NodeMeans {
public:
    NodeMeans() = default;
    /// Collective, on ranks.
    /// \param dimension of the cells
    /// \param for_each_cell of this rank; called twice, once more on ranks
    /// \param shared of the grid, or null where all cells are here
    NodeMeans(int dimension, const ForEachCell& for_each_cell,
              const engine::SharedNodes* shared = nullptr);

    /// Takes off second differences, within the range of the cells around a node and its value.
    /// Collective, on ranks.
    /// \param for_each_cell as before; called three times, five times on ranks
    /// \param part of what cells differ by from the means of their corners: 1/2 where their values
    ///        are those at their centres, 2/3 where they are means
    void sharpen(int dimension, const ForEachCell& for_each_cell, double part);

    /// The value at a node, or null where no cell of this rank has it for a corner. It is not a
    /// number where the value of a cell around the node is not finite.
    const double* find(NodeKey key) const {
        const std::uint32_t* number = number_.find(key);
        return number == nullptr || *number >= own_ ? nullptr : &values_[*number];
    }
    /// A value between those of all cells.
    double middle() const { return middle_; }
    std::size_t memory_bytes() const {
        return number_.memory_bytes() + values_.capacity() * sizeof(double);
    }

private:
    KeyTable<NodeKey, std::uint32_t> number_;
    std::vector<double> values_;
    std::size_t own_ = 0;  // nodes of cells of this rank; others come behind them
    double middle_ = 0;
    const engine::SharedNodes* shared_ = nullptr;
};

}  // namespace nestgrid::detail
