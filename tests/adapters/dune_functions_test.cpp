// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Vectors of dune-istl and functions of dune-functions on nested grids of Dune.
#include <dune/functions/functionspacebases/interpolate.hh>
#include <dune/functions/functionspacebases/lagrangebasis.hh>
#include <dune/functions/gridfunctions/discreteglobalbasisfunction.hh>
#include <dune/istl/bvector.hh>

#include "dune_ug_grids.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

using Place = Dune::FieldVector<double, 3>;

double quadratic(const Place& x) { return 0.3 - x[0] * x[0] + x[1] * x[2] - 0.2 * x[2]; }

/// Interpolates the quadratic polynomial and looks at it through its field.
template <int order>
void expect_function_is_seen() {
    const auto solver = simplices<3>(2);
    refine_at_sphere(*solver, 3, 0.2);
    const DuneGrid grid(*solver);
    const Dune::Functions::LagrangeBasis<UGGrid<3>::LeafGridView, order> basis(
        solver->leafGridView());
    Dune::BlockVector<Dune::FieldVector<double, 1>> coefficients;
    Dune::Functions::interpolate(basis, coefficients, quadratic);
    const auto u = Dune::Functions::makeDiscreteGlobalBasisFunction<double>(basis, coefficients);
    const DuneFunctionField field(grid, u);
    const auto violation = check_grid(grid, field);
    ASSERT_FALSE(violation) << violation->sentence;

    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {});
    engine::project(walk, Exact{}, [&](const auto& view) {
        for (int k = 0; k < 4; ++k) {
            EXPECT_NEAR(view.value[k], quadratic(element_in(grid, view).geometry().corner(k)),
                        1e-15);
        }
    });
    if constexpr (order == 1) {
        const DuneVertexField vertex(grid, coefficients);
        static_assert(decltype(vertex)::components == 1);
        const auto a = isosurface(grid, vertex, 0, {.threshold = 0.01}).surface;
        const auto b = isosurface(grid, field, 0, {.threshold = 0.01}).surface;
        EXPECT_GT(a.simplices.size(), 100U);
        EXPECT_EQ(a.vertices, b.vertices);
        EXPECT_EQ(a.simplices, b.simplices);
    }
}

TEST(DuneFunctions, LagrangeOfFirstOrder) { expect_function_is_seen<1>(); }
TEST(DuneFunctions, LagrangeOfSecondOrderAtVertices) { expect_function_is_seen<2>(); }

}  // namespace
