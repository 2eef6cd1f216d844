// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solver of dealii_poisson.cpp, which knows nothing of nestgrid: Laplace's equation around an
// edge that reenters, by linear elements and adaptive geometric multigrid, on one rank of MPI or on
// several.
#pragma once

#include <cmath>

#include <deal.II/base/function_lib.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/grid_refinement.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
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
using ParallelVector = LinearAlgebra::distributed::Vector<double>;
using Matrix = TrilinosWrappers::SparseMatrix;

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

    parallel::distributed::Triangulation<3> triangulation{
        MPI_COMM_WORLD, Triangulation<3>::limit_level_difference_at_vertices,
        parallel::distributed::Triangulation<3>::construct_multigrid_hierarchy};
    FE_Q<3> fe{1};
    DoFHandler<3> dofs{triangulation};
    ParallelVector solution;

private:
    template <class Cell, class Add>
    void add_cell(FEValues<3>& values, const Cell& cell, const Add& add);

    const Function<3>* exact;
    AffineConstraints<double> constraints;
    Matrix matrix;
    ParallelVector rhs;
    MGConstrainedDoFs mg_constraints;
    MGLevelObject<Matrix> mg_matrix, mg_edge;
};

inline void Laplace::setup() {
    dofs.distribute_dofs(fe);
    dofs.distribute_mg_dofs();
    const IndexSet own = dofs.locally_owned_dofs();
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    solution.reinit(own, relevant, MPI_COMM_WORLD);
    rhs.reinit(own, relevant, MPI_COMM_WORLD);
    constraints.reinit(relevant);
    DoFTools::make_hanging_node_constraints(dofs, constraints);
    VectorTools::interpolate_boundary_values(dofs, 0, *exact, constraints);
    constraints.close();
    const auto reinit = [](Matrix& of, const IndexSet& rows, const IndexSet& needed,
                           const auto& fill) {
        DynamicSparsityPattern pattern(needed);
        fill(pattern);
        SparsityTools::distribute_sparsity_pattern(pattern, rows, MPI_COMM_WORLD, needed);
        of.reinit(rows, rows, pattern, MPI_COMM_WORLD, true);
    };
    reinit(matrix, own, relevant, [&](DynamicSparsityPattern& pattern) {
        DoFTools::make_sparsity_pattern(dofs, pattern, constraints);
    });

    mg_constraints.initialize(dofs);
    mg_constraints.make_zero_boundary_constraints(dofs, {0});
    const unsigned levels = triangulation.n_global_levels();
    mg_matrix.resize(0, levels - 1);
    mg_edge.resize(0, levels - 1);
    for (unsigned l = 0; l < levels; ++l) {
        IndexSet needed;
        DoFTools::extract_locally_relevant_level_dofs(dofs, l, needed);
        const IndexSet rows = dofs.locally_owned_mg_dofs(l);
        reinit(mg_matrix[l], rows, needed, [&](DynamicSparsityPattern& pattern) {
            MGTools::make_sparsity_pattern(dofs, pattern, l);
        });
        reinit(mg_edge[l], rows, needed, [&](DynamicSparsityPattern& pattern) {
            MGTools::make_interface_sparsity_pattern(dofs, mg_constraints, pattern, l);
        });
    }
}

/// Calls add(local) with the matrix of one cell.
template <class Cell, class Add>
void Laplace::add_cell(FEValues<3>& values, const Cell& cell, const Add& add) {
    FullMatrix<double> local(fe.dofs_per_cell);
    values.reinit(cell);
    for (const unsigned q : values.quadrature_point_indices()) {
        for (const unsigned i : values.dof_indices()) {
            for (const unsigned j : values.dof_indices()) {
                local(i, j) += values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
            }
        }
    }
    add(local);
}

/// Each rank adds its cells, and its cells of the levels.
inline void Laplace::assemble() {
    const QGauss<3> quadrature(2);
    FEValues<3> values(fe, quadrature, update_gradients | update_JxW_values);
    std::vector<types::global_dof_index> index(fe.dofs_per_cell);
    const Vector<double> nothing(fe.dofs_per_cell);
    for (const auto& cell : dofs.active_cell_iterators()) {
        if (!cell->is_locally_owned()) continue;
        add_cell(values, cell, [&](const auto& local) {
            cell->get_dof_indices(index);
            constraints.distribute_local_to_global(local, nothing, index, matrix, rhs);
        });
    }
    matrix.compress(VectorOperation::add);
    rhs.compress(VectorOperation::add);
    for (unsigned l = 0; l < triangulation.n_global_levels(); ++l) {
        IndexSet needed;
        DoFTools::extract_locally_relevant_level_dofs(dofs, l, needed);
        AffineConstraints<double> level(needed);
        level.add_lines(mg_constraints.get_refinement_edge_indices(l));
        level.add_lines(mg_constraints.get_boundary_indices(l));
        level.close();
        for (const auto& cell : dofs.mg_cell_iterators_on_level(l)) {
            if (cell->level_subdomain_id() != triangulation.locally_owned_subdomain()) continue;
            add_cell(values, cell, [&](const auto& local) {
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
        mg_matrix[l].compress(VectorOperation::add);
        mg_edge[l].compress(VectorOperation::add);
    }
}

inline unsigned Laplace::solve() {
    MGTransferPrebuilt<ParallelVector> transfer(mg_constraints);
    transfer.build(dofs);
    ReductionControl coarse_control(100, 1e-20, 1e-12);
    SolverCG<ParallelVector> coarse_cg(coarse_control);
    const PreconditionIdentity nothing;
    MGCoarseGridIterativeSolver<ParallelVector, SolverCG<ParallelVector>, Matrix,
                                PreconditionIdentity>
        coarse_solver(coarse_cg, mg_matrix[0], nothing);
    MGSmootherPrecondition<Matrix, TrilinosWrappers::PreconditionSSOR, ParallelVector> smoother;
    smoother.initialize(mg_matrix, TrilinosWrappers::PreconditionSSOR::AdditionalData());
    const mg::Matrix<ParallelVector> level(mg_matrix), edge(mg_edge);
    Multigrid<ParallelVector> multigrid(level, coarse_solver, transfer, smoother, smoother);
    multigrid.set_edge_matrices(edge, edge);
    PreconditionMG<3, ParallelVector, MGTransferPrebuilt<ParallelVector>> preconditioner(
        dofs, multigrid, transfer);
    SolverControl control(100, 1e-10 * rhs.l2_norm());
    SolverCG<ParallelVector>(control).solve(matrix, solution, rhs, preconditioner);
    constraints.distribute(solution);  // or the surface would tell, see below
    solution.update_ghost_values();
    return control.last_step();
}

inline double Laplace::error() const {
    Vector<float> of_cell(triangulation.n_active_cells());
    VectorTools::integrate_difference(dofs, solution, *exact, of_cell, QGauss<3>(4),
                                      VectorTools::L2_norm);
    return VectorTools::compute_global_error(triangulation, of_cell, VectorTools::L2_norm);
}

/// Where the estimate is greatest, 15 % of the cells; then deal.II makes a new partition.
inline void Laplace::refine() {
    Vector<float> estimate(triangulation.n_active_cells());
    KellyErrorEstimator<3>::estimate(dofs, QGauss<2>(2), {}, solution, estimate);
    parallel::distributed::GridRefinement::refine_and_coarsen_fixed_number(triangulation, estimate,
                                                                           0.15, 0.0);
    triangulation.execute_coarsening_and_refinement();
}

}  // namespace dealii_poisson
