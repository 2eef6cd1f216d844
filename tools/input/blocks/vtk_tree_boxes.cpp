// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/blocks/vtk_tree_boxes.hpp"

#include <algorithm>
#include <cmath>

#include <vtkBitArray.h>
#include <vtkHyperTree.h>
#include <vtkUnsignedCharArray.h>

namespace {

using nestgrid::InvalidInput;
using Place = std::array<int, 3>;

/// The boxes below one tree.
class BoxesOfTree {
public:
    BoxesOfTree(TreeBoxes& out, vtkHyperTree& tree) : out_{&out}, tree_{&tree} {}

    /// Adds boxes as long as all cells of one are divided, then goes on in each part.
    /// \param top a cell, by its number in the tree
    void add_below(vtkIdType top, std::size_t level, Place place) {
        if (tree_->IsLeaf(top)) return;
        std::vector<vtkIdType> cells{top};
        int side = 1;
        const auto is_leaf = [&](vtkIdType each) { return tree_->IsLeaf(each); };
        while (std::none_of(cells.begin(), cells.end(), is_leaf)) {
            cells = divided(cells, side);
            side *= 2;
            for (int& x : place) x *= 2;
            add_box(cells, ++level, place, side);
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            Place at = place;
            int rest = static_cast<int>(i);
            for (int d = 0; d < out_->dimension; ++d, rest /= side) {
                at[static_cast<std::size_t>(d)] += rest % side;
            }
            add_below(cells[i], level, at);
        }
    }

private:
    std::vector<vtkIdType> divided(const std::vector<vtkIdType>& cells, int side) const {
        const bool is_flat = out_->dimension == 2;
        std::vector<vtkIdType> result(cells.size() * (is_flat ? 4 : 8));
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const int n = static_cast<int>(i);
            const Place at{2 * (n % side), 2 * (n / side % side), 2 * (n / side / side)};
            const vtkIdType first = tree_->GetElderChildIndex(static_cast<unsigned>(cells[i]));
            for (int c = 0; c < (is_flat ? 4 : 8); ++c) {
                const int to = ((at[2] + (c >> 2)) * 2 * side + at[1] + (c >> 1 & 1)) * 2 * side +
                               at[0] + (c & 1);
                result[static_cast<std::size_t>(to)] = first + c;
            }
        }
        return result;
    }
    void add_box(const std::vector<vtkIdType>& cells, std::size_t level, const Place& low,
                 int side) {
        if (level == out_->blocks.levels.size()) {
            out_->blocks.levels.emplace_back().ratio = {2, 2, out_->dimension == 2 ? 1 : 2};
            out_->cells.emplace_back();
        }
        Place high = low;
        for (int d = 0; d < out_->dimension; ++d) high[static_cast<std::size_t>(d)] += side - 1;
        out_->blocks.levels[level].boxes.push_back({low, high});
        auto& numbers = out_->cells[level].emplace_back();
        for (const vtkIdType each : cells) numbers.push_back(tree_->GetGlobalIndexFromLocal(each));
    }

    TreeBoxes* out_;
    vtkHyperTree* tree_;
};

/// Whether the coordinates of trees ascend by one distance.
bool is_even(vtkDataArray& along) {
    const vtkIdType trees = along.GetNumberOfTuples() - 1;
    const double begin = along.GetTuple1(0);
    const double step = (along.GetTuple1(trees) - begin) / static_cast<double>(trees);
    for (vtkIdType i = 0; i <= trees; ++i) {
        const double off = along.GetTuple1(i) - begin - static_cast<double>(i) * step;
        if (!(std::abs(off) <= 1e-3 * step)) return false;
    }
    return true;
}

void place_trees(TreeBoxes& out) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(out.dimension); ++d) {
        vtkDataArray& along = *coordinates_of(*out.grid)[d];
        const vtkIdType trees = along.GetNumberOfTuples() - 1;
        out.blocks.origin[d] = along.GetTuple1(0);
        out.blocks.spacing[d] =
            (along.GetTuple1(trees) - out.blocks.origin[d]) / static_cast<double>(trees);
    }
    if (out.dimension == 2) out.blocks.origin[2] = coordinates_of(*out.grid)[2]->GetTuple1(0);
}

}  // namespace

std::array<vtkDataArray*, 3> coordinates_of(vtkHyperTreeGrid& grid) {
    return {grid.GetXCoordinates(), grid.GetYCoordinates(), grid.GetZCoordinates()};
}

void require_masks(vtkHyperTreeGrid& grid) {
    const vtkIdType cells = grid.GetGlobalNodeIndexMax() + 1;
    const vtkUnsignedCharArray* const ghosts = grid.GetGhostCells();
    if ((grid.HasMask() && grid.GetMask()->GetNumberOfValues() < cells) ||
        (ghosts != nullptr && ghosts->GetNumberOfValues() < cells)) {
        throw InvalidInput("its mask or its ghost array has fewer entries than cells");
    }
}

bool trees_fill_boxes(vtkHyperTreeGrid& grid) {
    require_masks(grid);
    vtkUnsignedCharArray* const ghosts = grid.GetGhostCells();
    const vtkIdType last = grid.GetGlobalNodeIndexMax();  // asks each tree
    for (vtkIdType i = 0; i <= last; ++i) {
        if (grid.HasMask() && grid.GetMask()->GetValue(i) != 0) return false;
        if (ghosts != nullptr && ghosts->GetValue(i) != 0) return false;
    }
    for (vtkIdType t = 0; t < grid.GetMaxNumberOfTrees(); ++t) {
        if (grid.GetTree(t) == nullptr) return false;
    }
    const auto along = coordinates_of(grid);
    return std::ranges::all_of(
        along, [](vtkDataArray* each) { return each->GetNumberOfTuples() < 2 || is_even(*each); });
}

TreeBoxes tree_boxes(const vtkSmartPointer<vtkHyperTreeGrid>& grid) {
    const unsigned* const points = grid->GetDimensions();
    TreeBoxes out{grid, points[2] == 1 ? 2 : 3, {}, {}};
    place_trees(out);
    const int deep = out.dimension == 2 ? 1 : static_cast<int>(points[2]) - 1;
    const Place last{static_cast<int>(points[0]) - 2, static_cast<int>(points[1]) - 2, deep - 1};
    out.blocks.levels.push_back({{{{0, 0, 0}, last}}, {}});
    const auto trees = static_cast<std::size_t>(grid->GetMaxNumberOfTrees());
    out.cells.push_back({std::vector<vtkIdType>(trees)});
    for (vtkIdType t = 0; t < grid->GetMaxNumberOfTrees(); ++t) {
        vtkHyperTree* const tree = grid->GetTree(t);
        std::array<unsigned, 3> at{};
        grid->GetLevelZeroCoordinatesFromIndex(t, at[0], at[1], at[2]);
        const Place place{static_cast<int>(at[0]), static_cast<int>(at[1]),
                          static_cast<int>(at[2])};
        BoxesOfTree boxes(out, *tree);
        const int number = (place[2] * (last[1] + 1) + place[1]) * (last[0] + 1) + place[0];
        out.cells[0][0][static_cast<std::size_t>(number)] = tree->GetGlobalIndexFromLocal(0);
        boxes.add_below(0, 0, place);
    }
    return out;
}
