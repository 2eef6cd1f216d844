// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solver of dealii_poisson.cpp, which knows nothing of nestgrid: Laplace's equation around an
// edge that reenters, by linear elements and adaptive geometric multigrid.
#pragma once

#include <cmath>

#include <deal.II/base/function_lib.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_refinement.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/multigrid/mg_coarse.h>
#include <deal.II/multigrid/mg_constrained_dofs.h>
#include <deal.II/multigrid/mg_matrix.h>
#include <deal.II/multigrid/mg_smoother.h>
#include <deal.II/multigrid/mg_tools.h>
#include <deal.II/multigrid/mg_transfer.h>
#include <deal.II/multigrid/multigrid.h>
#include <deal.II/numerics/error_estimator.h>
#include <deal.II/numerics/vector_tools.h>

namespace dealii_poisson {

using namespace dealii;

/// r^(2/3) sin(2 phi / 3) around the z axis: harmonic, with infinite gradients at the edge.
class Exact : public Function<3> {
public:
    double value(const Point<3>& x, unsigned = 0) const override {
        // The domain leaves out x > 0, y < 0: phi runs from 0 on the positive x axis to 3/2 pi.
        double phi = std::atan2(x[1], x[0]);
        if (phi < -1e-12) phi += 2 * numbers::PI;
        return std::pow(std::hypot(x[0], x[1]), 2.0 / 3) * std::sin(2 * phi / 3);
    }
};

class Laplace {
public:
    /// \param harmonic the solution; its values on the boundary are given
    explicit Laplace(const Function<3>& harmonic) : exact{&harmonic} {
        // An L with the corner at the origin, drawn out to a height of 1.
        Triangulation<2> plane;
        GridGenerator::hyper_L(plane);  // leaves out x > 0, y > 0
        GridTools::rotate(-numbers::PI / 2, plane);
        GridGenerator::extrude_triangulation(plane, 2, 1.0, triangulation);
        triangulation.refine_global(2);
    }

    void setup();
    void assemble();
    /// \return iterations of conjugate gradients, preconditioned by a V-cycle
    unsigned solve();
    double error() const;
    void refine();

    Triangulation<3> triangulation{Triangulation<3>::limit_level_difference_at_vertices};
    FE_Q<3> fe{1};
    DoFHandler<3> dofs{triangulation};
    Vector<double> solution;

private:
    template <class Cells, class Add>
    void for_each_cell_matrix(const Cells& cells, const Add& add);

