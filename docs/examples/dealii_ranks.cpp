// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces on a triangulation of deal.II that is distributed over the ranks of MPI
// (docs/distributed.md): Poisson's equation around a corner that reenters, refined and partitioned
// anew in every cycle. All ranks write one closed surface a cycle.
//     mpirun -n 4 dealii_ranks [cycles] [folder]
#include <cstdio>
#include <cstdlib>
#include <string>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/grid_refinement.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/numerics/error_estimator.h>
#include <deal.II/numerics/vector_tools.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/adapters/mpi.hpp>
#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

namespace {

using dealii::IndexSet;
using ParallelVector = dealii::LinearAlgebra::distributed::Vector<double>;

/// - laplace(u) = 1 in a cube without one of its octants, u = 0 on the boundary.
class Poisson {
public:
    Poisson() : triangulation(MPI_COMM_WORLD), dofs(triangulation) {
        dealii::GridGenerator::hyper_L(triangulation, 0.0, 1.0);
        triangulation.refine_global(3);
    }

    void solve() {
        dofs.distribute_dofs(fe_);
        const IndexSet own = dofs.locally_owned_dofs();
        IndexSet relevant;
        dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
        constraints_.reinit(relevant);
        dealii::DoFTools::make_hanging_node_constraints(dofs, constraints_);
        dealii::VectorTools::interpolate_boundary_values(
            dofs, 0, dealii::Functions::ZeroFunction<3>(), constraints_);
        constraints_.close();
        dealii::DynamicSparsityPattern pattern(relevant);
        dealii::DoFTools::make_sparsity_pattern(dofs, pattern, constraints_, false);
        dealii::SparsityTools::distribute_sparsity_pattern(pattern, own, MPI_COMM_WORLD, relevant);
        matrix_.reinit(own, own, pattern, MPI_COMM_WORLD);
        rhs_.reinit(own, relevant, MPI_COMM_WORLD);
        solution.reinit(own, relevant, MPI_COMM_WORLD);
        assemble();
        dealii::TrilinosWrappers::PreconditionAMG multigrid;
        multigrid.initialize(matrix_);
        dealii::SolverControl control(200, 1e-10 * rhs_.l2_norm());
        dealii::SolverCG<ParallelVector>(control).solve(matrix_, solution, rhs_, multigrid);
        constraints_.distribute(solution);
        solution.update_ghost_values();
    }

    /// Where the estimate is greatest, 15 % of the cells; then deal.II makes a new partition.
    void refine() {
        dealii::Vector<float> estimate(triangulation.n_active_cells());
        dealii::KellyErrorEstimator<3>::estimate(dofs, dealii::QGauss<2>(2), {}, solution,
                                                 estimate);
        dealii::parallel::distributed::GridRefinement::refine_and_coarsen_fixed_number(
            triangulation, estimate, 0.15, 0.02);
        triangulation.execute_coarsening_and_refinement();
    }

    dealii::parallel::distributed::Triangulation<3> triangulation;
    dealii::DoFHandler<3> dofs;
    ParallelVector solution;

private:
    void assemble() {
        const dealii::QGauss<3> quadrature(2);
        dealii::FEValues<3> values(
            fe_, quadrature,
            dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
        dealii::FullMatrix<double> local(fe_.dofs_per_cell);
        dealii::Vector<double> right(fe_.dofs_per_cell);
        std::vector<dealii::types::global_dof_index> index(fe_.dofs_per_cell);
        for (const auto& cell : dofs.active_cell_iterators()) {
            if (!cell->is_locally_owned()) continue;
            values.reinit(cell);
            local = 0;
            right = 0;
            for (const unsigned q : values.quadrature_point_indices()) {
                for (const unsigned i : values.dof_indices()) {
                    right(i) += values.shape_value(i, q) * values.JxW(q);
                    for (const unsigned j : values.dof_indices()) {
                        local(i, j) +=
                            values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
                    }
                }
            }
            cell->get_dof_indices(index);
            constraints_.distribute_local_to_global(local, right, index, matrix_, rhs_);
        }
        matrix_.compress(dealii::VectorOperation::add);
        rhs_.compress(dealii::VectorOperation::add);
    }

    dealii::FE_Q<3> fe_{1};
    dealii::AffineConstraints<double> constraints_;
    dealii::TrilinosWrappers::SparseMatrix matrix_;
    ParallelVector rhs_;
};

/// Solves, refines and draws, in turn.
bool run(int cycles, const std::string& folder) {
    nestgrid::MpiRanks ranks(MPI_COMM_WORLD);
    Poisson problem;
    for (int cycle = 0; cycle < cycles; ++cycle) {
        if (cycle > 0) problem.refine();
        problem.solve();

        // [surface]
        const nestgrid::DealiiGrid<3> mine(problem.triangulation);
        const nestgrid::Distributed grid(mine, ranks);
        const nestgrid::DistributedField field(
            grid, nestgrid::DealiiField(mine, problem.dofs, problem.solution));
        const auto piece = nestgrid::isosurface(grid, field, 0.02, {.threshold = 1e-4});
        const auto joined = nestgrid::join_pieces(piece, grid);
        nestgrid::write_vtp(ranks, piece, joined,
                            folder + "/surface-" + std::to_string(cycle) + ".vtp");
        // [surface]

        const auto leaves = problem.triangulation.n_global_active_cells();
        if (ranks.rank() == 0) {
            std::printf("cycle %d: %llu cells, %llu triangles, %llu open edges, within %.1e\n",
                        cycle, static_cast<unsigned long long>(leaves),
                        static_cast<unsigned long long>(joined.simplices),
                        static_cast<unsigned long long>(joined.open), piece.error_bound);
        }
        if (joined.open != 0) return false;
    }
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
    try {
        return run(argc > 1 ? std::atoi(argv[1]) : 4, argc > 2 ? argv[2] : ".") ? 0 : 1;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dealii_ranks: %s\n", e.what());
        return 1;
    }
}
