// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Behind a table of functions; these are equal to the cases of the grids themselves.
#include "any.hpp"
#include "curved.hpp"
#include "hiding.hpp"
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    {
        const Sampled<double, 3> samples({.samples = {18, 21, 11}});
        const LatticeBisection<3> bisection({.samples = {18, 21, 11}});
        record_any("any3/lattice_bisection", bisection, samples.on(bisection), true);
        const LatticeOctree<3> octree({.samples = {18, 21, 11}});
        record_any("any3/lattice_octree", octree, samples.on(octree));
    }
    {
        auto grid = UnbalancedOctree::grids()[0];
        refine_at_sphere(grid, 3);
        std::vector<std::vector<double>> values;
        record_any("any3/octree_grid", grid, recording::subjects_on<double>(grid, values), true);
    }
    {
        auto grid = Prisms::grids()[0];
        refine_at_sphere(grid, 2);
        std::vector<std::vector<double>> values;
        record_any("any3/prism_grid", grid, recording::subjects_on<double>(grid, values));
    }
    {
        const auto forest = refined(kuhn<3>(0), 9, 120);
        record_any("any3/forest", forest, subjects_on<3>(forest));
        const HidingForest<3> hiding(some_boxes<3>(3, 2, 60), std::mt19937(7));
        record_any("any3/hidden", hiding, subjects_on<3>(hiding, 2));
    }
    {
        const CurvedGrid grid(refined(kuhn<3>(3), 4, 600));
        std::vector<Subject<CurvedField>> subjects;
        for (const NodalSamples& samples : catching(grid.positions)) {
            CurvedField field(grid, [](const Point&) { return 0.0; });
            field.field.values = samples.values;
            subjects.push_back({short_name(samples), std::move(field), 0.0, range_of(samples)});
        }
        record_any("any3/curved", grid, subjects, true);
    }
    return finish(count, arguments);
}
