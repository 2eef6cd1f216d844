// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files of Athena++ (.athdf): leaves alone, blocks of one size, each with its level and its
// place in blocks. The blocks that they replaced are added without numbers.
#include <cmath>

#include "input/blocks/hdf5/block_forest.hpp"
#include "input/blocks/read_blocks.hpp"

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;

/// Three numbers of an attribute.
template <class Number>
std::array<Number, 3> triple(const std::vector<Number>& all) {
    if (all.size() != 3) throw InvalidInput("it has not three numbers for the three directions");
    return {all[0], all[1], all[2]};
}

/// \throw InvalidInput for curved coordinates
void require_cartesian(const Hdf5& file) {
    const std::string coordinates = file.texts("Coordinates").at(0);
    if (coordinates == "cartesian" || coordinates == "minkowski") return;
    throw InvalidInput("its coordinates are " + coordinates + ", not cartesian");
}

BlockForest forest_in(const Hdf5& file) {
    BlockForest forest{.size = triple(file.integers("MeshBlockSize"))};
    forest.levels = file.at("Levels").all_integers();
    forest.places = file.at("LogicalLocations").all_integers();
    const std::array<int, 3> roots = triple(file.integers("RootGridSize"));
    for (std::size_t d = 0; d < 3; ++d) {
        // Begin, end, and the ratio of neighbouring cells.
        const auto extent = triple(file.numbers("RootGridX" + std::to_string(d + 1)));
        if (extent[2] != 1) throw InvalidInput("its cells are not of one size");
        if (roots[d] < 1) throw InvalidInput("its blocks have no cells, or too many");
        const bool is_flat = d == 2 && forest.size[2] == 1;
        forest.origin[d] = is_flat ? 0 : extent[0];
        forest.spacing[d] = (extent[1] - extent[0]) / roots[d];
    }
    return forest;
}

/// \throw InvalidInput where the faces of the first block are elsewhere than its place says, as
/// with ghost zones
void require_places(const Hdf5& file, const BlockForest& forest, int dim) {
    for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
        double face = 0;
        file.at("x" + std::to_string(d + 1) + "f").read({0, 0}, {1, 1}, true, &face);
        const double step = forest.spacing[d] / std::ldexp(1.0, static_cast<int>(forest.levels[0]));
        const double begin =
            forest.origin[d] + static_cast<double>(forest.places[d]) * forest.size[d] * step;
        if (std::abs(face - begin) <= 0.1 * step) continue;
        throw InvalidInput("its blocks do not lie at their places: ghost zones are not read");
    }
}

std::vector<ForestField> fields_of(const Hdf5& file) {
    const std::vector<int> counts = file.integers("NumVariables");
    const std::vector<std::string> sets = file.texts("DatasetNames");
    const std::vector<std::string> names = file.texts("VariableNames");
    std::vector<ForestField> fields;
    for (std::size_t s = 0; s < sets.size() && s < counts.size(); ++s) {
        for (int v = 0; v < counts[s]; ++v) {
            if (fields.size() == names.size()) throw InvalidInput("a variable has no name");
            fields.push_back({names[fields.size()], sets[s], {static_cast<hsize_t>(v)}});
        }
    }
    return fields;
}

BlockFile open_athena(const fs::path& path) {
    const auto opened = std::make_shared<const Hdf5>(open_hdf5(path));
    require_cartesian(*opened);
    const BlockForest forest = forest_in(*opened);
    BlockFile file = forest_file(opened, forest, fields_of(*opened));
    require_places(*opened, forest, file.dimension);
    file.time = opened->number("Time");
    return file;
}

const RegisteredFormat athena(
    {.name = "Athena++",
     .endings = {".athdf"},
     .holds = "HDF5: blocks of cells on levels, several fields",
     .options = {"--array", "--cells", "--read-limit"},
     .recognises = [](const fs::path& path) { return hdf5_kind(path) == Hdf5Kind::athena; },
     .read_field = read_blocks<open_athena>,
     .describe = describe_blocks<open_athena>});

}  // namespace
