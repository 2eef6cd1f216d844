// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files of Athena++ (.athdf): leaves alone, blocks of one size, each with its level and its
// place in blocks. The blocks that they replaced are added without numbers.
#include <cmath>
#include <numeric>

#include "input/blocks/hdf5/hdf5_reading.hpp"
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

/// What the attributes of a file say.
struct Mesh {
    explicit Mesh(const Hdf5& file)
        : size{triple(file.integers("MeshBlockSize"))},
          roots{triple(file.integers("RootGridSize"))},
          levels{file.at("Levels").all_integers()},
          places{file.at("LogicalLocations").all_integers()} {
        const std::string coordinates = file.texts("Coordinates").at(0);
        if (coordinates != "cartesian" && coordinates != "minkowski") {
            throw InvalidInput("its coordinates are " + coordinates + ", not cartesian");
        }
        for (std::size_t d = 0; d < 3; ++d) {
            extent[d] = triple(file.numbers("RootGridX" + std::to_string(d + 1)));
            if (extent[d][2] != 1) throw InvalidInput("its cells are not of one size");
            if (size[d] < 1 || size[d] > 1 << 12 || roots[d] < 1) {
                throw InvalidInput("its blocks have no cells, or too many");
            }
        }
        if (size[1] == 1) throw InvalidInput("it has 1 dimension, not 2 or 3");
        if (levels.empty() || places.size() != 3 * levels.size()) {
            throw InvalidInput("it has not one level and one place for each block");
        }
    }
    double spacing(std::size_t d) const { return (extent[d][1] - extent[d][0]) / roots[d]; }
    std::size_t cells() const {
        return std::accumulate(size.begin(), size.end(), std::size_t{1}, [](std::size_t a, int b) {
            return a * static_cast<std::size_t>(b);
        });
    }

    std::array<int, 3> size;   ///< cells of a block
    std::array<int, 3> roots;  ///< cells of level 0
    std::vector<std::int64_t> levels;
    std::vector<std::int64_t> places;
    std::array<std::array<double, 3>, 3> extent{};  ///< begin, end, and ratio of neighbouring cells
};

/// \throw InvalidInput where the faces of the first block are elsewhere than its place says, as
/// with ghost zones
void require_places(const Hdf5& file, const Mesh& mesh, std::size_t dim) {
    for (std::size_t d = 0; d < dim; ++d) {
        double face = 0;
        file.at("x" + std::to_string(d + 1) + "f").read({0, 0}, {1, 1}, true, &face);
        const double step = mesh.spacing(d) / std::ldexp(1.0, static_cast<int>(mesh.levels[0]));
        const double begin =
            mesh.extent[d][0] + static_cast<double>(mesh.places[d]) * mesh.size[d] * step;
        if (std::abs(face - begin) <= 0.1 * step) continue;
        throw InvalidInput("its blocks do not lie at their places: ghost zones are not read");
    }
}

/// The boxes of the blocks, and for each level which block each of its first boxes is.
template <int dim>
std::vector<std::vector<std::size_t>> add_blocks(const Mesh& mesh, nestgrid::Blocks<dim>& blocks) {
    std::vector<std::vector<std::size_t>> numbers;
    for (std::size_t i = 0; i < mesh.levels.size(); ++i) {
        const std::int64_t level = mesh.levels[i];
        if (level < 0 || level > 25)
            throw InvalidInput("a block has level " + std::to_string(level));
        while (blocks.levels.size() <= static_cast<std::size_t>(level)) {
            blocks.levels.emplace_back().ratio.fill(2);
            numbers.emplace_back();
        }
        nestgrid::BlockBox<dim> box;
        for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
            const std::int64_t lower = mesh.places[3 * i + d] * mesh.size[d];
            if (lower < 0 || lower > 1 << 30) throw InvalidInput("a block lies out of range");
            box.lower[d] = static_cast<int>(lower);
            box.upper[d] = box.lower[d] + mesh.size[d] - 1;
        }
        blocks.levels[static_cast<std::size_t>(level)].boxes.push_back(box);
        numbers[static_cast<std::size_t>(level)].push_back(i);
    }
    nestgrid::add_parents(blocks);
    return numbers;
}

/// A field: one of the variables of a data set.
struct Variable {
    std::string data_set;
    hsize_t number;
};

std::vector<Variable> variables_of(const Hdf5& file, std::vector<BlockFile::Field>& fields) {
    const std::vector<int> counts = file.integers("NumVariables");
    const std::vector<std::string> sets = file.texts("DatasetNames");
    const std::vector<std::string> names = file.texts("VariableNames");
    std::vector<Variable> variables;
    for (std::size_t s = 0; s < sets.size() && s < counts.size(); ++s) {
        for (int v = 0; v < counts[s]; ++v) {
            if (variables.size() == names.size()) throw InvalidInput("a variable has no name");
            fields.push_back({names[variables.size()]});
            variables.push_back({sets[s], static_cast<hsize_t>(v)});
        }
    }
    if (variables.empty()) throw InvalidInput("it has no variables");
    return variables;
}

template <int dim>
BlockFile blocks_in(const std::shared_ptr<const Hdf5>& opened, const Mesh& mesh) {
    nestgrid::Blocks<dim> blocks;
    for (std::size_t d = 0; d < 3; ++d) {
        blocks.origin[d] = d < static_cast<std::size_t>(dim) ? mesh.extent[d][0] : 0;
        blocks.spacing[d] = mesh.spacing(d);
    }
    const auto numbers = add_blocks(mesh, blocks);
    require_places(*opened, mesh, static_cast<std::size_t>(dim));
    BlockFile file;
    file.dimension = dim;
    file.time = opened->number("Time");
    file.blocks = blocks_in_space(blocks);
    const std::vector<Variable> variables = variables_of(*opened, file.fields);
    file.is_double = opened->at(variables.front().data_set).is_double();
    file.numbers = [opened, mesh, variables, numbers, is_double = file.is_double,
                    levels = file.blocks.levels](std::size_t field, int) {
        const std::size_t bytes = is_double ? sizeof(double) : sizeof(float);
        const auto memory = std::make_shared<std::vector<std::byte>>();
        const std::vector<hsize_t> count{1, mesh.levels.size(), static_cast<hsize_t>(mesh.size[2]),
                                         static_cast<hsize_t>(mesh.size[1]),
                                         static_cast<hsize_t>(mesh.size[0])};
        memory->resize(mesh.levels.size() * mesh.cells() * bytes);
        opened->at(variables[field].data_set)
            .read({variables[field].number, 0, 0, 0, 0}, count, is_double, memory->data());
        BoxNumbers result{{}, memory};
        for (std::size_t l = 0; l < levels.size(); ++l) {
            auto& arrays = result.arrays.emplace_back(levels[l].boxes.size());
            for (std::size_t b = 0; b < numbers[l].size(); ++b) {
                arrays[b].first = memory->data() + numbers[l][b] * mesh.cells() * bytes;
                std::size_t stride = bytes;
                for (std::size_t d = 0; d < 3; ++d) {
                    arrays[b].stride[d] = static_cast<std::ptrdiff_t>(stride);
                    stride *= static_cast<std::size_t>(mesh.size[d]);
                }
            }
        }
        return result;
    };
    return file;
}

BlockFile open_athena(const fs::path& path) {
    const auto opened = std::make_shared<const Hdf5>(open_hdf5(path));
    const Mesh mesh(*opened);
    return mesh.size[2] == 1 ? blocks_in<2>(opened, mesh) : blocks_in<3>(opened, mesh);
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
