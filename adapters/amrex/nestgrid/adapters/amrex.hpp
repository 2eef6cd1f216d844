// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Levels of AMReX's MultiFabs, in place. No header of AMReX is included: what is asked is
//     of a MultiFab    boxArray(), nComp(), IndexArray(), is_cell_centered(), is_nodal(),
//                      value_type, atLocalIdx(i): the i-th of the boxes that are here
//     of a BoxArray    size(), operator[](i)
//     of a Box         smallEnd(d), bigEnd(d)
//     of a Fab         box(), with ghost cells, and dataPtr(component)
//     of a Geometry    ProbLo(d), CellSize(d), of level 0
// Ghost cells, and coarse cells under finer ones, may hold anything. The memory must be that of the
// host.
#pragma once

#include <nestgrid/adapters/block_fields.hpp>

namespace nestgrid {

namespace detail {

template <class Levels>
using MultiFabOf = std::decay_t<decltype(*std::declval<const Levels&>()[0])>;
template <class Levels>
using AmrexValue = std::remove_const_t<typename MultiFabOf<Levels>::value_type>;

template <int dim, class Box>
BlockBox<dim> block_box(const Box& box, int fewer) {
    BlockBox<dim> result;
    for (int d = 0; d < dim; ++d) {
        result.lower[static_cast<std::size_t>(d)] = box.smallEnd(d);
        result.upper[static_cast<std::size_t>(d)] = box.bigEnd(d) - fewer;
    }
    return result;
}

/// \throw InvalidInput unless each level is as it must be
template <class Levels>
void require_centring(const Levels& levels, int component, BlockCentring centring) {
    for (std::size_t l = 0; l < static_cast<std::size_t>(levels.size()); ++l) {
        const auto& level = *levels[static_cast<int>(l)];
        const bool fits =
            centring == BlockCentring::cells ? level.is_cell_centered() : level.is_nodal();
        if (!fits) {
            throw InvalidInput(
                "the MultiFab of level " + std::to_string(l) + " has no data of " +
                (centring == BlockCentring::cells ? "cells" : "nodes, in all directions"));
        }
        if (component < 0 || component >= level.nComp()) {
            throw InvalidInput("the MultiFab of level " + std::to_string(l) + " has " +
                               std::to_string(level.nComp()) + " components, no number " +
                               std::to_string(component));
        }
    }
}

/// \throw InvalidInput where a level is none of the grid, or an array is smaller than its box
template <int dim, class Levels>
auto amrex_arrays(const Levels& levels, int component, BlockCentring centring) {
    using Real = AmrexValue<Levels>;
    require_centring(levels, component, centring);
    BlockArrays<dim, Real> arrays;
    for (std::size_t l = 0; l < static_cast<std::size_t>(levels.size()); ++l) {
        const auto& level = *levels[static_cast<int>(l)];
        arrays.emplace_back(static_cast<std::size_t>(level.boxArray().size()));
        const auto& here = level.IndexArray();
        for (int i = 0; i < static_cast<int>(here.size()); ++i) {
            const auto& fab = level.atLocalIdx(i);
            const auto box = block_box<dim>(level.boxArray()[here[i]], 0);
            const auto stored = block_box<dim>(fab.box(), 0);
            BlockArray<dim, Real>& array = arrays[l][static_cast<std::size_t>(here[i])];
            const Real* first = fab.dataPtr(component);
            std::ptrdiff_t stride = 1;
            for (std::size_t d = 0; d < box.lower.size(); ++d) {
                array.stride[d] = stride * static_cast<std::ptrdiff_t>(sizeof(Real));
                first += stride * (box.lower[d] - stored.lower[d]);
                stride *= stored.upper[d] - stored.lower[d] + 1;
            }
            array.first = first;
        }
    }
    return arrays;
}

}  // namespace detail

/// The boxes of MultiFabs of cells or of nodes.
/// \param levels pointers to MultiFabs, coarse to fine, such as an amrex::Vector<const MultiFab*>
/// \param geometry of level 0, or of all levels from there on
/// \param ratios of levels to the next one, such as an amrex::Vector<amrex::IntVect>
///
/// \throw InvalidInput where there are fewer ratios than that; BlockGrid checks the boxes
template <int dim, class Levels, class Geometry, class Ratios>
Blocks<dim> amrex_blocks(const Levels& levels, const Geometry& geometry, const Ratios& ratios) {
    Blocks<dim> blocks;
    const auto count = static_cast<std::size_t>(levels.size());
    if (static_cast<std::size_t>(ratios.size()) + 1 < count) {
        throw InvalidInput("there are " + std::to_string(ratios.size()) + " ratios between " +
                           std::to_string(count) + " levels");
    }
    for (std::size_t l = 0; l < count; ++l) {
        const auto& level = *levels[static_cast<int>(l)];
        BlockLevel<dim>& result = blocks.levels.emplace_back();
        const int fewer = level.is_nodal() ? 1 : 0;
        const auto boxes = static_cast<int>(level.boxArray().size());
        for (int b = 0; b < boxes; ++b) {
            result.boxes.push_back(detail::block_box<dim>(level.boxArray()[b], fewer));
        }
        for (int d = 0; l > 0 && d < dim; ++d) {
            result.ratio[static_cast<std::size_t>(d)] = ratios[static_cast<int>(l) - 1][d];
        }
    }
    for (int d = 0; d < dim; ++d) {
        blocks.spacing[static_cast<std::size_t>(d)] = geometry.CellSize(d);
        blocks.origin[static_cast<std::size_t>(d)] = geometry.ProbLo(d);
    }
    return blocks;
}

/// A component of MultiFabs of cells.
///
/// \throw InvalidInput where they have other data, no such component, or not the boxes of the grid
template <int dim, class Levels>
auto amrex_cells(const BlockGrid<dim>& grid, const Levels& levels, int component = 0,
                 CellRule rule = CellRule::smooth) {
    return BlockCells<dim, detail::AmrexValue<Levels>>(
        grid, detail::amrex_arrays<dim>(levels, component, BlockCentring::cells), rule);
}

/// A component of MultiFabs of nodes.
///
/// \throw InvalidInput as amrex_cells()
template <int dim, class Levels>
auto amrex_nodes(const BlockGrid<dim>& grid, const Levels& levels, int component = 0) {
    return BlockNodes<dim, detail::AmrexValue<Levels>>(
        grid, detail::amrex_arrays<dim>(levels, component, BlockCentring::nodes));
}

}  // namespace nestgrid
