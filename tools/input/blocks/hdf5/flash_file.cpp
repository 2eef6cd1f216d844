// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files of FLASH: blocks of one size, with those that finer ones replace or without them, each
// with its level, from 1, and its bounding box.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>

#include "input/blocks/hdf5/block_forest.hpp"
#include "input/blocks/read_blocks.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;

using FlashText = std::array<char, 80>;

/// Scalars and parameters are rows of a name and a value.
template <class Value>
struct FlashRow {
    FlashText name;
    Value value;
};

std::string text_of(const FlashText& padded) {
    const std::string text(padded.data(), padded.size());
    return text.substr(0, text.find_first_of(std::string(" \0", 2)));
}

/// The value of a name in a data set of rows, where there is one.
/// \param type of a value in memory
template <class Value>
std::optional<Value> value_in(const Hdf5& file, const char* data_set, const char* wanted,
                              hid_t type) {
    if (!file.has(data_set)) return std::nullopt;
    const Hdf5 data = file.at(data_set);
    const Hdf5 text(H5Tcopy(H5T_C_S1), "texts");
    H5Tset_size(text.id(), sizeof(FlashText));
    using Row = FlashRow<Value>;
    const Hdf5 row(H5Tcreate(H5T_COMPOUND, sizeof(Row)), "rows");
    H5Tinsert(row.id(), "name", offsetof(Row, name), text.id());
    H5Tinsert(row.id(), "value", offsetof(Row, value), type < 0 ? text.id() : type);
    const std::vector<hsize_t> shape = data.shape();
    if (shape.size() != 1 || shape[0] > 100000) return std::nullopt;
    std::vector<Row> rows(shape[0]);
    if (H5Dread(data.id(), row.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0) {
        return std::nullopt;
    }
    for (const Row& each : rows) {
        if (text_of(each.name) == wanted) return each.value;
    }
    return std::nullopt;
}

/// \throw InvalidInput for curved coordinates; files that tell none have cartesian ones
void require_cartesian(const Hdf5& file) {
    const auto told = value_in<FlashText>(file, "string runtime parameters", "geometry", -1);
    if (!told) return;
    std::string geometry = text_of(*told);  // in letters of any case, as FLASH takes it
    for (char& letter : geometry) letter = static_cast<char>(std::tolower(letter & 0x7f));
    if (geometry == "cartesian") return;
    throw InvalidInput("it has " + text_of(*told) + " coordinates, not cartesian ones");
}

/// Low and high ends of all blocks, six numbers a block.
std::vector<double> boxes_of(const Hdf5& file, std::size_t blocks) {
    const Hdf5 data = file.at("bounding box");
    const std::vector<hsize_t> shape = data.shape();
    const bool fits =
        shape.size() == 3 && shape[0] == blocks && shape[1] >= 1 && shape[1] <= 3 && shape[2] == 2;
    if (!fits) throw InvalidInput("it has not one bounding box for each block");
    std::vector<double> stored(blocks * shape[1] * 2);
    data.read({0, 0, 0}, shape, true, stored.data());
    std::vector<double> boxes(blocks * 6);
    for (std::size_t i = 0; i < stored.size(); ++i) {
        boxes[i / (2 * shape[1]) * 6 + i % (2 * shape[1])] = stored[i];
    }
    return boxes;
}

/// Where the blocks of a level lie, from the bounding boxes.
/// \throw InvalidInput where they have several sizes, or lie beside their places
void place_blocks(const std::vector<double>& boxes, BlockForest& forest, std::size_t dim) {
    if (forest.levels.empty()) throw InvalidInput("it has no blocks");
    const auto coarsest =
        static_cast<std::size_t>(std::ranges::min_element(forest.levels) - forest.levels.begin());
    forest.places.assign(3 * forest.levels.size(), 0);
    for (std::size_t d = 0; d < dim; ++d) {
        double begin = boxes[2 * d];
        for (std::size_t i = 0; i < forest.levels.size(); ++i) {
            begin = std::min(begin, boxes[6 * i + 2 * d]);
        }
        const double length =
            std::ldexp(boxes[6 * coarsest + 2 * d + 1] - boxes[6 * coarsest + 2 * d],
                       static_cast<int>(forest.levels[coarsest]));
        forest.origin[d] = begin;
        forest.spacing[d] = length / forest.size[d];
        for (std::size_t i = 0; i < forest.levels.size(); ++i) {
            const double size = std::ldexp(length, -static_cast<int>(forest.levels[i]));
            const double place = (boxes[6 * i + 2 * d] - begin) / size;
            const double end = (boxes[6 * i + 2 * d + 1] - begin) / size;
            const bool is_place = std::abs(place - std::round(place)) < 1e-2 && place < 0x1p30 &&
                                  std::abs(end - std::round(place) - 1) < 1e-2;
            if (!is_place) throw InvalidInput("a block does not lie at a place of its level");
            forest.places[3 * i + d] = static_cast<std::int64_t>(std::round(place));
        }
    }
}

BlockFile open_flash(const fs::path& path) {
    const auto opened = std::make_shared<const Hdf5>(open_hdf5(path));
    require_cartesian(*opened);
    std::vector<ForestField> fields;
    for (const std::string& name : opened->at("unknown names").all_texts()) {
        std::string padded = name;  // to four letters, as data sets are named
        padded.resize(std::max<std::size_t>(4, name.size()), ' ');
        fields.push_back({name, opened->has(padded) ? padded : name});
    }
    if (fields.empty()) throw InvalidInput("it has no variables");
    const std::vector<hsize_t> shape = opened->at(fields.front().data_set).shape();
    if (shape.size() != 4) throw InvalidInput("its fields do not have four directions");
    BlockForest forest{.levels = opened->at("refine level").all_integers()};
    for (std::size_t d = 0; d < 3; ++d) {
        forest.size[d] = static_cast<int>(std::min<hsize_t>(shape[3 - d], 1 << 20));
    }
    for (std::int64_t& level : forest.levels) {
        level -= 1;
        if (level < 0 || level > 25) throw InvalidInput("a block has a level out of range");
    }
    place_blocks(boxes_of(*opened, forest.levels.size()), forest, forest.size[2] == 1 ? 2 : 3);
    BlockFile file = forest_file(opened, std::move(forest), std::move(fields));
    file.time = value_in<double>(*opened, "real scalars", "time", H5T_NATIVE_DOUBLE);
    return file;
}

const RegisteredFormat flash(
    {.name = "FLASH",
     .endings = {},
     .holds = "HDF5: blocks of cells on levels, several fields",
     .options = {"--array", "--cells", "--read-limit"},
     .recognises = [](const fs::path& path) { return hdf5_kind(path) == Hdf5Kind::flash; },
     .read_field = read_blocks<open_flash>,
     .describe = describe_blocks<open_flash>});

}  // namespace
