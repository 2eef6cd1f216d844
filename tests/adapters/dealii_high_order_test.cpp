// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Solutions of deal.II of higher degree, read in place.
#include <deal.II/base/function.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_wedge_p.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/hp/fe_collection.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>
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

/// Each is refined, at random where deal.II has hanging nodes, but for the wedge.
enum class Domain { cube, ball, simplices, wedge };

/// An interpolated function on a mesh, hanging nodes constrained.
template <int dim>
struct Problem {
    dealii::Triangulation<dim> triangulation;
    dealii::DoFHandler<dim> dofs{triangulation};
    DoubleVector values;

    Problem(const dealii::FiniteElement<dim>& fe, Domain domain)
        : Problem(dealii::hp::FECollection<dim>(fe), domain) {}
    /// Degrees at random, where there are several.
    Problem(const dealii::hp::FECollection<dim>& elements, Domain domain) {
        namespace make = dealii::GridGenerator;
        if (domain == Domain::ball) make::hyper_ball(triangulation);
        if (domain == Domain::cube) make::hyper_cube(triangulation, -1, 1);
        if (domain == Domain::simplices) {
            make::subdivided_hyper_cube_with_simplices(triangulation, 2, -1, 1);
        }
        if (domain == Domain::wedge) {
            make::reference_cell(triangulation, dealii::ReferenceCells::Wedge);
        } else {
            triangulation.refine_global(domain == Domain::cube ? 2 : 1);
        }
        std::mt19937 random(3);
        const bool cubes = triangulation.all_reference_cells_are_hyper_cube();
        for (int step = 0; cubes && step < 2; ++step) {
            for (const auto& cell : triangulation.active_cell_iterators()) {
                if (random() % 10 < 3) cell->set_refine_flag();
            }
            triangulation.execute_coarsening_and_refinement();
        }
        if (elements.size() > 1) {
            for (const auto& cell : dofs.active_cell_iterators()) {
                cell->set_active_fe_index(static_cast<unsigned>(random() % elements.size()));
            }
            dofs.distribute_dofs(elements);
        } else {
            dofs.distribute_dofs(elements[0]);
        }
        values.reinit(dofs.n_dofs());
        interpolate();
        if (!cubes) return;
        dealii::AffineConstraints<double> constraints;
        dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
        constraints.close();
        constraints.distribute(values);
    }

