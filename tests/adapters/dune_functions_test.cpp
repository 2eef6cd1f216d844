// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Vectors of dune-istl and functions of dune-functions on nested grids of Dune.
#include <dune/functions/functionspacebases/interpolate.hh>
#include <dune/functions/functionspacebases/lagrangebasis.hh>
#include <dune/functions/gridfunctions/discreteglobalbasisfunction.hh>
#include <dune/istl/bvector.hh>

#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/high_order.hpp>

#include "closedness.hpp"
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

double cubic(const Place& x) { return quadratic(x) + 0.4 * x[0] * x[0] * x[1]; }

/// A function of order p that is one of the space: what is drawn is within the error of it.
template <int order>
void expect_polynomials_are_drawn(const UGGrid<3>& solver, double (*function)(const Place&)) {
    const DuneGrid grid(solver);
    const Dune::Functions::LagrangeBasis<UGGrid<3>::LeafGridView, order> basis(
        solver.leafGridView());
    Dune::BlockVector<Dune::FieldVector<double, 1>> coefficients;
    Dune::Functions::interpolate(basis, coefficients, function);
    const auto u = Dune::Functions::makeDiscreteGlobalBasisFunction<double>(basis, coefficients);
    const DunePolynomialField field(grid, u, order);
    const auto violation = check_grid(grid, field);
    ASSERT_FALSE(violation) << violation->sentence;
    const DunePolynomialField too_low(grid, u, order - 1);
    EXPECT_TRUE(check_grid(grid, too_low).has_value());
    const HighOrder data(grid, field);
    EXPECT_EQ(data.greatest_degree(), order);
    EXPECT_LE(data.jump(), 1e-12);
    const double error = 1e-3;
    const auto result = isosurface<3>({grid, field}, 0, {.threshold = error, .indicator = "error"});
    expect_closed(result.surface);
    EXPECT_GT(result.surface.simplices.size(), 1000U);
    EXPECT_LE(result.error_bound, error * (1 + 1e-6));
    double greatest = 0;
    for (const auto& t : result.surface.simplices) {
        Point middle{0, 0, 0};
        for (const auto v : t) middle = middle + (1.0 / 3) * result.surface.vertices[v];
        greatest = std::max(greatest, std::abs(function({middle[0], middle[1], middle[2]})));
    }
    EXPECT_LE(greatest, result.error_bound + 1e-12);
    EXPECT_GT(greatest, error / 100);
}

TEST(DuneFunctions, PolynomialsAreDrawnWithinTheError) {
    const auto tetrahedra = simplices<3>(2);
    tetrahedra->globalRefine(1);
    expect_polynomials_are_drawn<2>(*tetrahedra, quadratic);
    expect_polynomials_are_drawn<3>(*tetrahedra, cubic);
    // On hexahedra dune-functions has orders 1 and 2.
    const auto hexahedra = hanging_cubes<3>(2, 1, 0.3);
    expect_polynomials_are_drawn<2>(*hexahedra, quadratic);
}

TEST(DuneFunctions, LagrangeOfFirstOrder) { expect_function_is_seen<1>(); }
TEST(DuneFunctions, LagrangeOfSecondOrderAtVertices) { expect_function_is_seen<2>(); }

}  // namespace
