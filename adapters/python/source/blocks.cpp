// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boxes of cells on levels: arrays, which are borrowed, and plotfiles of AMReX, which are mapped.
#include <algorithm>

#include <nestgrid/adapters/amrex_plotfile.hpp>

#include "source.hpp"

namespace nestgrid::python {

namespace {

/// \param memory that the arrays lie in
template <int dim, class Real>
Frames frames_of(std::shared_ptr<const BlockGrid<dim>> grid, BlockArrays<dim, Real> arrays,
                 CellRule rule, double time, const std::shared_ptr<const void>& memory,
                 const Call& call) {
    const bool any_missing = is_leaf_missing(*grid, arrays);
    std::vector<BlockCells<dim, Real>> fields;
    fields.emplace_back(*grid, std::move(arrays), rule);
    const Frames frames = shared_frames(grid, std::move(fields), {time}, memory);
    return any_missing ? frames.without_missing(call.work()) : frames;
}

template <int dim>
Blocks<dim> boxes_of(const BoxArrays& given) {
    Blocks<dim> blocks;
    blocks.origin = given.origin;
    blocks.spacing = given.spacing;
    for (std::size_t l = 0; l < given.ratios.size(); ++l) {
        blocks.levels.emplace_back();
        blocks.levels[l].ratio.fill(given.ratios[l]);
    }
    for (const BoxOfNumbers& from : given.boxes) {
        BlockBox<dim> box;
        for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
            box.lower[d] = from.lower[d];
            box.upper[d] = from.lower[d] + from.shape[d] - 1;
        }
        blocks.levels[static_cast<std::size_t>(from.level)].boxes.push_back(box);
    }
    return blocks;
}

template <int dim, class Real>
std::shared_ptr<Source> source_of(const BoxArrays& given, const Call& call) {
    BlockArrays<dim, Real> arrays(given.ratios.size());
    for (const BoxOfNumbers& from : given.boxes) {
        BlockArray<dim, Real> array;
        array.first = from.data;
        std::copy_n(from.stride.begin(), dim, array.stride.begin());
        arrays[static_cast<std::size_t>(from.level)].push_back(array);
    }
    auto grid = std::make_shared<const BlockGrid<dim>>(boxes_of<dim>(given));
    return std::make_shared<Source>(
        frames_of(std::move(grid), std::move(arrays), given.rule, 0, given.memory, call)[0]);
}

template <int dim, class Real>
LoadedField field_of(const std::shared_ptr<const AmrexPlotfile>& file, const std::string& array,
                     CellRule rule, const Call& call) {
    const std::size_t field = index_of_field(file->fields(), array);
    auto grid = std::make_shared<const BlockGrid<dim>>(file->blocks<dim>());
    return {
        frames_of(std::move(grid), file->arrays<dim, Real>(field), rule, file->time(), file, call),
        file->fields()[field]};
}

}  // namespace

std::shared_ptr<Source> make_blocks(const BoxArrays& given, const Call& call) {
    if (given.dimension == 2) {
        return given.is_double ? source_of<2, double>(given, call)
                               : source_of<2, float>(given, call);
    }
    return given.is_double ? source_of<3, double>(given, call) : source_of<3, float>(given, call);
}

LoadedField load_plotfile(const std::filesystem::path& path, const std::string& array,
                          CellRule rule, const Call& call) {
    const auto file = std::make_shared<const AmrexPlotfile>(path);
    if (file->dimension() == 2) {
        return file->is_double() ? field_of<2, double>(file, array, rule, call)
                                 : field_of<2, float>(file, array, rule, call);
    }
    return file->is_double() ? field_of<3, double>(file, array, rule, call)
                             : field_of<3, float>(file, array, rule, call);
}

}  // namespace nestgrid::python
