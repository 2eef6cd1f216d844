// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <deal.II/base/mpi.h>

#include <nestgrid/adapters/dealii.hpp>

#include "dealii_poisson.hpp"
#include "solver_slices.hpp"

namespace {

/// The potential of a charge beside the edge that reenters, outside of the domain.
class Charge : public dealii::Function<3> {
public:
    double value(const dealii::Point<3>& x, unsigned = 0) const override {
        return 1 / x.distance({0.12, -0.12, 0.45});
    }
};

/// An L of edges of 1 without x > 0, y < 0, and of height 1.
bool on_boundary_of_l(const nestgrid::Point& x) {
    constexpr double near = 1e-6;
    if (on_boundary_of_box({x[0] + 1, x[1] + 1, x[2]}, {2, 2, 1})) return true;
    return (std::abs(x[0]) < near && x[1] < near) || (std::abs(x[1]) < near && x[0] > -near);
}

}  // namespace

void slices_dealii(bool quick) {
    int argc = 0;
    char** argv = nullptr;
    const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
    const Charge charge;
    dealii_poisson::Laplace problem(charge);
    const unsigned cells = quick ? 2'000 : 100'000;
    for (bool enough = false; !enough;) {
        problem.setup();
        problem.assemble();
        problem.solve();
        enough = problem.triangulation.n_active_cells() > cells;
        if (!enough) problem.refine();
    }
    const nestgrid::DealiiGrid<3> grid(problem.triangulation);
    const nestgrid::DealiiField field(grid, problem.dofs, problem.solution);
    measure_slices({"dealii", on_boundary_of_l, quick}, nestgrid::erase(grid, field));
}
