// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/blocks/hdf5/block_forest.hpp"

#include <algorithm>

namespace {

using nestgrid::InvalidInput;

/// The number of the block that each box is, by level; boxes that were added have none.
using BlockNumbers = std::vector<std::vector<std::size_t>>;

/// \throw InvalidInput for a block that is none of a hierarchy
template <int dim>
nestgrid::Blocks<3> boxes_in(const BlockForest& forest, BlockNumbers& numbers) {
    nestgrid::Blocks<dim> blocks;
    blocks.origin = forest.origin;
    blocks.spacing = forest.spacing;
    for (std::size_t i = 0; i < forest.levels.size(); ++i) {
        const std::int64_t level = forest.levels[i];
        if (level < 0 || level > 25) {
            throw InvalidInput("a block has level " + std::to_string(level));
        }
        while (blocks.levels.size() <= static_cast<std::size_t>(level)) {
            blocks.levels.emplace_back().ratio.fill(2);
            numbers.emplace_back();
        }
        nestgrid::BlockBox<dim> box;
        for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
            const std::int64_t place = forest.places[3 * i + d];
            if (place < 0 || place * forest.size[d] > 1 << 30) {
                throw InvalidInput("a block lies out of range");
            }
            box.lower[d] = static_cast<int>(place) * forest.size[d];
            box.upper[d] = box.lower[d] + forest.size[d] - 1;
        }
        blocks.levels[static_cast<std::size_t>(level)].boxes.push_back(box);
        numbers[static_cast<std::size_t>(level)].push_back(i);
    }
    nestgrid::add_parents(blocks);
    return blocks_in_space(blocks);
}

/// The numbers of one field, all of which are read at once.
BoxNumbers numbers_of(const Hdf5& data, const std::vector<hsize_t>& variable,
                      const BlockForest& forest, const BlockNumbers& numbers,
                      const nestgrid::Blocks<3>& blocks, bool is_double) {
    const auto memory = std::make_shared<std::vector<std::byte>>();
    std::array<std::size_t, 4> stride{is_double ? sizeof(double)
                                                : sizeof(float)};  // x, y, z, block
    std::vector<hsize_t> from = variable;
    std::vector<hsize_t> count(variable.size(), 1);
    count.push_back(forest.levels.size());
    for (std::size_t d = 0; d < 3; ++d) {
        stride[d + 1] = stride[d] * static_cast<std::size_t>(forest.size[d]);
        count.push_back(static_cast<hsize_t>(forest.size[2 - d]));
    }
    from.resize(count.size());
    const std::vector<hsize_t> shape = data.shape();
    const auto first = static_cast<std::ptrdiff_t>(variable.size());
    if (shape.size() != count.size() ||
        !std::equal(shape.begin() + first, shape.end(), count.begin() + first)) {
        throw InvalidInput("a data set has not one number for each cell of each block");
    }
    memory->resize(forest.levels.size() * stride[3]);
    data.read(from, count, is_double, memory->data());
    BoxNumbers result{{}, memory};
    for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
        auto& arrays = result.arrays.emplace_back(blocks.levels[l].boxes.size());
        for (std::size_t b = 0; b < numbers[l].size(); ++b) {
            arrays[b].first = memory->data() + numbers[l][b] * stride[3];
            std::copy_n(stride.begin(), 3, arrays[b].stride.begin());
        }
    }
    return result;
}

}  // namespace

BlockFile forest_file(std::shared_ptr<const Hdf5> opened, BlockForest forest,
                      std::vector<ForestField> fields) {
    for (const int n : forest.size) {
        if (n < 1 || n > 1 << 12) throw InvalidInput("its blocks have no cells, or too many");
    }
    if (forest.size[1] == 1 && forest.size[2] == 1) {
        throw InvalidInput("it has 1 dimension, not 2 or 3");
    }
    if (forest.size[0] == 1 || forest.size[1] == 1) {
        throw InvalidInput(
            "its blocks are one cell thick along x or y: of slices, those across z are read");
    }
    if (forest.levels.empty() || forest.places.size() != 3 * forest.levels.size()) {
        throw InvalidInput("it has not one level and one place for each block");
    }
    if (fields.empty()) throw InvalidInput("it has no variables");
    BlockFile file;
    BlockNumbers numbers;
    file.dimension = forest.size[2] == 1 ? 2 : 3;
    file.blocks = file.dimension == 2 ? boxes_in<2>(forest, numbers) : boxes_in<3>(forest, numbers);
    for (const ForestField& field : fields) file.fields.push_back({field.name});
    file.is_double = std::ranges::any_of(
        fields, [&](const ForestField& field) { return opened->at(field.data_set).is_double(); });
    file.numbers = [opened, forest = std::move(forest), fields = std::move(fields), numbers,
                    blocks = file.blocks, is_double = file.is_double](std::size_t field, int) {
        return numbers_of(opened->at(fields.at(field).data_set), fields[field].variable, forest,
                          numbers, blocks, is_double);
    };
    return file;
}
