// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boxes of cells on levels: arrays, which are borrowed, and plotfiles of AMReX, which are mapped.
#include <algorithm>

#include <nestgrid/adapters/amrex_plotfile.hpp>
#include <nestgrid/algorithms/frame_weights.hpp>

#include "source.hpp"

namespace nestgrid::python {

namespace {

/// \throw InvalidInput where a file or frame has another grid than the first
template <int dim>
void require_one_grid(const Blocks<dim>& first, const BlockGrid<dim>& grid,
                      const Blocks<dim>& other, const std::string& first_name,
                      const std::string& name) {
    if (other.origin == first.origin && other.spacing == first.spacing &&
        other.axes == first.axes && BlockGrid<dim>(other).epoch() == grid.epoch()) {
        return;
    }
    throw InvalidInput(name + " has another grid than " + first_name);
}

void require_same(bool is_same, const char* what, const std::string& first_name,
                  const std::string& name) {
    if (!is_same) throw InvalidInput(name + " has " + what + " than " + first_name);
}

/// \param memory that the arrays lie in
template <int dim, class Real>
Frames frames_of(std::shared_ptr<const BlockGrid<dim>> grid,
                 std::vector<BlockArrays<dim, Real>> arrays, CellRule rule,
                 std::vector<double> times, const std::shared_ptr<const void>& memory,
                 const Call& call) {
    linear_weights(times, times.front());  // refuses times that do not ascend
    bool any_missing = false;
    std::vector<BlockCells<dim, Real>> fields;
    for (BlockArrays<dim, Real>& each : arrays) {
        any_missing = any_missing || is_leaf_missing(*grid, each);
        fields.emplace_back(*grid, std::move(each), rule);
    }
    const Frames frames = shared_frames(grid, std::move(fields), std::move(times), memory);
    return any_missing ? frames.without_missing(call.work()) : frames;
}

template <int dim>
Blocks<dim> boxes_of(const BoxArrays& given) {
    Blocks<dim> blocks;
    blocks.origin = given.origin;
    blocks.spacing = given.spacing;
    std::ranges::copy(given.axes, blocks.axes.begin());
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
BlockArrays<dim, Real> arrays_of(const BoxArrays& given) {
    BlockArrays<dim, Real> arrays(given.ratios.size());
    for (const BoxOfNumbers& from : given.boxes) {
        BlockArray<dim, Real> array;
        array.first = from.data;
        std::copy_n(from.stride.begin(), dim, array.stride.begin());
        arrays[static_cast<std::size_t>(from.level)].push_back(array);
    }
    return arrays;
}

template <int dim, class Real>
Frames frames_of(const std::vector<BoxArrays>& frames, std::vector<double> times,
                 const std::vector<std::string>& names, const Call& call) {
    const Blocks<dim> first = boxes_of<dim>(frames.front());
    auto grid = std::make_shared<const BlockGrid<dim>>(first);
    std::vector<BlockArrays<dim, Real>> arrays;
    std::vector<std::shared_ptr<const void>> memory;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (i > 0) {
            require_one_grid(first, *grid, boxes_of<dim>(frames[i]), names.front(), names[i]);
        }
        arrays.push_back(arrays_of<dim, Real>(frames[i]));
        memory.push_back(frames[i].memory);
    }
    const auto all = std::make_shared<const std::vector<std::shared_ptr<const void>>>(memory);
    return frames_of(std::move(grid), std::move(arrays), frames.front().rule, std::move(times), all,
                     call);
}

using Plotfiles = std::vector<AmrexPlotfile>;

template <int dim, class Real>
LoadedField fields_of(const std::shared_ptr<const Plotfiles>& files,
                      const std::vector<std::string>& names, const std::string& array,
                      CellRule rule, std::vector<double> times, const Call& call) {
    const std::vector<std::string> fields = files->front().fields();
    const std::string& name = fields[index_of_field(fields, array)];
    const Blocks<dim> first = files->front().blocks<dim>();
    auto grid = std::make_shared<const BlockGrid<dim>>(first);
    std::vector<BlockArrays<dim, Real>> arrays;
    for (std::size_t i = 0; i < files->size(); ++i) {
        const AmrexPlotfile& file = (*files)[i];
        if (i > 0) require_one_grid(first, *grid, file.blocks<dim>(), names.front(), names[i]);
        arrays.push_back(file.arrays<dim, Real>(index_of_field(file.fields(), name)));
    }
    return {frames_of(std::move(grid), std::move(arrays), rule, std::move(times), files, call),
            name};
}

}  // namespace

Frames make_blocks(const std::vector<BoxArrays>& frames, std::vector<double> times,
                   const std::vector<std::string>& names, const Call& call) {
    const BoxArrays& first = frames.front();
    for (std::size_t i = 1; i < frames.size(); ++i) {
        require_same(frames[i].dimension == first.dimension, "other dimensions", names.front(),
                     names[i]);
        require_same(frames[i].is_double == first.is_double, "numbers of another type",
                     names.front(), names[i]);
    }
    if (first.dimension == 2) {
        return first.is_double ? frames_of<2, double>(frames, std::move(times), names, call)
                               : frames_of<2, float>(frames, std::move(times), names, call);
    }
    return first.is_double ? frames_of<3, double>(frames, std::move(times), names, call)
                           : frames_of<3, float>(frames, std::move(times), names, call);
}

LoadedField load_plotfiles(const std::vector<std::string>& paths, const std::string& array,
                           CellRule rule, std::vector<double> times, const Call& call) {
    const auto files = std::make_shared<Plotfiles>();
    std::vector<std::string> names;
    const bool told = times.empty();
    for (const std::string& path : paths) {
        files->emplace_back(path);
        names.push_back("'" + path + "'");
        const AmrexPlotfile& first = files->front();
        const AmrexPlotfile& file = files->back();
        require_same(file.dimension() == first.dimension(), "other dimensions", names.front(),
                     names.back());
        require_same(file.is_double() == first.is_double(), "numbers of another type",
                     names.front(), names.back());
        if (told) times.push_back(file.time());
    }
    const AmrexPlotfile& first = files->front();
    const auto load = [&](auto fields) {
        return fields(files, names, array, rule, std::move(times), call);
    };
    if (first.dimension() == 2) {
        return first.is_double() ? load(fields_of<2, double>) : load(fields_of<2, float>);
    }
    return first.is_double() ? load(fields_of<3, double>) : load(fields_of<3, float>);
}

}  // namespace nestgrid::python
