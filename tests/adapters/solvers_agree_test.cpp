// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One problem on deal.II's triangulation and on p4est's forest, each built by its own package: the
// same leaves, the same walk, the same surface.
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>

#include <nestgrid/adapters/dealii.hpp>

#include "p4est_laws.hpp"

using namespace nestgrid_test;

namespace {

/// Zero on a dented sphere or circle.
template <int dim>
double dented(const Point& x) {
    return 0.31 - norm(x - Point{0.52, 0.49, dim == 2 ? 0.0 : 0.5}) +
           0.04 * std::sin(20 * x[0]) * x[1];
}

/// Whether a cell of the unit cube is refined: from its centre and half its width, which both
/// packages have without rounding.
template <int dim>
bool near_zero(const Point& centre, double half) {
    return std::abs(dented<dim>(centre)) < 2.5 * half;
}

/// The leaves come from one cell by steps: each refines cells of the finest level, and balances
/// over faces, edges and corners.
template <int dim>
struct InDealii {
    dealii::Triangulation<dim> triangulation{
        dealii::Triangulation<dim>::limit_level_difference_at_vertices};
    dealii::DoFHandler<dim> dofs{triangulation};
    dealii::Vector<double> values;

    static Point to_point(const dealii::Point<dim>& x) {
        Point p{0, 0, 0};
        for (unsigned d = 0; d < dim; ++d) p[d] = x[d];
        return p;
    }
    explicit InDealii(int steps) {
        dealii::GridGenerator::hyper_cube(triangulation);
        for (int step = 0; step < steps; ++step) {
            for (const auto& c : triangulation.active_cell_iterators_on_level(unsigned(step))) {
                const double half = std::ldexp(0.5, -c->level());
                if (near_zero<dim>(to_point(c->center()), half)) c->set_refine_flag();
            }
            triangulation.execute_coarsening_and_refinement();
        }
        dofs.distribute_dofs(dealii::FE_Q<dim>(1));
        values.reinit(dofs.n_dofs());
        for (const auto& c : dofs.active_cell_iterators()) {
            for (const unsigned v : c->vertex_indices()) {
                values(c->vertex_dof_index(v, 0)) = dented<dim>(to_point(c->vertex(v)));
            }
        }
        dealii::AffineConstraints<double> constraints;
        dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
        constraints.close();
        constraints.distribute(values);
    }
};

template <int dim>
Forest<dim> in_p4est(int steps) {
    Forest<dim> forest = [] {
        if constexpr (dim == 2) return Forest<2>(p4est_connectivity_new_unitsquare());
        if constexpr (dim == 3) return Forest<3>(p8est_connectivity_new_unitcube());
    }();
    for (int step = 0; step < steps; ++step) {
        forest.refine([&](const auto& q) {
            const double half = std::ldexp(0.5, -q.level);
            const auto at = [&](p4est_qcoord_t x) {
                return std::ldexp(x, -P4estTypes<dim>::max_level) + half;
            };
            Point centre{at(q.x), at(q.y), 0};
            if constexpr (dim == 3) centre[2] = at(q.z);
            return q.level == step && near_zero<dim>(centre, half);
        });
        forest.balance();
    }
    return forest;
}

template <int dim>
void expect_agreement(int steps, std::size_t least_leaves) {
    const InDealii<dim> solver(steps);
    const DealiiGrid<dim> grid(solver.triangulation);
    const DealiiField field(grid, solver.dofs, solver.values);

    const Forest<dim> forest = in_p4est<dim>(steps);
    const P4estGrid other(static_cast<const typename P4estTypes<dim>::Forest*>(forest.get()));
    const auto nodes = forest.nodes();
    const std::vector<double> values = nodal_values(other, *nodes, dented<dim>);
    const P4estNodalField other_field(other, nodes.get(), values);

    EXPECT_GE(other.leaf_count(), least_leaves);
    ASSERT_EQ(solver.triangulation.n_active_cells(), other.leaf_count());
    const HierarchicalIndicator indicator(grid, field);
    const HierarchicalIndicator other_indicator(other, other_field);
    std::size_t triangles = std::numeric_limits<std::size_t>::max();
    for (const double threshold : {0.0, 1e-3, 1e-2}) {
        SCOPED_TRACE("threshold " + std::to_string(threshold));
        const auto a = isosurface(grid, field, 0, under(indicator, threshold));
        const auto b = isosurface(other, other_field, 0, under(other_indicator, threshold));
        EXPECT_EQ(a.counts.calls, b.counts.calls);
        EXPECT_EQ(a.counts.visited, b.counts.visited);
        EXPECT_EQ(a.counts.extracted, b.counts.extracted);
        EXPECT_EQ(a.error_bound, b.error_bound);
        EXPECT_EQ(a.surface.vertices, b.surface.vertices);
        EXPECT_EQ(a.surface.simplices, b.surface.simplices);
        EXPECT_LT(a.surface.simplices.size(), triangles);
        triangles = a.surface.simplices.size();
        EXPECT_GT(triangles, 8U);
        if constexpr (dim == 3) {
            const SurfaceReport here = surface_report(a.surface);
            const SurfaceReport there = surface_report(b.surface);
            EXPECT_TRUE(here.closed() && there.closed());
            EXPECT_NEAR(here.area, there.area, 1e-12);
            EXPECT_NEAR(here.volume, there.volume, 1e-12);
        }
    }
}

TEST(Solvers, AgreeInTwoDimensions) { expect_agreement<2>(12, 50'000); }

TEST(Solvers, AgreeInThreeDimensions) { expect_agreement<3>(7, 100'000); }

}  // namespace
