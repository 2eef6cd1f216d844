// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks of one size, as Athena++ and FLASH have them: each with its level, its place in blocks and
// its part of each data set. Those that finer ones replace may be among them.
#pragma once

#include <array>
#include <memory>

#include "input/blocks/block_file.hpp"
#include "input/blocks/hdf5/hdf5_reading.hpp"

struct BlockForest {
    std::array<int, 3> size{};  ///< cells of a block; 1 in the third direction in the plane
    nestgrid::Point origin{};
    nestgrid::Point spacing{};  ///< of level 0
    std::vector<std::int64_t> levels{};
    std::vector<std::int64_t> places{};  ///< three a block, in blocks of its level
};

/// A field: a data set whose directions are blocks, z, y and x, or one of the variables of a data
/// set, which are one more direction in front of these.
struct ForestField {
    std::string name;
    std::string data_set;
    std::vector<hsize_t> variable{};  ///< one number, or none
};

/// \throw nestgrid::InvalidInput for blocks without cells, of another dimension or out of range
BlockFile forest_file(std::shared_ptr<const Hdf5> file, BlockForest forest,
                      std::vector<ForestField> fields);
