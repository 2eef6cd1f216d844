// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of HyperTreeGrid. Included at the end of vtk_hyper_tree_grid.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace nestgrid {

namespace detail {

/// Nodes are those of a lattice of thirds, each a mean of the corners around it.
inline Rule make_ternary_rule(Shape shape, int dim) {
    constexpr int side = 4;  // nodes along an edge
    const int corners = 1 << dim;
    const auto digit = [](int number, int base, int d) {
        for (; d > 0; --d) number /= base;
        return number % base;
    };
    const int nodes = dim == 2 ? 16 : 64;
    std::vector<std::uint8_t> number(static_cast<std::size_t>(nodes));  // in the rule, by place
    std::vector<Stencil> stencils;
    for (int place = 0; place < nodes; ++place) {
        Stencil stencil;
        for (int k = 0; k < corners; ++k) {
            int weight = 1;
            for (int d = 0; d < dim; ++d) {
                const int at = digit(place, side, d);
                weight *= (k >> d & 1) != 0 ? at : 3 - at;
            }
            if (weight == 0) continue;
            stencil.parent[stencil.count] = static_cast<std::uint8_t>(k);
            stencil.weight[stencil.count++] = weight / (dim == 2 ? 9.0 : 27.0);
        }
        const bool is_corner = stencil.count == 1;
        number[static_cast<std::size_t>(place)] =
            is_corner ? stencil.parent[0]
                      : static_cast<std::uint8_t>(corners + static_cast<int>(stencils.size()));
        if (!is_corner) stencils.push_back(stencil);
    }
    std::vector<Child> children;
    for (int c = 0; c < (dim == 2 ? 9 : 27); ++c) {
        Child child{shape, {}, 1, {}};
        for (int k = 0; k < corners; ++k) {
            int place = 0;
            for (int d = dim; d-- > 0;) place = side * place + digit(c, 3, d) + (k >> d & 1);
            child.corner[static_cast<std::size_t>(k)] = number[static_cast<std::size_t>(place)];
        }
        children.push_back(child);
    }
    return make_rule("thirds", shape, std::move(stencils), std::move(children));
}

template <int dim, int factor>
const Rule& rule_of_trees() {
    constexpr Shape shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;
    if constexpr (factor == 2) {
        return dyadic_rule(shape);
    } else {
        static const Rule rule = make_ternary_rule(shape, dim);
        return rule;
    }
}

}  // namespace detail

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
    depth_ = static_cast<int>(grid.GetNumberOfLevels()) - 1;
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
    find_shared_nodes();
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
    while (!e.tree->IsLeaf(e.vertex)) {
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
    NodeMask hanging = 0;
    for (std::size_t s = 0; s < shared_.size(); ++s) {
        if ((shared_[s] & ~hanging) == 0) continue;
        Place beside = step(e.place, s, 3);
        bool is_inside = true;
        for (std::size_t a = 0; a < dim; ++a) {
            is_inside = is_inside && beside[axis_[a]] > 0;
            --beside[axis_[a]];
        }
        if (is_inside && is_undivided(beside, e.level)) hanging |= shared_[s];
    }
    return hanging;
}

template <int dim, int factor>
void HyperTreeGrid<dim, factor>::find_shared_nodes() {
    for (std::size_t s = 0; s < shared_.size(); ++s) {
        if (s == shared_.size() / 2) continue;  // the element itself
        for (std::size_t n = 0; n < static_cast<std::size_t>(max_new_nodes); ++n) {
            std::size_t child = rule_->new_corner[n].child;
            std::size_t side = s;
            bool is_shared = true;
            for (std::size_t a = 0; a < dim; ++a) {
                const std::size_t at = child % factor + (rule_->new_corner[n].corner >> a & 1U);
                is_shared = is_shared && (side % 3 == 1 || at == (side % 3 == 0 ? 0 : factor));
                child /= factor;
                side /= 3;
            }
            if (is_shared) shared_[s] |= NodeMask{1} << n;
        }
    }
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
