// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the grids of deal.II and p4est say in the states in which they are wrong.
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/vector.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "p4est_samples.hpp"
#include "refusal_rows.hpp"

using namespace nestgrid_test;

namespace solver_refusals_test {

using Vector = dealii::Vector<double>;

struct Problem {
    dealii::Triangulation<3> triangulation;
    dealii::DoFHandler<3> dofs{triangulation};

    Problem() {
        dealii::GridGenerator::hyper_cube(triangulation);
        triangulation.refine_global(1);
        dofs.distribute_dofs(dealii::FE_Q<3>(1));
    }
};

TEST(Refusals, OfDealii) {
    RefusalRows rows("deal.II");
    Problem problem;
    const DealiiGrid<3> grid(problem.triangulation);
    using Field = DealiiField<3, Vector>;
    const Vector values(problem.dofs.n_dofs());
    const Vector few(3);
    rows.add("a vector of another size", [&] { Field(grid, problem.dofs, few); });
    rows.add("degrees of freedom of another triangulation", [&] {
        const Problem other;
        Field(grid, other.dofs, values);
    });
    rows.add("a component that is not there", [&] { Field(grid, problem.dofs, values, {2}); });
    const auto with_element = [&](const dealii::FE_DGQ<3>& element, const auto& function) {
        dealii::DoFHandler<3> jumps(problem.triangulation);
        jumps.distribute_dofs(element);
        const Vector zeros(jumps.n_dofs());
        function(Field(grid, jumps, zeros));
    };
    rows.add("one value in a cell, elements without nodes",
             [&] { with_element(dealii::FE_DGQ<3>(0), [](const Field&) {}); });
    rows.add("discontinuous elements, but within an error", [&] {
        with_element(dealii::FE_DGQ<3>(1),
                     [&](const Field& field) { isosurface(grid, field, 0.5); });
    });
    rows.add("cells that are refined in some directions only", [] {
        dealii::Triangulation<3> across;
        dealii::GridGenerator::hyper_cube(across);
        across.begin_active()->set_refine_flag(dealii::RefinementCase<3>::cut_x);
        across.execute_coarsening_and_refinement();
        DealiiGrid<3>{across};
    });
    const Field field(grid, problem.dofs, values);
    problem.triangulation.refine_global(1);
    rows.add<GridError>("a field from before a refinement", [&] { isosurface(grid, field, 0.5); });
}

TEST(Refusals, OfP4est) {
    RefusalRows rows("p4est");
    rows.add("no forest", [] { P4estGrid<2>{nullptr}; });
    rows.add("a periodic tree", [] {
        const Forest<2> forest(p4est_connectivity_new_periodic());
        P4estGrid<2>{forest.get()};
    });
    rows.add("a periodic brick", [] {
        const Forest<2> forest(p4est_connectivity_new_brick(4, 1, 1, 0));
        P4estGrid<2>{forest.get()};
    });
    const Forest<2> forest(p4est_connectivity_new_unitsquare());
    const P4estGrid<2> grid(forest.get());
    const std::vector<double> three(3);
    rows.add("values for another number of leaves",
             [&] { P4estCellValues(grid, std::span<const double>(three)); });
    rows.add("no lnodes", [&] {
        const p4est_lnodes_t* const none = nullptr;
        P4estNodalField(grid, none, std::span<const double>(three));
    });
}

}  // namespace solver_refusals_test
