// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces on triangulations that deal.II distributes or shares over MPI, adapted three times with
// a new partition each time: the pieces of all ranks, gathered, are the surface of the same
// triangulation on one process. Run under mpirun; prints what it compared with the hash of all
// triangles on one process, and returns 1 where something differs.
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include "dealii_ranks.hpp"

using namespace nestgrid_test;

namespace {

template <int dim>
struct Parted : dealii::parallel::distributed::Triangulation<dim> {
    explicit Parted(MPI_Comm communicator)
        : dealii::parallel::distributed::Triangulation<dim>(communicator) {}
};
template <int dim>
struct Shared : dealii::parallel::shared::Triangulation<dim> {
    explicit Shared(MPI_Comm communicator)
        : dealii::parallel::shared::Triangulation<dim>(
              communicator, dealii::Triangulation<dim>::none, false,
              dealii::parallel::shared::Triangulation<dim>::partition_zorder) {}
};
namespace make = dealii::GridGenerator;

/// Opposite sides are the same by constraints alone: the domain is as it is.
template <int dim>
void periodic(dealii::Triangulation<dim>& triangulation) {
    make::subdivided_hyper_cube(triangulation, 2, 0.0, 1.0, true);
    std::vector<
        dealii::GridTools::PeriodicFacePair<typename dealii::Triangulation<dim>::cell_iterator>>
        pairs;
    dealii::GridTools::collect_periodic_faces(triangulation, 0, 1, 0, pairs);
    triangulation.add_periodicity(pairs);
    triangulation.refine_global(1);
}

/// Every process sees its own cells and those beside them alone.
template <int dim>
struct SharedWithArtificial : dealii::parallel::shared::Triangulation<dim> {
    explicit SharedWithArtificial(MPI_Comm communicator)
        : dealii::parallel::shared::Triangulation<dim>(
              communicator, dealii::Triangulation<dim>::none, true,
              dealii::parallel::shared::Triangulation<dim>::partition_zorder) {}
};

template <int dim>
void cubes(dealii::Triangulation<dim>& triangulation) {
    make::subdivided_hyper_cube(triangulation, 3);
    triangulation.refine_global(1);
}
template <int dim>
void ball(dealii::Triangulation<dim>& triangulation) {
    const double middle = 0.5;
    make::hyper_ball(
        triangulation,
        dim == 2 ? dealii::Point<dim>(middle, middle) : dealii::Point<dim>(middle, middle, middle),
        0.7);
    triangulation.refine_global(1);
}
template <int dim>
void simplices(dealii::Triangulation<dim>& triangulation) {
    make::subdivided_hyper_cube_with_simplices(triangulation, 2);
    if (dim == 2) triangulation.refine_global(1);
}

template <int dim>
int on_dimension(Ranks& ranks) {
    const auto own = [](const auto& p, bool n) { return dealii_vector(p, n); };
    const auto trilinos = [](const auto& p, bool n) {
        return ghosted<dealii::TrilinosWrappers::MPI::Vector>(p, n);
    };
    const auto petsc = [](const auto& p, bool n) {
        return ghosted<dealii::PETScWrappers::MPI::Vector>(p, n);
    };
    const auto all = [](const auto& p, bool n) { return replicated(p, n); };
    int wrong = 0;
    wrong += Case<dim, Parted<dim>>("distributed cubes", cubes<dim>, ranks).adapt_and_compare(own);
    wrong +=
        Case<dim, Parted<dim>>("distributed ball", ball<dim>, ranks).adapt_and_compare(trilinos);
    wrong += Case<dim, Parted<dim>>("distributed, periodic", periodic<dim>, ranks)
                 .adapt_and_compare(own);
    wrong += Case<dim, Shared<dim>>("shared cubes", cubes<dim>, ranks).adapt_and_compare(petsc);
    wrong += Case<dim, Shared<dim>>("shared ball", ball<dim>, ranks).adapt_and_compare(all);
    wrong += Case<dim, SharedWithArtificial<dim>>("shared cubes, artificial", cubes<dim>, ranks)
                 .adapt_and_compare(own);
    wrong +=
        Case<dim, Shared<dim>>("shared simplices", simplices<dim>, ranks).adapt_and_compare(own);
    return wrong;
}

/// Vectors that lack values, and triangulations that are not drawn, end all ranks alike.
int refuse(Ranks& ranks) {
    if (ranks.size() == 1) return 0;
    Refusals refusals(ranks);
    Parted<2> triangulation(MPI_COMM_WORLD);
    cubes<2>(triangulation);
    adapt(triangulation, 0);
    const Problem<2> problem(triangulation);
    const DealiiGrid<2> mine(triangulation);
    dealii::Triangulation<2> whole;
    cubes<2>(whole);
    refuse_other_ranks(mine, DealiiGrid<2>(whole), ranks, refusals);
    const Distributed grid(mine, ranks);
    // deal.II gives a node between processes to the least of them.
    auto values = dealii_vector(problem, false);
    values.zero_out_ghost_values();
    refusals.expect<InvalidInput>("rank 1: entry ", [&] {
        const DistributedField field(grid, DealiiField(mine, problem.dofs, values));
    });
    dealii::LinearAlgebra::distributed::Vector<double> own(problem.dofs.locally_owned_dofs(),
                                                           MPI_COMM_WORLD);
    own.update_ghost_values();
    refusals.expect<InvalidInput>("the vector has no copy of it", [&] {
        const DistributedField field(grid, DealiiField(mine, problem.dofs, own));
    });
    values.update_ghost_values();
    for (double& value : values) value += 1;  // and not updated again
    refusals.expect<InvalidInput>("its field differs from that of rank", [&] {
        const DistributedField field(grid, DealiiField(mine, problem.dofs, values));
    });
    values.update_ghost_values();
    const DealiiField field(mine, problem.dofs, values);
    refusals.expect<GridError>("are on other processes", [&] { isosurface(mine, field, 0.0); });
    const dealii::MappingQ<2> mapping(1);
    refusals.expect<InvalidInput>("a mapping gives no positions of cells of other processes",
                                  [&] { const DealiiGrid<2> mapped(triangulation, &mapping); });
    dealii::parallel::fullydistributed::Triangulation<2> fully(MPI_COMM_WORLD);
    fully.copy_triangulation(triangulation);
    refusals.expect<InvalidInput>("the triangulation is fully distributed",
                                  [&] { const DealiiGrid<2> refused(fully); });
    Shared<2> shared(MPI_COMM_WORLD);
    cubes<2>(shared);
    shared.begin_active()->set_refine_flag(dealii::RefinementCase<2>::cut_x);
    shared.execute_coarsening_and_refinement();
    refusals.expect<InvalidInput>("is refined in some directions only",
                                  [&] { const DealiiGrid<2> refused(shared); });
    triangulation.repartition();
    refusals.expect<GridError>("make another DealiiGrid", [&] {
        const DealiiField stale(mine, problem.dofs, values);
        const DistributedField on_ranks(Distributed(mine, ranks), stale);
    });
    return refusals.wrong;
}

}  // namespace

int main(int argc, char** argv) {
    const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
    MpiRanks ranks(MPI_COMM_WORLD);
    int wrong = 0;
    try {
        wrong = on_dimension<2>(ranks) + on_dimension<3>(ranks) + refuse(ranks);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "rank %d: %s\n", ranks.rank(), e.what());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    return status_of_all(ranks, wrong);
}
