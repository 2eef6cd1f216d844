// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solver of dealii_high_order.cpp, which knows nothing of nestgrid: Laplace's equation around
// an edge that reenters, by elements of degrees 2 to 5. Where the estimated error is large, cells
// get a higher degree if the solution is smooth there, else they are refined. How smooth it is, the
// decay of its Legendre coefficients says (deal.II's tutorial, steps 27 and 75).
#pragma once

#include <set>

#include <deal.II/fe/fe_series.h>
#include <deal.II/grid/grid_refinement.h>
#include <deal.II/hp/fe_collection.h>
#include <deal.II/hp/fe_values.h>
#include <deal.II/hp/q_collection.h>
#include <deal.II/hp/refinement.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/numerics/smoothness_estimator.h>

#include "dealii_poisson.hpp"

namespace dealii_high_order {

using namespace dealii;
using dealii_poisson::Exact;

class Laplace {
public:
    explicit Laplace(const Function<3>& harmonic) : exact{&harmonic} {
        Triangulation<2> plane;
        GridGenerator::hyper_L(plane);
        GridTools::rotate(-numbers::PI / 2, plane);
        GridGenerator::extrude_triangulation(plane, 2, 1.0, triangulation);
        triangulation.refine_global(1);
        for (unsigned degree = 2; degree <= 5; ++degree) {
            elements.push_back(FE_Q<3>(degree));
            quadratures.push_back(QGauss<3>(degree + 1));
            on_faces.push_back(QGauss<2>(degree + 1));
        }
    }

    void solve();
    void refine();
    double error() const;
    /// How many degrees there are.
    std::size_t degree_count() const {
        std::set<unsigned> degrees;
        for (const auto& cell : dofs.active_cell_iterators()) degrees.insert(cell->get_fe().degree);
        return degrees.size();
    }
    /// Whether cells of different size meet.
    bool has_hanging_faces() const { return triangulation.has_hanging_nodes(); }

    Triangulation<3> triangulation;
    DoFHandler<3> dofs{triangulation};
    Vector<double> solution;

private:
    void assemble();

    const Function<3>* exact;
    hp::FECollection<3> elements;
    hp::QCollection<3> quadratures;
    hp::QCollection<2> on_faces;
    AffineConstraints<double> constraints;
    SparsityPattern sparsity;
    SparseMatrix<double> matrix;
    Vector<double> rhs;
};

inline void Laplace::assemble() {
    hp::FEValues<3> values(elements, quadratures, update_gradients | update_JxW_values);
    FullMatrix<double> local;
    Vector<double> nothing;
    std::vector<types::global_dof_index> index;
    for (const auto& cell : dofs.active_cell_iterators()) {
        const unsigned count = cell->get_fe().n_dofs_per_cell();
        values.reinit(cell);
        const FEValues<3>& of_cell = values.get_present_fe_values();
        local.reinit(count, count);
        for (const unsigned q : of_cell.quadrature_point_indices()) {
            for (unsigned i = 0; i < count; ++i) {
                const Tensor<1, 3> weighted = of_cell.shape_grad(i, q) * of_cell.JxW(q);
                for (unsigned j = 0; j <= i; ++j)
                    local(i, j) += weighted * of_cell.shape_grad(j, q);
            }
        }
        for (unsigned i = 0; i < count; ++i) {
            for (unsigned j = 0; j < i; ++j) local(j, i) = local(i, j);
        }
        nothing.reinit(count);
        index.resize(count);
        cell->get_dof_indices(index);
        constraints.distribute_local_to_global(local, nothing, index, matrix, rhs);
    }
}

inline void Laplace::solve() {
    dofs.distribute_dofs(elements);
    solution.reinit(dofs.n_dofs());
    rhs.reinit(dofs.n_dofs());
    constraints.clear();
    DoFTools::make_hanging_node_constraints(dofs, constraints);
    VectorTools::interpolate_boundary_values(dofs, 0, *exact, constraints);
    constraints.close();
    DynamicSparsityPattern pattern(dofs.n_dofs());
    DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false);
    sparsity.copy_from(pattern);
    matrix.reinit(sparsity);
    assemble();
    PreconditionSSOR<SparseMatrix<double>> preconditioner;
    preconditioner.initialize(matrix, 1.2);
    SolverControl control(2000, 1e-10 * rhs.l2_norm());
    SolverCG<Vector<double>>(control).solve(matrix, solution, rhs, preconditioner);
    constraints.distribute(solution);
}

inline double Laplace::error() const {
    Vector<float> of_cell(triangulation.n_active_cells());
    VectorTools::integrate_difference(dofs, solution, *exact, of_cell, quadratures,
                                      VectorTools::L2_norm);
    return of_cell.l2_norm();
}

inline void Laplace::refine() {
    Vector<float> estimate(triangulation.n_active_cells());
    Vector<float> smoothness(triangulation.n_active_cells());
    KellyErrorEstimator<3>::estimate(dofs, on_faces, {}, solution, estimate);
    auto legendre = SmoothnessEstimator::Legendre::default_fe_series(elements);
    SmoothnessEstimator::Legendre::coefficient_decay(legendre, dofs, solution, smoothness);
    GridRefinement::refine_and_coarsen_fixed_number(triangulation, estimate, 0.25, 0.0);
    hp::Refinement::p_adaptivity_fixed_number(dofs, smoothness, 0.6, 0.0);
    hp::Refinement::choose_p_over_h(dofs);
    triangulation.execute_coarsening_and_refinement();
}

}  // namespace dealii_high_order