    const Function<3>* exact;
    AffineConstraints<double> constraints;
    SparsityPattern sparsity;
    SparseMatrix<double> matrix;
    Vector<double> rhs;
    MGConstrainedDoFs mg_constraints;
    MGLevelObject<SparsityPattern> mg_sparsity, mg_edge_sparsity;
    MGLevelObject<SparseMatrix<double>> mg_matrix, mg_edge;
};

inline void Laplace::setup() {
    dofs.distribute_dofs(fe);
    dofs.distribute_mg_dofs();
    solution.reinit(dofs.n_dofs());
    rhs.reinit(dofs.n_dofs());
    constraints.clear();
    DoFTools::make_hanging_node_constraints(dofs, constraints);
    VectorTools::interpolate_boundary_values(dofs, 0, *exact, constraints);
    constraints.close();
    DynamicSparsityPattern pattern(dofs.n_dofs());
    DoFTools::make_sparsity_pattern(dofs, pattern, constraints);
    sparsity.copy_from(pattern);
    matrix.reinit(sparsity);

    mg_constraints.initialize(dofs);
    mg_constraints.make_zero_boundary_constraints(dofs, {0});
    const unsigned levels = triangulation.n_levels();
    mg_matrix.resize(0, levels - 1);
    mg_edge.resize(0, levels - 1);
    mg_sparsity.resize(0, levels - 1);
    mg_edge_sparsity.resize(0, levels - 1);
    for (unsigned l = 0; l < levels; ++l) {
        DynamicSparsityPattern inner(dofs.n_dofs(l));
        MGTools::make_sparsity_pattern(dofs, inner, l);
        mg_sparsity[l].copy_from(inner);
        mg_matrix[l].reinit(mg_sparsity[l]);
        DynamicSparsityPattern edge(dofs.n_dofs(l));
        MGTools::make_interface_sparsity_pattern(dofs, mg_constraints, edge, l);
        mg_edge_sparsity[l].copy_from(edge);
        mg_edge[l].reinit(mg_edge_sparsity[l]);
    }
}

template <class Cells, class Add>
void Laplace::for_each_cell_matrix(const Cells& cells, const Add& add) {
    const QGauss<3> quadrature(2);
    FEValues<3> values(fe, quadrature, update_gradients | update_JxW_values);
    FullMatrix<double> local(fe.dofs_per_cell);
    for (const auto& cell : cells) {
        values.reinit(cell);
        local = 0;
        for (const unsigned q : values.quadrature_point_indices()) {
            for (const unsigned i : values.dof_indices()) {
                for (const unsigned j : values.dof_indices()) {
                    local(i, j) +=
                        values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
                }
            }
        }
        add(cell, local);
    }
}

inline void Laplace::assemble() {
    std::vector<types::global_dof_index> index(fe.dofs_per_cell);
    const Vector<double> nothing(fe.dofs_per_cell);
    for_each_cell_matrix(dofs.active_cell_iterators(), [&](const auto& cell, const auto& local) {
        cell->get_dof_indices(index);
        constraints.distribute_local_to_global(local, nothing, index, matrix, rhs);
    });
    for (unsigned l = 0; l < triangulation.n_levels(); ++l) {
        AffineConstraints<double> level;
        level.add_lines(mg_constraints.get_refinement_edge_indices(l));
        level.add_lines(mg_constraints.get_boundary_indices(l));
        level.close();
        for_each_cell_matrix(
            dofs.mg_cell_iterators_on_level(l), [&](const auto& cell, const auto& local) {
                cell->get_mg_dof_indices(index);
                level.distribute_local_to_global(local, index, mg_matrix[l]);
                for (unsigned i = 0; i < index.size(); ++i) {
                    for (unsigned j = 0; j < index.size(); ++j) {
                        if (mg_constraints.is_interface_matrix_entry(l, index[i], index[j])) {
                            mg_edge[l].add(index[i], index[j], local(i, j));
                        }
                    }
                }
            });
    }
}

inline unsigned Laplace::solve() {
    MGTransferPrebuilt<Vector<double>> transfer(mg_constraints);
    transfer.build(dofs);
    FullMatrix<double> coarse;
    coarse.copy_from(mg_matrix[0]);
    MGCoarseGridHouseholder<double, Vector<double>> coarse_solver;
    coarse_solver.initialize(coarse);
    mg::SmootherRelaxation<PreconditionSOR<SparseMatrix<double>>, Vector<double>> smoother;
    smoother.initialize(mg_matrix);
    smoother.set_steps(2);
    smoother.set_symmetric(true);
    const mg::Matrix<Vector<double>> level(mg_matrix), edge(mg_edge);
    Multigrid<Vector<double>> multigrid(level, coarse_solver, transfer, smoother, smoother);
    multigrid.set_edge_matrices(edge, edge);
    PreconditionMG<3, Vector<double>, MGTransferPrebuilt<Vector<double>>> preconditioner(
        dofs, multigrid, transfer);
    SolverControl control(100, 1e-10 * rhs.l2_norm());
    SolverCG<Vector<double>>(control).solve(matrix, solution, rhs, preconditioner);
    constraints.distribute(solution);  // or the surface would tell, see below
    return control.last_step();
}

inline double Laplace::error() const {
    Vector<float> of_cell(triangulation.n_active_cells());
    VectorTools::integrate_difference(dofs, solution, *exact, of_cell, QGauss<3>(4),
                                      VectorTools::L2_norm);
    return of_cell.l2_norm();
}

inline void Laplace::refine() {
    Vector<float> estimate(triangulation.n_active_cells());
    KellyErrorEstimator<3>::estimate(dofs, QGauss<2>(2), {}, solution, estimate);
    GridRefinement::refine_and_coarsen_fixed_number(triangulation, estimate, 0.15, 0.0);
    triangulation.execute_coarsening_and_refinement();
}

}  // namespace dealii_poisson
