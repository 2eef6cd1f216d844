// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A solver's own array of leaves.
#include <nestgrid/adapters/linear_octree.hpp>

#include "closedness.hpp"
#include "options.hpp"
#include "sample_grids.hpp"

namespace {

using namespace recording;
using namespace nestgrid_test;

struct Octant {
    int x, y, z, level;
};
constexpr int depth = 5;

template <int dim, class Function>
void refine_octant(std::vector<Octant>& leaves, const Octant& o, Function& wanted) {
    if (o.level == depth || !wanted(o)) {
        leaves.push_back(o);
        return;
    }
    const int half = 1 << (depth - o.level - 1);
    for (int c = 0; c < 1 << dim; ++c) {
        refine_octant<dim>(
            leaves,
            {o.x + half * (c & 1), o.y + half * (c >> 1 & 1), o.z + half * (c >> 2), o.level + 1},
            wanted);
    }
}

template <int dim>
void record_linear(const std::string& name, unsigned seed) {
    const CoarseGrid coarse =
        dim == 2 ? shaken(quadrilaterals(2), seed, 0.1) : shaken(hexahedra(2), seed, 0.1);
    std::mt19937 random(seed);
    std::vector<std::vector<Octant>> trees(coarse.element_count());
    for (auto& tree : trees) {
        auto wanted = [&](const Octant& o) {
            return o.level < 1 || random() % (dim == 2 ? 5 : 9) < 2;
        };
        refine_octant<dim>(tree, {0, 0, 0, 0}, wanted);
    }
    std::vector<int> element_nodes;
    std::vector<Point> nodes;
    std::map<std::array<long, 3>, int> known;
    for (std::size_t t = 0; t < trees.size(); ++t) {
        const auto corner = coarse.positions(t);
        for (const Octant& o : trees[t]) {
            const int size = 1 << (depth - o.level);
            for (int c = 0; c < 1 << dim; ++c) {
                const std::array<int, 3> at{o.x + size * (c & 1), o.y + size * (c >> 1 & 1),
                                            o.z + size * (c >> 2)};
                Point x{0, 0, 0};
                for (std::size_t k = 0; k < 1U << dim; ++k) {
                    double weight = 1;
                    for (std::size_t d = 0; d < dim; ++d) {
                        const double r = at[d] * std::pow(0.5, depth);
                        weight *= (k >> d & 1U) != 0 ? r : 1 - r;
                    }
                    x = x + weight * corner[k];
                }
                std::array<long, 3> rounded{};
                for (std::size_t d = 0; d < 3; ++d) rounded[d] = std::lround(x[d] * 1e9);
                const auto [entry, is_new] =
                    known.try_emplace(rounded, static_cast<int>(nodes.size()));
                if (is_new) nodes.push_back(x);
                element_nodes.push_back(entry->second);
            }
        }
    }
    using Grid = LinearOctree<dim, Octant>;
    using Field = LinearOctreeField<Grid, double, int>;
    const Grid grid(coarse, std::vector<std::span<const Octant>>(trees.begin(), trees.end()),
                    depth);
    const std::vector<NodalSamples> all = catching_fields(nodes, seed);
    std::vector<Subject<Field>> subjects;
    for (const NodalSamples& samples : all) {
        subjects.push_back({samples.name.substr(0, samples.name.find(' ')),
                            Field(grid, element_nodes, samples.values), 0.0,
                            samples.name == "5 units in the last place" ? 0x1p-52 : 1});
    }
    record_preroll(name, grid, subjects);
    record_options(name, grid, subjects);
    record_threads(name, grid, subjects);
}

}  // namespace

int main(int count, char** arguments) {
    record_linear<2>("linear_octree/2", 1);
    record_linear<3>("linear_octree/3", 2);
    return finish(count, arguments);
}
