// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data of Enzo: a text (.hierarchy) lists the grids, which have their numbers in HDF5 files beside
// it. Values stay in the units of these.
#include <algorithm>
#include <cmath>

#include "input/blocks/hdf5/enzo_grids.hpp"
#include "input/blocks/hdf5/hdf5_reading.hpp"
#include "input/blocks/read_blocks.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;

/// Orders grids by levels, whose cells are smaller and smaller.
/// \throw InvalidInput where they are no levels
std::vector<std::vector<PlacedGrid>> levels_of(std::vector<PlacedGrid> grids,
                                               nestgrid::Blocks<3>& blocks) {
    std::ranges::stable_sort(
        grids, [](const auto& a, const auto& b) { return a.spacing[0] > b.spacing[0]; });
    std::vector<std::vector<PlacedGrid>> levels;
    const std::vector<double> coarsest = grids.front().spacing;
    std::copy(coarsest.begin(), coarsest.end(), blocks.spacing.begin());
    for (std::size_t d = 0; d < coarsest.size(); ++d) {
        blocks.origin[d] =
            std::ranges::min(grids, {}, [d](const PlacedGrid& grid) { return grid.low[d]; }).low[d];
    }
    for (PlacedGrid& grid : grids) {
        if (levels.empty() || grid.spacing[0] < 0.75 * levels.back()[0].spacing[0]) {
            blocks.levels.emplace_back().ratio.fill(1);
            for (std::size_t d = 0; !levels.empty() && d < coarsest.size(); ++d) {
                const double ratio = levels.back()[0].spacing[d] / grid.spacing[d];
                blocks.levels.back().ratio[d] = static_cast<int>(std::min(std::round(ratio), 1e6));
            }
            levels.emplace_back();
        }
        nestgrid::BlockBox<3> box;
        for (std::size_t d = 0; d < coarsest.size(); ++d) {
            const double low = (grid.low[d] - blocks.origin[d]) / grid.spacing[d];
            if (low > 0x1p29 || std::abs(low - std::round(low)) > 1e-2) {
                throw InvalidInput(grid.group + " does not lie on cells of its level");
            }
            box.lower[d] = static_cast<int>(std::round(low));
            box.upper[d] = box.lower[d] + static_cast<int>(grid.cells[d]) - 1;
        }
        blocks.levels.back().boxes.push_back(box);
        levels.back().push_back(std::move(grid));
    }
    return levels;
}

/// The numbers of a grid: in a group of its name, or alone in a file, as old Enzo wrote them.
Hdf5 data_of(const PlacedGrid& grid) {
    Hdf5 file = open_hdf5(grid.file);
    return file.has(grid.group) ? file.at(grid.group) : std::move(file);
}

BlockFile open_enzo(const fs::path& path) {
    std::vector<PlacedGrid> grids = enzo_grids(path);
    BlockFile file;
    file.dimension = static_cast<int>(grids.front().low.size());
    file.time = grids.front().time;
    const auto levels = levels_of(std::move(grids), file.blocks);
    const Hdf5 first = data_of(levels[0][0]);
    std::vector<hsize_t> shape(levels[0][0].cells.rbegin(), levels[0][0].cells.rend());
    for (const std::string& name : first.data_sets()) {
        if (first.at(name).shape() == shape) file.fields.push_back({name});
    }
    if (file.fields.empty()) throw InvalidInput("it has no data of cells");
    file.is_double = std::ranges::any_of(
        file.fields, [&](const auto& field) { return first.at(field.name).is_double(); });
    file.numbers = [levels, fields = file.fields, is_double = file.is_double](std::size_t field,
                                                                              int) {
        const auto memory = std::make_shared<std::vector<std::vector<std::byte>>>();
        BoxNumbers numbers{{}, memory};
        for (const auto& level : levels) {
            auto& arrays = numbers.arrays.emplace_back();
            for (const PlacedGrid& grid : level) {
                const std::vector<hsize_t> count(grid.cells.rbegin(), grid.cells.rend());
                auto& array = arrays.emplace_back();
                std::size_t bytes = is_double ? sizeof(double) : sizeof(float);
                for (std::size_t d = 0; d < grid.cells.size(); ++d) {
                    array.stride[d] = static_cast<std::ptrdiff_t>(bytes);
                    bytes *= grid.cells[d];
                }
                auto& own = memory->emplace_back(bytes);
                const Hdf5 data = data_of(grid).at(fields.at(field).name);
                if (data.shape() != count) {
                    throw InvalidInput(grid.group + " has not one number of '" +
                                       fields[field].name + "' for each cell");
                }
                data.read(std::vector<hsize_t>(count.size()), count, is_double, own.data());
                array.first = own.data();
            }
        }
        return numbers;
    };
    return file;
}

const RegisteredFormat enzo({.name = "Enzo",
                             .endings = {".hierarchy"},
                             .holds = "boxes of cells on levels, several fields",
                             .options = {"--array", "--cells", "--read-limit"},
                             .reads_beside = true,
                             .read_field = read_blocks<open_enzo>,
                             .describe = describe_blocks<open_enzo>});

}  // namespace
