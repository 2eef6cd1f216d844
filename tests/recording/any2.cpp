// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "any.hpp"
#include "archetype.hpp"
#include "hiding.hpp"
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    const Sampled<double, 2> samples({.samples = {37, 50}});
    const LatticeBisection<2> bisection({.samples = {37, 50}});
    record_any("any2/lattice_bisection", bisection, samples.on(bisection), true);
    const LatticeOctree<2> octree({.samples = {37, 50}});
    record_any("any2/lattice_octree", octree, samples.on(octree));
    auto grid = UnbalancedQuadtree::grids()[0];
    refine_at_sphere(grid, 4);
    std::vector<std::vector<double>> values;
    record_any("any2/octree_grid", grid, recording::subjects_on<double>(grid, values));
    const auto forest = some_boxes<2>(3, 3, 200);
    record_any("any2/forest", forest, subjects_on<2>(forest, 3), true);
    const HidingForest<2> hiding(refined(kuhn<2>(2), 7, 500), std::mt19937(7));
    record_any("any2/hidden", hiding, subjects_on<2>(hiding));
    return finish(count, arguments);
}
