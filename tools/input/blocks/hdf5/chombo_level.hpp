// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The numbers of a level in files of Chombo, one behind the other: box by box, field by field, each
// with the layers of ghost cells that an attribute tells.
#pragma once

#include <algorithm>

#include "input/blocks/block_file.hpp"
#include "input/blocks/hdf5/hdf5_reading.hpp"

/// One number in each direction: several of a vector, or one for all.
template <class Number>
Number in_direction(const std::vector<Number>& all, std::size_t d) {
    return all[std::min(d, all.size() - 1)];
}

/// The numbers of one field of one level.
class LevelNumbers {
public:
    LevelNumbers(const Hdf5& group, int fields, bool is_double);
    /// Reads a box, which is the one behind the box that was read before.
    /// \throw nestgrid::InvalidInput where the level has other numbers than its boxes need
    nestgrid::BlockArray<3, std::byte> read(const nestgrid::BlockBox<3>& box, std::size_t dim,
                                            std::size_t field, std::vector<std::byte>& memory);

private:
    Hdf5 data_;
    hsize_t fields_;
    std::size_t bytes_;
    std::vector<int> ghosts_;
    std::vector<std::int64_t> offsets_;
    hsize_t next_ = 0;
    std::size_t number_ = 0;
};
