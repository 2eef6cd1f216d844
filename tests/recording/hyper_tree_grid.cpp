// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's hyper tree grids, with the means of their cells; masked and not.
#include <vtkBitArray.h>

#include <nestgrid/adapters/vtk_hyper_tree_grid.hpp>
#include <nestgrid/algorithms/cell_data.hpp>

#include "closedness.hpp"
#include "hyper_trees.hpp"
#include "options.hpp"

namespace {

using namespace recording;
using namespace nestgrid_test;

template <int dim>
void record_trees(const std::string& name, std::array<unsigned, 3> points, int depth, bool masked) {
    vtkNew<vtkHyperTreeGrid> trees;
    trees->SetDimensions(points.data());
    trees->SetBranchFactor(2);
    trees->SetXCoordinates(coordinates(static_cast<int>(points[0])));
    trees->SetYCoordinates(coordinates(static_cast<int>(points[1])));
    trees->SetZCoordinates(coordinates(static_cast<int>(points[2])));
    std::mt19937 random(dim);
    vtkIdType next = 0;
    vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
    for (vtkIdType i = 0; i < trees->GetMaxNumberOfTrees(); ++i) {
        trees->InitializeNonOrientedCursor(cursor, i, true);
        subdivide(cursor, random, depth, next);
    }
    const vtkNew<vtkBitArray> mask;
    if (masked) {
        for (vtkIdType i = 0; i < next; ++i) mask->InsertNextValue(random() % 9 == 0);
        trees->SetMask(mask);
    }
    const HyperTreeGrid<dim> grid(*trees);
    std::vector<double> noise;
    std::vector<double> integers;
    std::vector<double> waves;
    for (vtkIdType i = 0; i < next; ++i) {
        noise.push_back(uniform(random) - 0.5);
        integers.push_back(static_cast<double>(random() % 3) - 1);
        waves.push_back(std::sin(0.02 * static_cast<double>(i)));
    }
    using Element = typename HyperTreeGrid<dim>::Element;
    const auto of = [&](const std::vector<double>& values) {
        return [&grid, &values](const Element& e) {
            return values[static_cast<std::size_t>(grid.index(e))];
        };
    };
    using Field = CellAverages<HyperTreeGrid<dim>, decltype(of(noise))>;
    std::vector<Subject<Field>> subjects;
    subjects.push_back({"noise", Field(grid, of(noise)), 0.0, 1.0});
    subjects.push_back({"integers", Field(grid, of(integers)), 0.0, 2.0});
    subjects.push_back({"waves", Field(grid, of(waves)), 0.1, 2.0});
    record_preroll(name, grid, subjects);
    record_options(name, grid, subjects);
}

}  // namespace

int main(int count, char** arguments) {
    record_trees<2>("hyper_tree_grid/2", {4, 3, 1}, 5, false);
    record_trees<2>("hyper_tree_grid/2_masked", {5, 4, 1}, 5, true);
    record_trees<3>("hyper_tree_grid/3", {3, 4, 3}, 3, false);
    record_trees<3>("hyper_tree_grid/3_masked", {4, 4, 4}, 3, true);
    return finish(count, arguments);
}