    /// Values at the nodes of every cell.
    void interpolate() {
        for (const auto& cell : dofs.active_cell_iterators()) {
            const auto& fe = cell->get_fe();
            const Waves<dim> waves(fe.n_components());
            std::vector<dealii::types::global_dof_index> dof(fe.n_dofs_per_cell());
            cell->get_dof_indices(dof);
            for (unsigned i = 0; i < dof.size(); ++i) {
                const auto [component, in_base] = fe.system_to_component_index(i);
                const auto base = fe.system_to_base_index(i).first.first;
                const auto x =
                    cell->reference_cell()
                        .template get_default_linear_mapping<dim, dim>()
                        .transform_unit_to_real_cell(
                            cell, fe.base_element(base).get_unit_support_points()[in_base]);
                values(dof[i]) = waves.value(x, component);
            }
        }
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
        isosurface<dim>(fine, 0.3, under(fine.criterion(), fine.bounds()), {.verify = true});
    EXPECT_GT(result.surface.simplices.size(), 100U);
    expect_closed(result.surface);
    EXPECT_EQ(result.counts.limited, 0U);
    EXPECT_LE(result.error_bound, tolerance * (1 + 1e-6));
}

TEST(DealiiHighOrder, SolutionsAreClosedAndWithinTheTolerance) {
    for (const unsigned degree : {2U, 3U, 4U, 6U}) {
        SCOPED_TRACE("degree " + std::to_string(degree));
        expect_within(Problem<3>(dealii::FE_Q<3>(degree), Domain::cube), 0.05);
        expect_within(Problem<2>(dealii::FE_Q<2>(degree), Domain::cube), 0.01);
    }
}

TEST(DealiiHighOrder, NodesOnManifoldsStayThere) {
    expect_within(Problem<3>(dealii::FE_Q<3>(3), Domain::ball), 0.05);
    expect_within(Problem<2>(dealii::FE_Q<2>(3), Domain::ball), 0.01);
}

TEST(DealiiHighOrder, SimplicesAndWedgesAreDrawn) {
    expect_within(Problem<3>(dealii::FE_SimplexP<3>(2), Domain::simplices), 0.05);
    expect_within(Problem<2>(dealii::FE_SimplexP<2>(2), Domain::simplices), 0.01);
    expect_within(Problem<3>(dealii::FE_WedgeP<3>(2), Domain::wedge), 0.01);
}

/// Degrees meet on faces of simplices without constraints.
TEST(DealiiHighOrder, DegreesOfSimplicesMayDiffer) {
    const dealii::hp::FECollection<3> elements(dealii::FE_SimplexP<3>(1),
                                               dealii::FE_SimplexP<3>(2));
    const Problem<3> problem(elements, Domain::simplices);
    const DealiiGrid<3> grid(problem.triangulation);
    const DealiiField<3, DoubleVector> field(grid, problem.dofs, problem.values);
    const HighOrder data(grid, field);
    EXPECT_GT(data.jump(), 0.01);
    const VirtualRefinement fine(data, {.tolerance = 0.05});
    const auto result =
        isosurface<3>(fine, 0.3, under(fine.criterion(), fine.bounds()), {.verify = true});
    expect_closed(result.surface);
    EXPECT_LE(result.error_bound, (0.05 + data.jump()) * (1 + 1e-6));
}

/// Elements of several degrees jump where these meet, by deal.II's own shape functions.
template <int dim>
void expect_closed_hp(double tolerance) {
    dealii::hp::FECollection<dim> elements;
    for (unsigned degree = 2; degree <= 6; ++degree) elements.push_back(dealii::FE_Q<dim>(degree));
    const Problem<dim> problem(elements, Domain::cube);
    const DealiiGrid<dim> grid(problem.triangulation);
    const DealiiField<dim, DoubleVector> field(grid, problem.dofs, problem.values);
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation.has_value()) << (violation ? violation->sentence : "");
    const HighOrder data(grid, field);
    EXPECT_EQ(data.greatest_degree(), 6);
    const VirtualRefinement fine(data, {.tolerance = tolerance, .depth = 5});
    const auto result =
        isosurface<dim>(fine, 0.3, under(fine.criterion(), fine.bounds()), {.verify = true});
    EXPECT_GT(result.surface.simplices.size(), 100U);
    expect_closed(result.surface);
    EXPECT_LE(result.error_bound, (tolerance + data.jump()) * (1 + 1e-6));
}

TEST(DealiiHighOrder, DegreesMayDifferFromCellToCell) {
    expect_closed_hp<3>(0.1);
    expect_closed_hp<2>(0.02);
}

/// Discontinuous elements jump as far as their values say.
template <int dim>
void expect_jumps_are_closed(const dealii::FiniteElement<dim>& fe, Domain domain,
                             double tolerance) {
    Problem<dim> problem(fe, domain);
    std::mt19937 random(4);
    for (double& value : problem.values) value += 0.1 * uniform(random);
    const DealiiGrid<dim> grid(problem.triangulation);
    const DealiiField<dim, DoubleVector> field(grid, problem.dofs, problem.values);
    const HighOrder data(grid, field);
    EXPECT_EQ(data.greatest_degree(), int(fe.degree));
    EXPECT_GT(data.jump(), 0.05);
    EXPECT_LT(data.jump(), 2);
    const VirtualRefinement fine(data, {.tolerance = tolerance, .depth = 6});
    const auto result =
        isosurface<dim>(fine, 0.3, under(fine.criterion(), fine.bounds()), {.verify = true});
    EXPECT_GT(result.surface.simplices.size(), 100U);
    expect_closed(result.surface);
    if (result.counts.limited == 0) {
        EXPECT_LE(result.error_bound, (tolerance + data.jump()) * (1 + 1e-6));
    }
}

