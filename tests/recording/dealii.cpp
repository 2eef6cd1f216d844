// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deal.II's triangulations with hanging nodes, curved ones and simplices.
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>

#include <nestgrid/adapters/dealii.hpp>

#include "closedness.hpp"
#include "options.hpp"

namespace {

using namespace recording;
using namespace nestgrid_test;

template <int dim>
void refine(dealii::Triangulation<dim>& triangulation, int steps, unsigned seed) {
    std::mt19937 random(seed);
    for (int step = 0; step < steps; ++step) {
        for (const auto& c : triangulation.active_cell_iterators()) {
            if (random() % 6 == 0) c->set_refine_flag();
        }
        triangulation.execute_coarsening_and_refinement();
    }
}

template <int dim>
void record_triangulation(const std::string& name, const dealii::Triangulation<dim>& triangulation,
                          bool cubes, bool all = false) {
    dealii::DoFHandler<dim> dofs(triangulation);
    if (cubes) {
        dofs.distribute_dofs(dealii::FE_Q<dim>(1));
    } else {
        dofs.distribute_dofs(dealii::FE_SimplexP<dim>(1));
    }
    dealii::AffineConstraints<double> constraints;
    dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
    constraints.close();
    std::vector<Point> vertices;
    for (const auto& v : triangulation.get_vertices()) {
        Point& x = vertices.emplace_back(Point{0, 0, 0});
        for (unsigned d = 0; d < dim; ++d) x[d] = v[d];
    }
    std::vector<dealii::Vector<double>> values;
    const DealiiGrid<dim> grid(triangulation);
    using Field = DealiiField<dim, dealii::Vector<double>>;
    std::vector<Subject<Field>> subjects;
    const auto fields = catching_fields(vertices, 7);
    values.reserve(fields.size());
    for (const NodalSamples& samples : fields) {
        auto& to = values.emplace_back(dofs.n_dofs());
        for (const auto& c : dofs.active_cell_iterators()) {
            for (const unsigned v : c->vertex_indices()) {
                to(c->vertex_dof_index(v, 0)) = samples.values[c->vertex_index(v)];
            }
        }
        constraints.distribute(to);
        subjects.push_back({samples.name.substr(0, samples.name.find(' ')), Field(grid, dofs, to),
                            0.0, samples.name == "5 units in the last place" ? 0x1p-52 : 1});
    }
    record_preroll(name, grid, subjects);
    record_options(name, grid, subjects);
    if (all) record_threads(name, grid, subjects);
}

template <int dim>
void record_dimension(const std::string& name) {
    namespace make = dealii::GridGenerator;
    dealii::Triangulation<dim> cube;
    make::subdivided_hyper_cube(cube, dim == 2 ? 4 : 2);
    refine(cube, 3, 1);
    record_triangulation(name + "/cube", cube, true, true);
    dealii::Triangulation<dim> shell;
    make::hyper_shell(shell, dealii::Point<dim>(), 0.3, 1.0);
    refine(shell, 2, 3);
    record_triangulation(name + "/shell", shell, true);
    dealii::Triangulation<dim> simplices;
    make::subdivided_hyper_cube_with_simplices(simplices, 2);
    simplices.refine_global(dim == 2 ? 3 : 1);
    record_triangulation(name + "/simplices", simplices, false);
}

}  // namespace

int main(int count, char** arguments) {
    record_dimension<2>("dealii/2");
    record_dimension<3>("dealii/3");
    return finish(count, arguments);
}
