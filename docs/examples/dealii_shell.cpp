// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deal.II: a thin elastic cylinder between two walls, pressed in on top, by 512 curved cells of
// degree 3. Writes the bent cells with von Mises' stress as a .vtu of Lagrange cells, for the
// program.
//     dealii_shell [file]
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>
#include <deal.II/numerics/vector_tools.h>

namespace {

constexpr unsigned degree = 3;
constexpr double length = 3;
// Lame's constants where Young's modulus is 1 and Poisson's ratio 0.3.
constexpr double lambda = 0.3 / (1.3 * 0.4);
constexpr double mu = 0.5 / 1.3;

using Strain = dealii::SymmetricTensor<2, 3>;

Strain stress_of(const Strain& strain) {
    return lambda * trace(strain) * dealii::unit_symmetric_tensor<3>() + 2 * mu * strain;
}

/// Downwards, on top in the middle.
dealii::Tensor<1, 3> force(const dealii::Point<3>& x) {
    const double along = x[2] - length / 2;
    dealii::Tensor<1, 3> f;
    if (x[1] > 0) f[1] = -0.3 * std::exp(-(x[0] * x[0] + along * along) / 0.05);
    return f;
}

class VonMises final : public dealii::DataPostprocessorScalar<3> {
public:
    VonMises() : DataPostprocessorScalar<3>("stress", dealii::update_gradients) {}
    void evaluate_vector_field(const dealii::DataPostprocessorInputs::Vector<3>& at,
                               std::vector<dealii::Vector<double>>& out) const override {
        for (std::size_t q = 0; q < out.size(); ++q) {
            Strain strain;
            for (unsigned i = 0; i < 3; ++i) {
                for (unsigned j = i; j < 3; ++j) {
                    strain[i][j] =
                        (at.solution_gradients[q][i][j] + at.solution_gradients[q][j][i]) / 2;
                }
            }
            out[q](0) = std::sqrt(1.5) * deviator(stress_of(strain)).norm();
        }
    }
};

/// The displacement.
class Elasticity {
public:
    Elasticity() : space(dealii::FE_Q<3>(degree), 3), dofs(cylinder_) {
        dealii::GridGenerator::cylinder_shell(cylinder_, length, 0.9, 1.0, 32, 16);
        dofs.distribute_dofs(space);
    }
    void solve();

    dealii::Vector<double> solution;
    dealii::FESystem<3> space;
    const dealii::MappingQ<3> round{degree};

private:
    dealii::Triangulation<3> cylinder_;

public:
    dealii::DoFHandler<3> dofs;
};

void Elasticity::solve() {
    dealii::AffineConstraints<double> walls;
    for (const auto& face : cylinder_.active_face_iterators()) {
        const double z = face->center()[2];
        const bool at_wall = face->at_boundary() && (z < 1e-9 || z > length - 1e-9);
        if (at_wall) face->set_all_boundary_ids(7);
    }
    dealii::VectorTools::interpolate_boundary_values(round, dofs, 7,
                                                     dealii::Functions::ZeroFunction<3>(3), walls);
    walls.close();
    dealii::DynamicSparsityPattern pairs(dofs.n_dofs());
    dealii::DoFTools::make_sparsity_pattern(dofs, pairs, walls, false);
    dealii::SparsityPattern pattern;
    pattern.copy_from(pairs);
    dealii::SparseMatrix<double> matrix(pattern);
    dealii::Vector<double> load(dofs.n_dofs());
    solution.reinit(dofs.n_dofs());

    const dealii::QGauss<3> quadrature(degree + 1);
    dealii::FEValues<3> values(round, space, quadrature,
                               dealii::update_values | dealii::update_gradients |
                                   dealii::update_JxW_values | dealii::update_quadrature_points);
    const dealii::FEValuesExtractors::Vector u(0);
    const unsigned n = space.n_dofs_per_cell();
    dealii::FullMatrix<double> local(n, n);
    dealii::Vector<double> local_load(n);
    std::vector<dealii::types::global_dof_index> numbers(n);
    std::vector<Strain> strain(n);
    for (const auto& cell : dofs.active_cell_iterators()) {
        values.reinit(cell);
        local = 0;
        local_load = 0;
        for (const unsigned q : values.quadrature_point_indices()) {
            for (unsigned i = 0; i < n; ++i) strain[i] = values[u].symmetric_gradient(i, q);
            const auto f = force(values.quadrature_point(q));
            for (unsigned i = 0; i < n; ++i) {
                const Strain stress = stress_of(strain[i]) * values.JxW(q);
                for (unsigned j = 0; j < n; ++j) local(i, j) += stress * strain[j];
                local_load(i) += values[u].value(i, q) * f * values.JxW(q);
            }
        }
        cell->get_dof_indices(numbers);
        walls.distribute_local_to_global(local, local_load, numbers, matrix, load);
    }
    dealii::SparseDirectUMFPACK inverse;
    inverse.initialize(matrix);
    inverse.vmult(solution, load);
    walls.distribute(solution);
}

int run(const std::string& path) {
    Elasticity shell;
    shell.solve();
    const VonMises stress;
    dealii::MappingQCache<3> bent(degree);
    bent.initialize(shell.round, shell.dofs, shell.solution, true);
    dealii::DataOut<3> out;
    dealii::DataOutBase::VtkFlags flags;
    flags.write_higher_order_cells = true;
    out.set_flags(flags);
    out.add_data_vector(shell.dofs, shell.solution, stress);
    out.build_patches(bent, degree, dealii::DataOut<3>::curved_inner_cells);
    std::ofstream file(path);
    out.write_vtu(file);
    file.close();
    std::printf("%u unknowns, deflection %.3f\n", shell.dofs.n_dofs(),
                shell.solution.linfty_norm());
    return file ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc > 1 ? argv[1] : "shell.vtu");
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dealii_shell: %s\n", e.what());
        return 1;
    }
}
