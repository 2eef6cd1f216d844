// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares what ranks draw on a triangulation that deal.II distributes or shares over MPI with what
// one process draws on all of it.
#pragma once

#include <functional>
#include <memory>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria_base.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/petsc_vector.h>
#include <deal.II/lac/trilinos_vector.h>
#include <deal.II/lac/vector.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/adapters/mpi.hpp>

#include "drawn_on_ranks.hpp"

namespace nestgrid_test {

/// The distance from a sphere, perhaps with noise.
template <int dim>
double value(const dealii::Point<dim>& at, bool noise) {
    Point x{0, 0, 0};
    for (unsigned d = 0; d < dim; ++d) x[d] = at[d];
    return sphere(x, dim == 2, noise);
}

/// Refines at a sphere that grows, and coarsens elsewhere; some cells are refined at random.
/// Tetrahedra are refined everywhere: deal.II 9.4 has no constraints for their hanging nodes.
template <class Triangulation>
void adapt(Triangulation& triangulation, int step) {
    constexpr unsigned dim = Triangulation::dimension;
    const bool cubes = triangulation.all_reference_cells_are_hyper_cube();
    if (dim == 3 && !cubes) return triangulation.refine_global(step == 0 ? 0 : 1);
    // Where the triangulation is shared, all processes mark all cells alike.
    const bool marks_own = dynamic_cast<const dealii::parallel::DistributedTriangulationBase<dim>*>(
                               &triangulation) != nullptr;
    for (const auto& c : triangulation.active_cell_iterators()) {
        if (marks_own && !c->is_locally_owned()) continue;
        Point x{0, 0, 0};
        for (unsigned d = 0; d < dim; ++d) x[d] = c->center()[d];
        const Point middle{0.5, 0.5, dim == 3 ? 0.5 : 0};
        const double off = std::abs(norm(x - middle) - 0.2 - 0.08 * step);
        if (off < 0.4 * c->diameter() || random_of(x) < -0.4) {
            c->set_refine_flag();
        } else if (cubes && off > 2 * c->diameter()) {
            c->set_coarsen_flag();
        }
    }
    triangulation.execute_coarsening_and_refinement();
}

template <int dim>
using Make = std::function<void(dealii::Triangulation<dim>&)>;

template <int dim>
std::unique_ptr<dealii::FiniteElement<dim>> linear(const dealii::Triangulation<dim>& on) {
    if (on.all_reference_cells_are_hyper_cube()) return std::make_unique<dealii::FE_Q<dim>>(1);
    return std::make_unique<dealii::FE_SimplexP<dim>>(1);
}

/// Degrees of freedom of a triangulation, of which this process has some.
template <int dim>
struct Problem {
    explicit Problem(const dealii::Triangulation<dim>& triangulation)
        : fe{linear(triangulation)}, dofs{triangulation} {
        dofs.distribute_dofs(*fe);
        dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
        constraints.reinit(relevant);
        dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
        constraints.close();
    }
    /// Sets the values at own degrees of freedom. VectorTools::interpolate() would take means of
    /// what the cells here say, the last bits of which depend on how many these are.
    template <class Vector>
    void set(Vector& values, bool noise) const {
        const dealii::IndexSet own = dofs.locally_owned_dofs();
        for (const auto& c : dofs.active_cell_iterators()) {
            if (!c->is_locally_owned()) continue;
            for (const unsigned k : c->vertex_indices()) {
                const auto dof = c->vertex_dof_index(k, 0);
                if (own.is_element(dof)) values(dof) = value<dim>(c->vertex(k), noise);
            }
        }
        values.compress(dealii::VectorOperation::insert);
        constraints.distribute(values);
    }

    std::unique_ptr<dealii::FiniteElement<dim>> fe;
    dealii::DoFHandler<dim> dofs;
    dealii::IndexSet relevant;
    dealii::AffineConstraints<double> constraints;
};

// Vectors with the values of one problem that a rank has, as the solver's packages keep them.
template <int dim>
auto dealii_vector(const Problem<dim>& problem, bool noise) {
    dealii::LinearAlgebra::distributed::Vector<double> values(
        problem.dofs.locally_owned_dofs(), problem.relevant,
        problem.dofs.get_triangulation().get_communicator());
    problem.set(values, noise);
    values.update_ghost_values();
    return values;
}
template <class Vector, int dim>
Vector ghosted(const Problem<dim>& problem, bool noise) {
    const auto communicator = problem.dofs.get_triangulation().get_communicator();
    Vector own(problem.dofs.locally_owned_dofs(), communicator);
    problem.set(own, noise);
    Vector values(problem.dofs.locally_owned_dofs(), problem.relevant, communicator);
    values = own;
    return values;
}
/// All values on every rank, as programs with shared triangulations may have them.
template <int dim>
auto replicated(const Problem<dim>& problem, bool noise) {
    dealii::TrilinosWrappers::MPI::Vector own(problem.dofs.locally_owned_dofs(),
                                              problem.dofs.get_triangulation().get_communicator());
    problem.set(own, noise);
    return dealii::Vector<double>(own);
}

template <int dim, class Parallel>
class Case {
public:
    Case(const char* name, const Make<dim>& make, Ranks& ranks)
        : name_{name}, ranks_{&ranks}, parts_(MPI_COMM_WORLD), whole_(MPI_COMM_SELF) {
        make(parts_);
        make(whole_);
    }

    /// \param vector vector(problem, noise) has the values of a rank
    /// \return how many surfaces differ
    template <class MakeVector>
    int compare(bool noise, const MakeVector& vector) {
        const Problem<dim> problem(parts_);
        const auto values = vector(problem, noise);
        const DealiiGrid<dim> mine(parts_);
        const Distributed grid(mine, *ranks_);
        const DistributedField field(grid, DealiiField(mine, problem.dofs, values));
        auto own = draw<dim>(grid, field);
        const auto found = gathered<dim>(std::move(own), *ranks_);
        const auto leaves = static_cast<unsigned long long>(parts_.n_global_active_cells());
        int wrong = 0;
        if (ranks_->rank() == 0) {
            const std::string name = name_ + std::string(noise ? ", noise" : ", smooth");
            wrong = whole_.n_active_cells() == leaves ? 0 : 1;
            wrong += count_different(name, ranks_->size(), leaves, found, draw_alone(noise));
        }
        sleep_until_all();
        return wrong;
    }
    template <class MakeVector>
    int adapt_and_compare(const MakeVector& vector) {
        int wrong = 0;
        for (int step = 0; step < 3; ++step) {
            adapt(parts_, step);
            adapt(whole_, step);
        }
        if (dim == 2) wrong += compare(false, vector);
        wrong += compare(true, vector);
        return wrong;
    }

private:
    std::vector<Drawn<dim>> draw_alone(bool noise) const {
        const Problem<dim> problem(whole_);
        dealii::Vector<double> values(problem.dofs.n_dofs());
        problem.set(values, noise);
        const DealiiGrid<dim> grid(whole_);
        auto all = draw<dim>(grid, DealiiField(grid, problem.dofs, values));
        sort(all);
        return all;
    }

    const char* name_;
    Ranks* ranks_;
    Parallel parts_;
    Parallel whole_;
};

}  // namespace nestgrid_test
