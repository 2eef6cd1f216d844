// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/blocks/hdf5/chombo_level.hpp"

using nestgrid::InvalidInput;

namespace {

/// Layers of ghost cells around each box in the file.
std::vector<int> ghosts_of(const Hdf5& group) {
    if (!group.has("data_attributes")) return {0};
    const Hdf5 attributes = group.at("data_attributes");
    return attributes.has_attribute("outputGhost") ? attributes.integers("outputGhost")
                                                   : std::vector<int>{0};
}

}  // namespace

LevelNumbers::LevelNumbers(const Hdf5& group, int fields, bool is_double)
    : data_{group.at("data:datatype=0")},
      fields_{static_cast<hsize_t>(fields)},
      bytes_{is_double ? sizeof(double) : sizeof(float)},
      ghosts_{ghosts_of(group)} {
    if (group.has("data:offsets=0")) offsets_ = group.at("data:offsets=0").all_integers();
}

nestgrid::BlockArray<3, std::byte> LevelNumbers::read(const nestgrid::BlockBox<3>& box,
                                                      std::size_t dim, std::size_t field,
                                                      std::vector<std::byte>& memory) {
    nestgrid::BlockArray<3, std::byte> array;
    std::ptrdiff_t first = 0;
    hsize_t cells = 1;
    for (std::size_t d = 0; d < dim; ++d) {
        const std::int64_t layers = in_direction(ghosts_, d);
        const std::int64_t n = std::int64_t{box.upper[d]} - box.lower[d] + 1;
        if (layers < 0 || layers > 100 || n < 1 || n > 1 << 20) {
            throw InvalidInput("a box has no cells, too many, or too many ghosts");
        }
        array.stride[d] = static_cast<std::ptrdiff_t>(cells * bytes_);
        first += layers * array.stride[d];
        cells *= static_cast<hsize_t>(n + 2 * layers);
    }
    const hsize_t begin = next_;
    next_ += cells * fields_;
    const bool fits = offsets_.empty() ||
                      (number_ + 1 < offsets_.size() && offsets_[number_] == std::int64_t(begin) &&
                       offsets_[number_ + 1] == std::int64_t(next_));
    if (!fits) {
        throw InvalidInput("box " + std::to_string(number_) +
                           " has another number of values than cells with their ghosts");
    }
    ++number_;
    if (data_.shape().size() != 1 || next_ > data_.shape()[0]) {
        throw InvalidInput("a level has fewer numbers than its boxes need");
    }
    memory.resize(cells * bytes_);
    data_.read({begin + field * cells}, {cells}, bytes_ == sizeof(double), memory.data());
    array.first = memory.data() + first;
    return array;
}
