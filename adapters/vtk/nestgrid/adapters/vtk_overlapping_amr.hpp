// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's overlapping AMR as blocks (block_grid.hpp), in place: what its readers of AMReX, Enzo and
// FLASH and of .vthb files give. Of cells that a finer level covers, nothing is read.
//
//     const BlockGrid<3> grid(vtk_blocks<3>(*amr));
//     const BlockCells<3, double> field(grid, vtk_block_arrays<3, double>(*amr, "density"));
//
// Readers list the boxes of all levels, and have data of those that they were told to read: the
// levels from the first one without data on are left out.
#pragma once

#include <cmath>
#include <span>

#include <vtkAMRBox.h>
#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellData.h>
#include <vtkOverlappingAMR.h>
#include <vtkStructuredData.h>
#include <vtkUniformGrid.h>

#include <nestgrid/adapters/block_fields.hpp>

namespace nestgrid {

namespace detail {

inline std::string text_of_block(std::size_t level, std::size_t block) {
    return "block " + std::to_string(block) + " of level " + std::to_string(level);
}

inline vtkUniformGrid* amr_block(vtkOverlappingAMR& amr, std::size_t level, std::size_t block) {
    return amr.GetDataSet(static_cast<unsigned>(level), static_cast<unsigned>(block));
}

/// The axes along which the cells go.
/// \throw InvalidInput for another dimension
template <int dim>
std::array<int, static_cast<std::size_t>(dim)> amr_axes(vtkOverlappingAMR& amr) {
    const int grid = amr.GetGridDescription();
    if constexpr (dim == 3) {
        if (grid == VTK_XYZ_GRID) return {0, 1, 2};
        throw InvalidInput("the overlapping AMR is not of dimension 3");
    } else {
        if (grid == VTK_XY_PLANE) return {0, 1};
        if (grid == VTK_XZ_PLANE) return {0, 2};
        if (grid == VTK_YZ_PLANE) return {1, 2};
        throw InvalidInput("the overlapping AMR does not lie in a plane across an axis");
    }
}

/// How many levels have data.
/// \throw InvalidInput where some blocks of a level have data and others have none
inline std::size_t amr_levels_with_data(vtkOverlappingAMR& amr) {
    for (std::size_t l = 0; l < amr.GetNumberOfLevels(); ++l) {
        const std::size_t blocks = amr.GetNumberOfDataSets(static_cast<unsigned>(l));
        std::size_t without = 0;
        std::size_t last = 0;
        for (std::size_t b = 0; b < blocks; ++b) {
            if (amr_block(amr, l, b) != nullptr) continue;
            ++without;
            last = b;
        }
        if (without == blocks) return l;
        if (without > 0) {
            throw InvalidInput(text_of_block(l, last) +
                               " has no data, but other blocks of the level do");
        }
    }
    return amr.GetNumberOfLevels();
}

/// \throw InvalidInput where a block lies elsewhere than its box, or has cells of another size, as
/// readers leave them that take a block for one of another level
inline void require_place(vtkOverlappingAMR& amr, std::size_t level, std::size_t block,
                          std::span<const int> axes) {
    vtkUniformGrid* const grid = amr_block(amr, level, block);
    const vtkAMRBox& box =
        amr.GetAMRBox(static_cast<unsigned>(level), static_cast<unsigned>(block));
    std::array<double, 3> spacing{};
    amr.GetSpacing(static_cast<unsigned>(level), spacing.data());
    for (const int axis : axes) {
        const auto d = static_cast<std::size_t>(axis);
        const double begin = amr.GetOrigin()[d] + box.GetLoCorner()[d] * spacing[d];
        const bool is_there = std::abs(grid->GetOrigin()[d] - begin) <= 1e-3 * spacing[d] &&
                              std::abs(grid->GetSpacing()[d] - spacing[d]) <= 1e-3 * spacing[d];
        if (is_there) continue;
        throw InvalidInput(text_of_block(level, block) +
                           " does not lie in its box: it is of another level, or of another place");
    }
}

/// How many cells of a level there are along a side of one of the level before.
/// \throw InvalidInput where that is no whole number
inline int whole_ratio(double coarse, double fine, std::size_t level) {
    const double ratio = coarse / fine;
    if (!(ratio > 0.5 && ratio < 1e6) || std::abs(ratio - std::round(ratio)) > 1e-3 * ratio) {
        throw InvalidInput("cells of level " + std::to_string(level) + " are " +
                           std::to_string(ratio) +
                           " times smaller than those before, not by a whole number");
    }
    return static_cast<int>(std::lround(ratio));
}

/// The box of a block along the axes of its cells.
template <int dim>
BlockBox<dim> amr_box(vtkOverlappingAMR& amr, std::size_t level, std::size_t block) {
    const vtkAMRBox& from =
        amr.GetAMRBox(static_cast<unsigned>(level), static_cast<unsigned>(block));
    BlockBox<dim> box;
    const auto axes = amr_axes<dim>(amr);
    for (std::size_t d = 0; d < axes.size(); ++d) {
        box.lower[d] = from.GetLoCorner()[axes[d]];
        box.upper[d] = from.GetHiCorner()[axes[d]];
    }
    return box;
}

/// The numbers of one block.
/// \throw InvalidInput as vtk_block_arrays()
template <int dim, class Real>
BlockArray<dim, Real> amr_array(vtkOverlappingAMR& amr, std::size_t level, std::size_t block,
                                const std::string& name, int component) {
    vtkUniformGrid* const grid = amr_block(amr, level, block);
    vtkDataArray* const data = grid->GetCellData()->GetArray(name.c_str());
    const auto refuse = [&](const std::string& what) {
        throw InvalidInput(text_of_block(level, block) + " has " + what);
    };
    if (data == nullptr) refuse("no array '" + name + "' of its cells");
    auto* const numbers = vtkAOSDataArrayTemplate<Real>::FastDownCast(data);
    if (numbers == nullptr) {
        refuse("an array '" + name + "' of the type " + data->GetClassName() + ", not of " +
               (sizeof(Real) == sizeof(double) ? "doubles" : "floats") + " one behind the other");
    }
    const int components = numbers->GetNumberOfComponents();
    if (component < 0 || component >= components) {
        refuse("an array '" + name + "' of " + std::to_string(components) +
               " components, without component " + std::to_string(component));
    }
    const BlockBox<dim> box = amr_box<dim>(amr, level, block);
    BlockArray<dim, Real> array;
    std::ptrdiff_t stride = std::ptrdiff_t{components} * static_cast<std::ptrdiff_t>(sizeof(Real));
    std::array<int, 3> points{};
    grid->GetDimensions(points.data());
    const auto axes = amr_axes<dim>(amr);
    for (std::size_t d = 0; d < array.stride.size(); ++d) {
        const int cells = box.upper[d] - box.lower[d] + 1;
        const int cells_of_block = points[static_cast<std::size_t>(axes[d])] - 1;
        if (cells_of_block != cells) {
            refuse(std::to_string(cells_of_block) + " cells in direction " +
                   std::to_string(axes[d]) + ", but its box " + std::to_string(cells));
        }
        array.stride[d] = stride;
        stride *= cells;
    }
    if (numbers->GetNumberOfValues() * static_cast<vtkIdType>(sizeof(Real)) < stride) {
        refuse("an array '" + name + "' that is shorter than its cells");
    }
    array.first = numbers->GetPointer(component);
    return array;
}

}  // namespace detail

/// The boxes of the levels that have data.
///
/// \throw InvalidInput where there are none, where a level has data in part, where a block does not
/// lie in its box, where the ratio of two levels is no whole number, and where the grid does not
/// lie in space (dim = 3), or in a plane across an axis (dim = 2); BlockGrid checks the boxes
template <int dim>
Blocks<dim> vtk_blocks(vtkOverlappingAMR& amr) {
    const std::size_t levels = detail::amr_levels_with_data(amr);
    if (levels == 0) throw InvalidInput("the overlapping AMR has no data");
    Blocks<dim> blocks;
    blocks.axes = detail::amr_axes<dim>(amr);
    std::array<double, 3> coarse{};
    for (std::size_t l = 0; l < levels; ++l) {
        BlockLevel<dim>& level = blocks.levels.emplace_back();
        for (std::size_t b = 0; b < amr.GetNumberOfDataSets(static_cast<unsigned>(l)); ++b) {
            detail::require_place(amr, l, b, blocks.axes);
            level.boxes.push_back(detail::amr_box<dim>(amr, l, b));
        }
        std::array<double, 3> spacing{};
        amr.GetSpacing(static_cast<unsigned>(l), spacing.data());
        for (std::size_t d = 0; d < level.ratio.size(); ++d) {
            const auto axis = static_cast<std::size_t>(blocks.axes[d]);
            if (l > 0) level.ratio[d] = detail::whole_ratio(coarse[axis], spacing[axis], l);
            if (l == 0) blocks.spacing[d] = spacing[axis];
        }
        coarse = spacing;
    }
    std::copy_n(amr.GetOrigin(), 3, blocks.origin.begin());
    for (std::size_t d = 0; d < blocks.axes.size(); ++d) {
        int first = blocks.levels[0].boxes[0].lower[d];
        for (const BlockBox<dim>& box : blocks.levels[0].boxes) {
            first = std::min(first, box.lower[d]);
        }
        blocks.origin[static_cast<std::size_t>(blocks.axes[d])] += first * blocks.spacing[d];
    }
    return blocks;
}

/// Where the cells of the levels that have data have one component of an array.
///
/// \throw InvalidInput naming block and array where a block lacks it, or has it of another type, or
/// has another number of cells than its box, as with ghost cells inside
template <int dim, class Real>
BlockArrays<dim, Real> vtk_block_arrays(vtkOverlappingAMR& amr, const std::string& name,
                                        int component = 0) {
    BlockArrays<dim, Real> arrays(detail::amr_levels_with_data(amr));
    for (std::size_t l = 0; l < arrays.size(); ++l) {
        for (std::size_t b = 0; b < amr.GetNumberOfDataSets(static_cast<unsigned>(l)); ++b) {
            arrays[l].push_back(detail::amr_array<dim, Real>(amr, l, b, name, component));
        }
    }
    return arrays;
}

}  // namespace nestgrid