TEST(DealiiHighOrder, DiscontinuousElementsAreClosed) {
    expect_jumps_are_closed<3>(dealii::FE_DGQ<3>(1), Domain::cube, 0.1);
    expect_jumps_are_closed<3>(dealii::FE_DGQ<3>(3), Domain::cube, 0.1);
    expect_jumps_are_closed<2>(dealii::FE_DGQ<2>(4), Domain::cube, 0.05);
    expect_jumps_are_closed<3>(dealii::FE_SimplexDGP<3>(2), Domain::simplices, 0.1);
    expect_jumps_are_closed<2>(dealii::FE_SimplexDGP<2>(2), Domain::simplices, 0.05);
}

/// On a mesh that conforms a continuous function has the same values in both spaces.
TEST(DealiiHighOrder, DiscontinuousElementsHaveTheValuesOfContinuousOnes) {
    std::mt19937 random(4);
    std::vector<Point> points(100);
    for (Point& x : points) x = {1.9 * uniform(random) - 0.95, uniform(random), uniform(random)};
    const auto values = [&](const dealii::FiniteElement<3>& fe) {
        const Problem<3> problem(fe, Domain::simplices);
        const DealiiGrid<3> grid(problem.triangulation);
        const DealiiField<3, DoubleVector> field(grid, problem.dofs, problem.values);
        const HighOrder data(grid, field);
        EXPECT_LE(data.jump(), 1e-11);
        return probe(data, points).values;
    };
    const auto continuous = values(dealii::FE_SimplexP<3>(2));
    const auto discontinuous = values(dealii::FE_SimplexDGP<3>(2));
    ASSERT_EQ(continuous.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(continuous[i], discontinuous[i], 1e-12);
    }
}

TEST(DealiiHighOrder, ComponentsOfSystemsAreToldApart) {
    const Problem<3> problem(dealii::FESystem<3>(dealii::FE_Q<3>(4), 1, dealii::FE_Q<3>(2), 1),
                             Domain::cube);
    const DealiiGrid<3> grid(problem.triangulation);
    const DealiiField<3, DoubleVector, 2> field(grid, problem.dofs, problem.values, {0, 1});
    EXPECT_FALSE(check_grid(grid, field).has_value());
    const HighOrder data(grid, field);
    const VirtualRefinement fine(data, {.tolerance = 0.05});
    const auto result = isosurface<3>(fine, 0.3, under(fine.criterion(), fine.bounds()));
    expect_closed(result.surface);
    expect_colours(result.surface, [](const Point& x) { return x[0]; });
}

/// The boundary of a ball in space under a MappingQ is a sphere, hanging faces and all.
TEST(DealiiHighOrder, BallsUnderAMappingAreRound) {
    const Problem<3> problem(dealii::FE_Q<3>(2), Domain::ball);
    const dealii::MappingQ<3> mapping(3);
    const DealiiGrid<3> grid(problem.triangulation, &mapping);
    const DealiiField field(grid, problem.dofs, problem.values);
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation.has_value()) << (violation ? violation->sentence : "");
    const HighOrder data(grid, field);
    EXPECT_EQ(data.geometry_degree(), 3);
    EXPECT_GT(data.position_jump(), 0) << "maps of cells do not meet in hanging faces";
    EXPECT_LE(data.position_jump(), 0.02);
    for (const double tolerance : {0.03, 0.01}) {
        const VirtualRefinement fine(
            data, {.tolerance = 100, .depth = 6, .position_tolerance = tolerance});
        const auto sphere =
            boundary_surface(fine, under(fine.criterion(), fine.bounds()), {.verify = true});
        expect_closed(sphere.surface, true);
        double off = 0;
        for (const auto& t : sphere.surface.simplices) {
            Point middle{0, 0, 0};
            for (const auto v : t) middle = middle + (1.0 / 3) * sphere.surface.vertices[v];
            off = std::max(off, std::abs(norm(middle) - 1));
        }
        EXPECT_LE(off, tolerance + data.position_jump());
    }
    const VirtualRefinement fine(data, {.tolerance = 0.1, .depth = 5, .position_tolerance = 0.03});
    const auto surface =
        isosurface<3>(fine, 0.2, under(fine.criterion(), fine.bounds()), {.verify = true});
    EXPECT_GT(surface.surface.simplices.size(), 1000U);
    expect_closed(surface.surface);
}

}  // namespace
