// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files of Chombo, and of codes that use its output, as PLUTO. Each level is a group with
// boxes and the numbers of all of them.
#include "input/blocks/hdf5/chombo_level.hpp"
#include "input/blocks/read_blocks.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;
using Box = nestgrid::BlockBox<3>;

std::string group_of(std::size_t level) { return "level_" + std::to_string(level); }

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

/// PLUTO says where the domain begins and how long cells are, beside their extent along x.
double number_or(const Hdf5& level, const std::string& attribute, double otherwise) {
    return level.has_attribute(attribute) ? level.number(attribute) : otherwise;
}

/// \throw InvalidInput for PLUTO's curved or logarithmic coordinates
void require_cartesian(const Hdf5& level) {
    const bool is_pluto = level.has_attribute("domBeg1");
    if (is_pluto && number_or(level, "geometry", 1) != 1) {
        throw InvalidInput("its coordinates are curved, not cartesian");
    }
    if (is_pluto && number_or(level, "logr", 0) != 0) {
        throw InvalidInput("its cells are not of one size: they grow with the radius");
    }
}

void place_cells(const Hdf5& level, BlockFile& file) {
    const bool is_vector = level.has_attribute("vec_dx");
    const std::vector<double> spacing = level.numbers(is_vector ? "vec_dx" : "dx");
    const std::vector<Box>& boxes = file.blocks.levels[0].boxes;
    for (std::size_t d = 0; d < static_cast<std::size_t>(file.dimension); ++d) {
        const std::string axis = std::to_string(d + 1);
        const double stretch = number_or(level, "g_x" + axis + "stretch", 1);
        int lower = boxes[0].lower[d];
        for (const Box& box : boxes) lower = std::min(lower, box.lower[d]);
        file.blocks.spacing[d] = stretch * in_direction(spacing, d);
        file.blocks.origin[d] =
            number_or(level, "domBeg" + axis, 0) + lower * file.blocks.spacing[d];
    }
}

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
        if (level.boxes.empty() && l > 0) {  // levels that the code may still make
            file.blocks.levels.pop_back();
            break;
        }
        if (level.boxes.empty()) throw InvalidInput(group_of(l) + " has no boxes");
    }
    const Hdf5 coarse = opened->at(group_of(0));
    require_cartesian(coarse);
    const bool tells_time = opened->has_attribute("time") || coarse.has_attribute("time");
    if (tells_time) file.time = (opened->has_attribute("time") ? *opened : coarse).number("time");
    file.is_double = coarse.at("data:datatype=0").is_double();
    place_cells(coarse, file);
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
