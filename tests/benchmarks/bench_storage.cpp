// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bytes per leaf of every family, topology and node references without the coarse grid and without
// values: around a sphere after a million random refinements and coarsenings, and uniform; beside
// it what vtkUnstructuredGrid and p4est take for as many leaves. One `name value` line per figure.
// --quick: shallower grids, a hundredth of the steps.
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>

#ifdef NESTGRID_WITH_P4EST
#include "p4est_octree.hpp"
#endif

#include "counting_allocator.hpp"
#include "sample_grids.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

bool quick = false;

void print(const std::string& name, double value) {
    std::printf("%s %.4g\n", name.c_str(), value);
    std::fflush(stdout);
}

/// What the heap gets back when the hierarchy goes; rules made by its closure are counted, too.
template <class Grid>
double bytes_of(std::optional<Grid>& grid) {
    const std::size_t with = allocated_bytes();
    grid.reset();
    return static_cast<double>(with - allocated_bytes());
}

/// Cells and points of the same leaves as VTK keeps them: connectivity, offsets, types.
template <class Grid>
double vtk_bytes(const Grid& grid) {
    const vtkNew<vtkCellArray> cells;
    const vtkNew<vtkUnsignedCharArray> types;
    grid.for_each_leaf([&](const Leaf& leaf) {
        cells->InsertNextCell(static_cast<int>(leaf.nodes.size()));
        for (const std::uint32_t node : leaf.nodes) cells->InsertCellPoint(node);
        types->InsertNextValue(leaf.shape == Shape::tetrahedron ? VTK_TETRA
                               : leaf.shape == Shape::prism     ? VTK_WEDGE
                                                                : VTK_HEXAHEDRON);
    });
    cells->Squeeze();
    types->Squeeze();
    const vtkNew<vtkUnstructuredGrid> unstructured;
    unstructured->SetCells(types, cells);
    return 1024 * static_cast<double>(cells->GetActualMemorySize() + types->GetActualMemorySize());
}

template <class Grid, class Make>
void measure_family(const std::string& name, Make&& make, int depth, int uniform) {
    std::optional<Grid> coarse(make());
    const double coarse_bytes = bytes_of(coarse);
    std::optional<Grid> kept(make());
    Grid& grid = *kept;
    const int levels = quick ? depth - 2 * (depth / 7) : depth;
    refine_at_sphere(grid, levels);
    // A million leaves are refined and as many families coarsened, at random, then the sphere is
    // refined to its depth again.
    std::mt19937 random(1);
    std::size_t steps = 0;
    const std::size_t wanted = quick ? 10000 : 1000000;
    while (steps < wanted) {
        const Adaptation up = grid.adapt([&](const Leaf& leaf) {
            return leaf.level < levels && random() % 4 == 0 ? Mark::refine : Mark::keep;
        });
        const double where = static_cast<double>(random() % 1000) / 1000;
        const Adaptation down = grid.adapt([&](const Leaf& leaf) {
            return std::abs(leaf.centre()[0] - where) < 0.3 ? Mark::coarsen : Mark::keep;
        });
        steps += up.marked + down.coarsened;
    }
    for (int i = 0; i < 2 * levels; ++i) {
        grid.adapt(
            [&](const Leaf& leaf) { return near_sphere(leaf, 3, 2) ? Mark::keep : Mark::coarsen; });
    }
    refine_at_sphere(grid, levels);
    const auto leaves = static_cast<double>(grid.leaf_count());
    print(name + "_leaves", leaves);
    print(name + "_vtk_bytes_per_leaf", vtk_bytes(grid) / leaves);
    print(name + "_bytes_per_leaf", (bytes_of(kept) - coarse_bytes) / leaves);
    std::optional<Grid> fresh(make());
    for (int i = 0; i < (quick ? uniform - uniform / 4 : uniform); ++i) fresh->refine_uniformly();
    const auto uniform_leaves = static_cast<double>(fresh->leaf_count());
    print(name + "_uniform_leaves", uniform_leaves);
    print(name + "_uniform_bytes_per_leaf", (bytes_of(fresh) - coarse_bytes) / uniform_leaves);
}

}  // namespace

int main(int argc, char** argv) {
    quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    const std::vector<double> layer{1.0};
    const auto cube = [] { return tetrahedra(1); };
    const auto slab = [&] { return extrude(triangles(1), layer); };
    const auto hexahedron = [] { return hexahedra(1); };
    measure_family<RedGreenSimplices<3>>(
        "red_green_tetrahedra", [&] { return RedGreenSimplices<3>(cube()); }, 7, 6);
    measure_family<BisectionGrid<3>>(
        "bisection_tetrahedra", [&] { return BisectionGrid<3>(cube()); }, 21, 18);
    measure_family<RedGreenGrid<3>>(
        "red_green_hexahedra", [&] { return RedGreenGrid<3>(hexahedron()); }, 7, 6);
    measure_family<OctreeGrid<3>>(
        "octree_hexahedra", [&] { return OctreeGrid<3>(hexahedron()); }, 7, 6);
    measure_family<PrismGrid>(
        "prism", [&] { return PrismGrid(slab()); }, 7, 6);
#ifdef NESTGRID_WITH_P4EST
    const P4estFigures p4est = refine_p4est_at_sphere(quick ? 5 : 7);
    print("p4est_leaves", static_cast<double>(p4est.leaves));
    print("p4est_bytes_per_leaf", p4est.forest_bytes / static_cast<double>(p4est.leaves));
    print("p4est_with_nodes_bytes_per_leaf",
          (p4est.forest_bytes + p4est.node_bytes) / static_cast<double>(p4est.leaves));
#endif
    // Implicit grids keep nothing that grows with the lattice.
    const std::size_t before = allocated_bytes();
    const LatticeBisection<3> bisection({.samples = {129, 129, 129}});
    const LatticeOctree<3> octree({.samples = {129, 129, 129}});
    print("lattice_grids_bytes", static_cast<double>(allocated_bytes() - before));
    static_cast<void>(bisection);
    static_cast<void>(octree);
    return 0;
}
