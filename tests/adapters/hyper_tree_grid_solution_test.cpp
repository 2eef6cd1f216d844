// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solution of a problem of advection, poured from the forest that followed it into a hyper tree
// grid, leaf by leaf.
#include <vtkDoubleArray.h>
#include <vtkHyperTreeGridNonOrientedCursor.h>
#include <vtkNew.h>

#include <nestgrid/adapters/vtk_hyper_tree_grid.hpp>
#include <nestgrid/algorithms/cell_data.hpp>

#include "p4est_advection.hpp"
#include "p4est_laws.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

using Cells = P4estGrid<3>;

/// The cell at a cursor becomes an element of the forest with all that lies below it. Both number
/// children alike.
void pour(const Cells& from, const Cells::Element& e, vtkHyperTreeGridNonOrientedCursor* to,
          std::vector<double>& values) {
    to->SetGlobalIndexFromLocal(static_cast<vtkIdType>(values.size()));
    const Rule* rule = from.split(e);
    values.push_back(rule == nullptr ? p4est_advection::cell_of(from.quadrant(e)).u : 0.0);
    if (rule == nullptr) return;
    to->SubdivideLeaf();
    std::array<Cells::Element, 8> child;
    from.children(e, child);
    for (std::size_t c = 0; c < child.size(); ++c) {
        to->ToChild(static_cast<unsigned char>(c));
        pour(from, child[c], to, values);
        to->ToParent();
    }
}

TEST(HyperTreeGridSolution, LawsHold) {
    p4est_advection::Advection solver(
        {.finest = 7, .largest_jump = 0.05, .steps_per_rotation = 720});
    for (int step = 0; step < 2 * p4est_advection::steps_per_adaptation; ++step) solver.step();
    const Cells forest(solver.forest());
    EXPECT_GE(forest.leaf_count(), 100000U);

    vtkNew<vtkHyperTreeGrid> trees;
    const std::array<unsigned, 3> points{3, 3, 2};
    trees->SetDimensions(points.data());
    trees->SetBranchFactor(2);
    vtkNew<vtkDoubleArray> x;
    for (const double at : {0.0, 1.0, 2.0}) x->InsertNextValue(at);
    vtkNew<vtkDoubleArray> z;
    for (const double at : {0.0, 1.0}) z->InsertNextValue(at);
    trees->SetXCoordinates(x);
    trees->SetYCoordinates(x);
    trees->SetZCoordinates(z);
    std::vector<double> values;
    vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
    for (std::size_t i = 0; i < forest.coarse_count(); ++i) {
        const auto tree = forest.coarse(i);
        const Point& low = tree.corners[0];
        trees->InitializeNonOrientedCursor(cursor, static_cast<vtkIdType>(low[0] + 2 * low[1]),
                                           true);
        pour(forest, tree.element, cursor, values);
    }

    const HyperTreeGrid<3> grid(*trees);
    const CellAverages field(grid, [&](const HyperTreeGrid<3>::Element& e) {
        return values[static_cast<std::size_t>(grid.index(e))];
    });
    expect_sound_grid(grid, field);
    expect_closed_levels(grid, field, 0.5, 0.03);

    // It is the surface that the forest has.
    const CellAverages here(forest, [&](const Cells::Element& e) {
        return p4est_advection::cell_of(forest.quadrant(e)).u;
    });
    for (const double threshold : {0.0, 0.01}) {
        const auto poured = isosurface(grid, field, 0.5, {.threshold = threshold});
        const auto direct = isosurface(forest, here, 0.5, {.threshold = threshold});
        EXPECT_GT(direct.surface.simplices.size(), 1000U);
        EXPECT_EQ(poured.surface.simplices.size(), direct.surface.simplices.size());
        EXPECT_EQ(poured.surface.vertices.size(), direct.surface.vertices.size());
    }
}

}  // namespace
