// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Solutions of deal.II of higher degree, read in place.
#include <deal.II/base/function.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/vector_tools.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/check_grid.hpp>

#include "closedness.hpp"

using namespace nestgrid_test;
using DoubleVector = dealii::Vector<double>;

namespace {

template <int dim>
double waves(const dealii::Point<dim>& x) {
    double sum = 0;
    for (unsigned d = 0; d < dim; ++d) sum += std::sin(4 * x[d]) * std::cos(4 * x[(d + 1) % dim]);
    return sum;
}

template <int dim>
class Waves final : public dealii::Function<dim> {
public:
    explicit Waves(unsigned components) : dealii::Function<dim>(components) {}
    double value(const dealii::Point<dim>& x, unsigned component) const override {
        return component == 0 ? waves<dim>(x) : x[0];
    }
};

/// An interpolated function on a locally refined mesh, hanging nodes constrained.
template <int dim>
struct Problem {
    dealii::Triangulation<dim> triangulation;
    dealii::DoFHandler<dim> dofs{triangulation};
    DoubleVector values;

    Problem(const dealii::FiniteElement<dim>& fe, bool ball) {
        if (ball) {
            dealii::GridGenerator::hyper_ball(triangulation);
        } else {
            dealii::GridGenerator::hyper_cube(triangulation, -1, 1);
        }
        triangulation.refine_global(ball ? 1 : 2);
        std::mt19937 random(3);
        for (int step = 0; step < 2; ++step) {
            for (const auto& cell : triangulation.active_cell_iterators()) {
                if (random() % 10 < 3) cell->set_refine_flag();
            }
            triangulation.execute_coarsening_and_refinement();
        }
        dofs.distribute_dofs(fe);
        values.reinit(dofs.n_dofs());
        dealii::VectorTools::interpolate(dealii::MappingQ1<dim>(), dofs,
                                         Waves<dim>(fe.n_components()), values);
        dealii::AffineConstraints<double> constraints;
        dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
        constraints.close();
        constraints.distribute(values);
    }
};

template <int dim>
void expect_within(const Problem<dim>& problem, double tolerance) {
    const DealiiGrid<dim> grid(problem.triangulation);
    const DealiiField<dim, DoubleVector> field(grid, problem.dofs, problem.values);
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation.has_value()) << (violation ? violation->sentence : "");
    const HighOrder data(grid, field);
    EXPECT_EQ(data.greatest_degree(), int(problem.dofs.get_fe().degree));
    EXPECT_LE(data.jump(), 1e-11);
    const VirtualRefinement fine(data, {.tolerance = tolerance});
    const auto result =
        isosurface<dim>(fine, 0.3, fine.criterion(), fine.bounds(), {.verify = true});
    EXPECT_GT(result.surface.simplices.size(), 100U);
    expect_closed(result.surface);
    EXPECT_EQ(result.counts.limited, 0U);
    EXPECT_LE(result.error_bound, tolerance * (1 + 1e-6));
}

TEST(DealiiHighOrder, SolutionsAreClosedAndWithinTheTolerance) {
    for (const unsigned degree : {2U, 3U, 4U, 6U}) {
        SCOPED_TRACE("degree " + std::to_string(degree));
        expect_within(Problem<3>(dealii::FE_Q<3>(degree), false), 0.05);
        expect_within(Problem<2>(dealii::FE_Q<2>(degree), false), 0.01);
    }
}

TEST(DealiiHighOrder, NodesOnManifoldsStayThere) {
    expect_within(Problem<3>(dealii::FE_Q<3>(3), true), 0.05);
    expect_within(Problem<2>(dealii::FE_Q<2>(3), true), 0.01);
}

TEST(DealiiHighOrder, ComponentsOfSystemsAreToldApart) {
    const Problem<3> problem(dealii::FESystem<3>(dealii::FE_Q<3>(4), 1, dealii::FE_Q<3>(2), 1),
                             false);
    const DealiiGrid<3> grid(problem.triangulation);
    const DealiiField<3, DoubleVector, 2> field(grid, problem.dofs, problem.values, {0, 1});
    EXPECT_FALSE(check_grid(grid, field).has_value());
    const HighOrder data(grid, field);
    const VirtualRefinement fine(data, {.tolerance = 0.05});
    const auto result = isosurface<3>(fine, 0.3, fine.criterion(), fine.bounds());
    expect_closed(result.surface);
    expect_colours(result.surface, [](const Point& x) { return x[0]; });
}

}  // namespace
