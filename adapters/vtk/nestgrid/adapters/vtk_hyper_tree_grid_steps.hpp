// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of HyperTreeGrid. Included at the end of vtk_hyper_tree_grid.hpp.
#pragma once

namespace nestgrid {

template <int dim>
HyperTreeGrid<dim>::HyperTreeGrid(vtkHyperTreeGrid& grid)
    : grid_{&grid}, rule_{&dyadic_rule(dim == 2 ? Shape::quadrilateral : Shape::hexahedron)} {
    if (grid.GetDimension() != dim) {
        throw InvalidInput("the hyper tree grid has dimension " +
                           std::to_string(grid.GetDimension()) + ", not " + std::to_string(dim));
    }
    if (grid.GetBranchFactor() != 2) {
        throw InvalidInput("the hyper tree grid has the branch factor " +
                           std::to_string(grid.GetBranchFactor()) + ", not 2");
    }
    depth_ = static_cast<int>(grid.GetNumberOfLevels()) - 1;
    const std::array<vtkDataArray*, 3> x{grid.GetXCoordinates(), grid.GetYCoordinates(),
                                         grid.GetZCoordinates()};
    const unsigned* points = grid.GetDimensions();
    std::size_t axes = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        if (points[d] == 1) continue;
        if (depth_ > 30 || points[d] >= 1U << (31 - depth_)) {
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

template <int dim>
std::uint64_t HyperTreeGrid<dim>::epoch() const {
    NodeKey sum = detail::mix(sizes_ + static_cast<NodeKey>(grid_->GetMTime()));
    for (vtkObject* part : std::initializer_list<vtkObject*>{
             grid_->GetMask(), grid_->GetGhostCells(), grid_->GetXCoordinates(),
             grid_->GetYCoordinates(), grid_->GetZCoordinates()}) {
        const auto time = part == nullptr ? vtkMTimeType{0} : part->GetMTime();
        sum = detail::mix(sum + static_cast<NodeKey>(time));
    }
    return static_cast<std::uint64_t>(sum);
}

template <int dim>
Hidden HyperTreeGrid<dim>::read_mask(const Element& e, bool masked) {
    masked = masked || (mask_ != nullptr && mask_->GetValue(index(e)) != 0);
    if (split(e) == nullptr && ghosts_ != nullptr && ghosts_->GetValue(index(e)) != 0) {
        masked = true;  // another process has the cell
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
