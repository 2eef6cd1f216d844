// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// UGGrids of the unit cube.
#pragma once

#include <dune/grid/uggrid.hh>
#include <dune/grid/utility/structuredgridfactory.hh>

#include "dune_laws.hpp"

namespace nestgrid_test {

template <int dim>
using UGGrid = Dune::UGGrid<dim>;

template <int dim>
std::unique_ptr<UGGrid<dim>> cubes(unsigned n) {
    std::array<unsigned, dim> counts;
    counts.fill(n);
    return Dune::StructuredGridFactory<UGGrid<dim>>::createCubeGrid(
        Dune::FieldVector<double, dim>(0), Dune::FieldVector<double, dim>(1), counts);
}

template <int dim>
std::unique_ptr<UGGrid<dim>> simplices(unsigned n) {
    std::array<unsigned, dim> counts;
    counts.fill(n);
    return Dune::StructuredGridFactory<UGGrid<dim>>::createSimplexGrid(
        Dune::FieldVector<double, dim>(0), Dune::FieldVector<double, dim>(1), counts);
}

template <int dim>
std::unique_ptr<UGGrid<dim>> hanging_cubes(unsigned n, int levels, double width) {
    auto solver = cubes<dim>(n);
    solver->setClosureType(UGGrid<dim>::NONE);
    refine_at_sphere(*solver, levels, width);
    return solver;
}

}  // namespace nestgrid_test
