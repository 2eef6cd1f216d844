// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files of Chombo, and of codes that use its output, as PLUTO. Each level is a group with
// boxes, and with the numbers of all of them one behind the other: box by box, field by field, each
// with the layers of ghost cells that an attribute tells.
#include "input/blocks/hdf5/hdf5_reading.hpp"
#include "input/blocks/read_blocks.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;
using Box = nestgrid::BlockBox<3>;

std::string group_of(std::size_t level) { return "level_" + std::to_string(level); }

/// One number in each direction: several of a vector, or one for all.
template <class Number>
Number in_direction(const std::vector<Number>& all, std::size_t d) {
    return all[std::min(d, all.size() - 1)];
}

int level_count(const Hdf5& file) {
    const int levels = file.integer("num_levels");
    if (levels < 1 || levels > 30) {
        throw InvalidInput("its number of levels is " + std::to_string(levels));
    }
    return levels;
}

int dimension_of(const Hdf5& file) {
    const int dim = file.at("Chombo_global").integer("SpaceDim");
    if (dim == 2 || dim == 3) return dim;
    throw InvalidInput("it has " + std::to_string(dim) + " dimensions, not 2 or 3");
}

std::vector<Box> boxes_of(const Hdf5& group, std::size_t dim) {
    const std::vector<std::int64_t> numbers = group.at("boxes").all_integers();
    if (numbers.size() % (2 * dim) != 0) throw InvalidInput("its boxes have other dimensions");
    std::vector<Box> boxes(numbers.size() / (2 * dim));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::size_t d = i % (2 * dim);
        const std::int64_t cell = numbers[i];
        if (cell < -(1 << 30) || cell > 1 << 30) throw InvalidInput("a cell is out of range");
        Box& box = boxes[i / (2 * dim)];
        (d < dim ? box.lower[d] : box.upper[d - dim]) = static_cast<int>(cell);
    }
    return boxes;
}

std::vector<double> spacing_of(const Hdf5& group) {
    return group.numbers(group.has_attribute("vec_dx") ? "vec_dx" : "dx");
}

/// Layers of ghost cells around each box in the file.
std::vector<int> ghosts_of(const Hdf5& group) {
    if (!group.has("data_attributes")) return {0};
    const Hdf5 attributes = group.at("data_attributes");
    return attributes.has_attribute("outputGhost") ? attributes.integers("outputGhost")
                                                   : std::vector<int>{0};
}

/// The numbers of one field of one level.
class LevelNumbers {
public:
    LevelNumbers(const Hdf5& group, int fields, bool is_double)
        : data_{group.at("data:datatype=0")},
          fields_{static_cast<hsize_t>(fields)},
          bytes_{is_double ? sizeof(double) : sizeof(float)},
          ghosts_{ghosts_of(group)} {
        if (group.has("data:offsets=0")) offsets_ = group.at("data:offsets=0").all_integers();
    }
    /// Reads a box, which is the one behind the box that was read before.
    nestgrid::BlockArray<3, std::byte> read(const Box& box, std::size_t dim, std::size_t field,
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
        const bool fits = offsets_.empty() || (number_ + 1 < offsets_.size() &&
                                               offsets_[number_] == std::int64_t(begin) &&
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

private:
    Hdf5 data_;
    hsize_t fields_;
    std::size_t bytes_;
    std::vector<int> ghosts_;
    std::vector<std::int64_t> offsets_;
    hsize_t next_ = 0;
    std::size_t number_ = 0;
};

BlockFile open_chombo(const fs::path& path) {
    const auto opened = std::make_shared<Hdf5>(open_hdf5(path));
    BlockFile file;
    file.dimension = dimension_of(*opened);
    const auto dim = static_cast<std::size_t>(file.dimension);
    const int fields = opened->integer("num_components");
    for (int i = 0; i < fields; ++i) {
        file.fields.push_back({opened->texts("component_" + std::to_string(i)).at(0)});
    }
    for (std::size_t l = 0; l < static_cast<std::size_t>(level_count(*opened)); ++l) {
        const Hdf5 group = opened->at(group_of(l));
        nestgrid::BlockLevel<3>& level = file.blocks.levels.emplace_back();
        level.ratio.fill(1);
        if (l > 0) {
            const std::vector<int> ratio = opened->at(group_of(l - 1)).integers("ref_ratio");
            for (std::size_t d = 0; d < dim; ++d) level.ratio[d] = in_direction(ratio, d);
        }
        level.boxes = boxes_of(group, dim);
        if (level.boxes.empty()) throw InvalidInput(group_of(l) + " has no boxes");
    }
    const Hdf5 coarse = opened->at(group_of(0));
    const bool tells_time = opened->has_attribute("time") || coarse.has_attribute("time");
    if (tells_time) file.time = (opened->has_attribute("time") ? *opened : coarse).number("time");
    file.is_double = coarse.at("data:datatype=0").is_double();
    for (std::size_t d = 0; d < dim; ++d) {
        file.blocks.spacing[d] = in_direction(spacing_of(coarse), d);
        int lower = file.blocks.levels[0].boxes[0].lower[d];
        for (const Box& box : file.blocks.levels[0].boxes) lower = std::min(lower, box.lower[d]);
        file.blocks.origin[d] = lower * file.blocks.spacing[d];
    }
    file.numbers = [opened, fields, dim, is_double = file.is_double, blocks = file.blocks](
                       std::size_t field, int) {
        const auto memory = std::make_shared<std::vector<std::vector<std::byte>>>();
        BoxNumbers numbers{{}, memory};
        for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
            LevelNumbers level(opened->at(group_of(l)), fields, is_double);
            auto& arrays = numbers.arrays.emplace_back();
            for (const Box& box : blocks.levels[l].boxes) {
                arrays.push_back(level.read(box, dim, field, memory->emplace_back()));
            }
        }
        return numbers;
    };
    return file;
}

const RegisteredFormat chombo(
    {.name = "Chombo",
     .endings = {},
     .holds = "HDF5: boxes of cells on levels, several fields",
     .options = {"--array", "--cells", "--read-limit"},
     .recognises = [](const fs::path& path) { return hdf5_kind(path) == Hdf5Kind::chombo; },
     .read_field = read_blocks<open_chombo>,
     .describe = describe_blocks<open_chombo>});

}  // namespace
