// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deal.II's own triangulations, elements, vectors and solutions.
#include <deal.II/base/function_lib.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/fe/mapping_q1_eulerian.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_refinement.h>
#include <deal.II/hp/fe_collection.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/error_estimator.h>
#include <deal.II/numerics/matrix_creator.h>
#include <deal.II/numerics/vector_tools.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>

#include "changed_laws.hpp"
#include "counting_allocator.hpp"
#include "refusal.hpp"
#include "solver_laws.hpp"

using namespace nestgrid_test;
using dealii::DoFHandler;
using dealii::FE_Q;
using dealii::Triangulation;
using DoubleVector = dealii::Vector<double>;

namespace {

#ifdef DEBUG
constexpr unsigned enough = 5000;  // deal.II checks everything
#else
constexpr unsigned enough = 100000;
#endif

template <int dim>
Point to_point(const dealii::Point<dim>& x) {
    Point p{0, 0, 0};
    for (unsigned d = 0; d < dim; ++d) p[d] = x[d];
    return p;
}

/// Refines leaves near a sphere, and some at random.
template <int dim>
void refine(Triangulation<dim>& triangulation, int steps, unsigned seed) {
    std::mt19937 random(seed);
    for (int step = 0; step < steps; ++step) {
        for (const auto& c : triangulation.active_cell_iterators()) {
            dealii::Point<dim> middle;
            for (unsigned d = 0; d < dim; ++d) middle[d] = 0.5;
            const double off = std::abs(c->center().distance(middle) - 0.3);
            if (off < 0.5 * c->diameter() || random() % 12 == 0) c->set_refine_flag();
        }
        triangulation.execute_coarsening_and_refinement();
    }
}

/// A triangulation with an element and a vector on it.
template <int dim>
struct Problem {
    std::string name;
    std::unique_ptr<Triangulation<dim>> triangulation = std::make_unique<Triangulation<dim>>();
    std::unique_ptr<DoFHandler<dim>> dofs;
    dealii::AffineConstraints<double> constraints;
    DoubleVector values;

    void distribute(const dealii::FiniteElement<dim>& fe) {
        dofs = std::make_unique<DoFHandler<dim>>(*triangulation);
        dofs->distribute_dofs(fe);
        constraints.clear();
        dealii::DoFTools::make_hanging_node_constraints(*dofs, constraints);
        constraints.close();
        values.reinit(dofs->n_dofs());
    }

    /// Values of component 0 at vertices, by vertex index; then the constraints.
    void set(const std::vector<double>& at_vertices) {
        for (const auto& c : dofs->active_cell_iterators()) {
            for (const unsigned v : c->vertex_indices()) {
                values(c->vertex_dof_index(v, 0)) = at_vertices[c->vertex_index(v)];
            }
        }
        constraints.distribute(values);
    }

    /// Solves Laplace's equation with the values of a function on the boundary.
    void solve_laplace(const dealii::Function<dim>& on_boundary) {
        constraints.clear();
        dealii::DoFTools::make_hanging_node_constraints(*dofs, constraints);
        dealii::VectorTools::interpolate_boundary_values(*dofs, 0, on_boundary, constraints);
        constraints.close();
        dealii::DynamicSparsityPattern pattern(dofs->n_dofs());
        dealii::DoFTools::make_sparsity_pattern(*dofs, pattern, constraints);
        dealii::SparsityPattern sparsity;
        sparsity.copy_from(pattern);
        dealii::SparseMatrix<double> matrix(sparsity);
        DoubleVector rhs(dofs->n_dofs());
        const dealii::Function<dim>* const no_coefficient = nullptr;
        dealii::MatrixCreator::create_laplace_matrix(*dofs, dealii::QGauss<dim>(2), matrix,
                                                     dealii::Functions::ZeroFunction<dim>(), rhs,
                                                     no_coefficient, constraints);
        dealii::PreconditionSSOR<dealii::SparseMatrix<double>> preconditioner;
        preconditioner.initialize(matrix, 1.2);
        dealii::SolverControl control(1000, 1e-10 * rhs.l2_norm());
        dealii::SolverCG<DoubleVector>(control).solve(matrix, values, rhs, preconditioner);
        constraints.distribute(values);
    }

    std::vector<Point> vertices() const {
        std::vector<Point> x;
        for (const auto& v : triangulation->get_vertices()) x.push_back(to_point(v));
        return x;
    }
};

template <int dim>
std::vector<Problem<dim>> problems() {
    namespace make = dealii::GridGenerator;
    std::vector<Problem<dim>> result(4);
    result[0].name = "cube";
    make::subdivided_hyper_cube(*result[0].triangulation, 3);
    refine(*result[0].triangulation, 3, 1);
    result[1].name = "ball, curved";
    make::hyper_ball(*result[1].triangulation,
                     dim == 2 ? dealii::Point<dim>(0.5, 0.5) : dealii::Point<dim>(), 0.7);
    result[1].triangulation->refine_global(1);
    refine(*result[1].triangulation, 2, 2);
    result[2].name = "shell, curved";
    make::hyper_shell(*result[2].triangulation, dealii::Point<dim>(), 0.3, 1.0);
    refine(*result[2].triangulation, 3, 3);
    result[3].name = "simplices";
    make::subdivided_hyper_cube_with_simplices(*result[3].triangulation, 2);
    result[3].triangulation->refine_global(dim == 2 ? 3 : 2);
    for (auto& p : result) {
        if (p.triangulation->all_reference_cells_are_hyper_cube()) {
            p.distribute(FE_Q<dim>(1));
        } else {
            p.distribute(dealii::FE_SimplexP<dim>(1));
        }
    }
    return result;
}

template <int dim>
void expect_laws() {
    for (auto& p : problems<dim>()) {
        SCOPED_TRACE(p.name);
        const DealiiGrid<dim> grid(*p.triangulation);
        const DealiiField field(grid, *p.dofs, p.values);
        for (const auto& c : p.triangulation->cell_iterators()) {
            // Child k has corner k, which positions from mappings rely on.
            for (unsigned k = 0; c->has_children() && k < c->n_vertices(); ++k) {
                EXPECT_EQ(c->child(k)->vertex_index(k), c->vertex_index(k));
            }
        }
        for (const NodalSamples& samples : catching_fields(p.vertices(), 7)) {
            SCOPED_TRACE(samples.name);
            p.set(samples.values);
            CheckOptions options;
            options.hanging_values = true;
            expect_sound_grid(grid, field, options);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : six_thresholds) {
                expect_closed_level(grid, field, 0.0, indicator, threshold);
            }
        }
    }
}

TEST(Dealii, KeepsTheLawsInTwoDimensions) { expect_laws<2>(); }
TEST(Dealii, KeepsTheLawsInThreeDimensions) { expect_laws<3>(); }

template <int dim>
void expect_linear_functions() {
    for (auto& p : problems<dim>()) {
        if (p.name.find("curved") != std::string::npos) continue;
        std::vector<double> values;
        for (const Point& x : p.vertices()) values.push_back(slanted<dim>(x));
        p.set(values);
        const DealiiGrid<dim> grid(*p.triangulation);
        expect_linear_exact(grid, DealiiField(grid, *p.dofs, p.values));
    }
}
TEST(Dealii, ReproducesLinearFunctions) {
    expect_linear_functions<2>();
    expect_linear_functions<3>();
}

/// A vector-valued element of order two and a scalar of order one: every component is that of the
/// function at the vertices.
TEST(Dealii, ReadsComponentsOfSystems) {
    Triangulation<3> triangulation;
    dealii::GridGenerator::hyper_cube(triangulation);
    triangulation.refine_global(1);
    refine(triangulation, 2, 4);
    DoFHandler<3> dofs(triangulation);
    dofs.distribute_dofs(dealii::FESystem<3>(FE_Q<3>(2), 3, FE_Q<3>(1), 1));
    dealii::Vector<float> values(dofs.n_dofs());
    struct Function : dealii::Function<3, float> {
        Function() : dealii::Function<3, float>(4) {}
        float value(const dealii::Point<3>& x, unsigned c) const override {
            return static_cast<float>(c < 3 ? x[c] : x[0] * x[0] + x[1] * x[1]);
        }
    };
    dealii::VectorTools::interpolate(dofs, Function(), values);
    const DealiiGrid<3> grid(triangulation);
    const DealiiField<3, dealii::Vector<float>, 4> field(grid, dofs, values, {3, 0, 1, 2});
    const auto result = isosurface(grid, field, 0.5);
    const auto& s = result.surface;
    ASSERT_GT(s.vertices.size(), 50U);
    for (std::size_t v = 0; v < s.vertices.size(); ++v) {
        for (std::size_t d = 0; d < 3; ++d) {
            EXPECT_NEAR(s.attributes[3 * v + d], s.vertices[v][d], 1e-6);
        }
    }
}

/// The vertices that a mapping moves are where the surface goes.
TEST(Dealii, TakesPositionsFromTheMapping) {
    Problem<3> p = std::move(problems<3>()[0]);
    const auto radius = [](const Point& x) { return norm(x - Point{0.5, 0.5, 0.5}) - 0.3; };
    std::vector<double> values;
    for (const Point& x : p.vertices()) values.push_back(radius(x));
    p.set(values);
    DoFHandler<3> moved(*p.triangulation);
    const dealii::FESystem<3> fe(FE_Q<3>(1), 3);
    moved.distribute_dofs(fe);
    DoubleVector by(moved.n_dofs());
    for (const auto& c : moved.active_cell_iterators()) {
        for (const unsigned v : c->vertex_indices()) {
            by(c->vertex_dof_index(v, 1)) = 2 * c->vertex(v)[0];  // y + 2 x
        }
    }
    const dealii::MappingQ1Eulerian<3, DoubleVector> mapping(moved, by);
    const DealiiGrid<3> flat(*p.triangulation);
    const DealiiGrid<3> sheared(*p.triangulation, &mapping);
    const auto a = isosurface(flat, DealiiField(flat, *p.dofs, p.values), 0.0).surface;
    const auto b = isosurface(sheared, DealiiField(sheared, *p.dofs, p.values), 0.0).surface;
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    ASSERT_GT(a.vertices.size(), 100U);
    expect_closed(b);
    for (std::size_t v = 0; v < a.vertices.size(); ++v) {
        EXPECT_NEAR(b.vertices[v][0], a.vertices[v][0], 1e-12);
        EXPECT_NEAR(b.vertices[v][1], a.vertices[v][1] + 2 * a.vertices[v][0], 1e-12);
    }
}

/// Laplace's equation with a singularity at an edge that reenters, refined where Kelly's estimate
/// says.
TEST(Dealii, KeepsTheLawsOnASolution) {
    Problem<3> p;
    dealii::GridGenerator::hyper_L(*p.triangulation);
    p.triangulation->refine_global(3);
    dealii::Vector<float> kelly;
    const auto singular = [](const dealii::Point<3>& x) {
        const double phi = std::fmod(std::atan2(x[1], x[0]) + 5 * dealii::numbers::PI / 2,
                                     2 * dealii::numbers::PI);
        return std::pow(std::hypot(x[0], x[1]), 2.0 / 3) * std::sin(2 * phi / 3) + 0.2 * x[2];
    };
    for (;;) {
        p.distribute(FE_Q<3>(1));
        p.solve_laplace(dealii::ScalarFunctionFromFunctionObject<3>(singular));
        kelly.reinit(p.triangulation->n_active_cells());
        dealii::KellyErrorEstimator<3>::estimate(*p.dofs, dealii::QGauss<2>(2), {}, p.values,
                                                 kelly);
        if (p.triangulation->n_active_cells() > enough) break;
        dealii::GridRefinement::refine_and_coarsen_fixed_number(*p.triangulation, kelly, 0.25, 0.0);
        p.triangulation->execute_coarsening_and_refinement();
    }
    const DealiiGrid<3> grid(*p.triangulation);
    const DealiiField field(grid, *p.dofs, p.values);
    CheckOptions options;
    options.hanging_values = true;
    expect_sound_grid(grid, field, options);
    expect_closed_levels(grid, field, 0.5, 0.1);

    // The solver's own indicator: at its largest error one coarse surface, closed as the others.
    const HierarchicalIndicator own(grid, field, [&](const DealiiGrid<3>::Element& e) {
        return static_cast<double>(kelly(grid.leaf_index(e)));
    });
    std::size_t finest = 0;
    for (const double part : {0.0, 0.01, 0.1, 0.5, 1.01}) {
        const auto result =
            isosurface(grid, field, 0.5, under(own, part * kelly.linfty_norm()), {.verify = true});
        expect_closed(result.surface);
        if (part == 0) finest = result.surface.simplices.size();
        if (part > 1) {
            EXPECT_LT(result.surface.simplices.size(), finest / 20);
            EXPECT_GT(result.error_bound, 0);
        }
        EXPECT_LE(result.surface.simplices.size(), finest);
    }
}

TEST(Dealii, TellsThatConstraintsWereForgotten) {
    Problem<3> p = std::move(problems<3>()[0]);
    std::vector<double> values;
    for (const Point& x : p.vertices()) values.push_back(x[0] * x[0]);
    p.set(values);
    const DealiiGrid<3> grid(*p.triangulation);
    const DealiiField field(grid, *p.dofs, p.values);
    EXPECT_LT(HierarchicalIndicator(grid, field).hanging_violation(), 1e-15);
    ASSERT_GT(p.constraints.n_constraints(), 10U);
    const auto hanging = p.constraints.get_lines().begin()->index;
    p.values(hanging) += 0.25;
    EXPECT_NEAR(HierarchicalIndicator(grid, field).hanging_violation(), 0.25, 1e-12);
}

TEST(Dealii, FollowsTheTriangulation) {
    Problem<3> p = std::move(problems<3>()[0]);
    const DealiiGrid<3> grid(*p.triangulation);
    const auto set = [&] {
        std::vector<double> values;
        for (const Point& x : p.vertices()) values.push_back(norm(x));
        p.set(values);
    };
    set();
    const DealiiField field_before(grid, *p.dofs, p.values);
    const HierarchicalIndicator before(grid, field_before);
    refine(*p.triangulation, 1, 9);
    p.distribute(FE_Q<3>(1));
    set();
    const DealiiField field(grid, *p.dofs, p.values);
    EXPECT_THROW(isosurface(grid, field, 0.5, under(before, 0)), GridError);
    EXPECT_EQ(refusal<GridError>([&] { isosurface(grid, field_before, 0.5); }),
              "the grid has changed since the field was made for it: make another one");
    p.values.reinit(p.values.size() + 1);
    EXPECT_EQ(refusal<GridError>([&] { isosurface(grid, field, 0.5); }),
              "the vector or the degrees of freedom have changed since the field was made for "
              "them: make another one");
    p.values.reinit(p.values.size() - 1);
    set();
    expect_sound_grid(grid, field);
    expect_closed_levels(grid, field, 0.5, 0.1);
}

/// Also where an adapter is made anew, which was told of no change.
TEST(Dealii, RefusesWhatWasMadeBeforeAChange) {
    Problem<3> p = std::move(problems<3>()[0]);
    const auto set = [&] {
        std::vector<double> values;
        for (const Point& x : p.vertices()) values.push_back(norm(x) - 0.4);
        p.set(values);
    };
    set();
    const DealiiGrid<3> grid(*p.triangulation);
    const DealiiField field(grid, *p.dofs, p.values);
    MadeOnce<DealiiGrid<3>, std::remove_const_t<decltype(field)>> before(grid, field);
    refine(*p.triangulation, 1, 9);
    p.distribute(FE_Q<3>(1));
    set();
    const DealiiField finer(grid, *p.dofs, p.values);
    expect_refused_after_change(before, grid, finer);
    expect_usable(grid, finer);
    const DealiiGrid<3> anew(*p.triangulation);
    const DealiiField finer_anew(anew, *p.dofs, p.values);
    expect_refused_after_change(before, anew, finer_anew);
}

/// One bit a vertex beside the triangulation; extraction into a stream takes a constant.
TEST(Dealii, CopiesNothing) {
    std::array<std::size_t, 2> beside{};
    for (const int level : {4, 5}) {
        Triangulation<3> triangulation;
        dealii::GridGenerator::hyper_cube(triangulation);
        triangulation.refine_global(unsigned(level));
        DoFHandler<3> dofs(triangulation);
        dofs.distribute_dofs(FE_Q<3>(1));
        DoubleVector values(dofs.n_dofs());
        dealii::VectorTools::interpolate(dofs,
                                         dealii::ScalarFunctionFromFunctionObject<3>(
                                             [](const dealii::Point<3>& x) { return x.square(); }),
                                         values);
        { const DealiiGrid<3> first(triangulation); }  // rules are built once for the program
        const std::size_t start = allocated_bytes();
        const DealiiGrid<3> grid(triangulation);
        const DealiiField field(grid, dofs, values);
        EXPECT_LE(allocated_bytes() - start, triangulation.n_vertices() / 8 + 2048);
        const HierarchicalIndicator indicator(grid, field);
        double area = 0;
        const auto add = [&](const std::array<Point, 3>& x) {
            area += norm(cross(x[1] - x[0], x[2] - x[0])) / 2;
        };
        using Sink = SimplexStream<3>;
        const double isovalue = 0.5;
        const std::size_t calls = allocation_count();
        extract_isosurfaces(grid, field, std::span<const double>(&isovalue, 1),
                            std::vector<Sink>{Sink(add)},
                            under(Threshold{&indicator, 0}, indicator));
        beside[std::size_t(level - 4)] = allocation_count() - calls;
        EXPECT_NEAR(area, dealii::numbers::PI / 4, 0.01);
    }
    // A level more takes one more frame of the walk (walk.hpp), and eight times the cells nothing.
    constexpr std::size_t frame = 8;
    EXPECT_LE(beside[1], beside[0] + frame);
}

TEST(Dealii, RefusesWhatItCannotRead) {
    Problem<3> p = std::move(problems<3>()[0]);
    Problem<3> other = std::move(problems<3>()[0]);
    const DealiiGrid<3> grid(*p.triangulation);
    using Field = DealiiField<3, DoubleVector>;
    expect_refused([&] { Field(grid, *other.dofs, p.values); }, "another triangulation");
    const DoubleVector shorter(p.values.size() - 1);
    expect_refused([&] { Field(grid, *p.dofs, shorter); }, "entries for");
    expect_refused([&] { Field(grid, *p.dofs, p.values, {1}); }, "1 components and no number 1");
    DoFHandler<3> discontinuous(*p.triangulation);
    discontinuous.distribute_dofs(dealii::FE_DGQ<3>(1));
    const DoubleVector of_cells(discontinuous.n_dofs());
    const Field jumps(grid, discontinuous, of_cells);
    expect_refused([&] { (void)isosurface(grid, jumps, 0.1); },
                   "component 0 of FE_DGQ<3>(1) has no values at vertices: it is drawn within an "
                   "error");
    discontinuous.distribute_dofs(dealii::FE_DGQ<3>(0));
    const DoubleVector one_each(discontinuous.n_dofs());
    expect_refused([&] { Field(grid, discontinuous, one_each); }, "no nodal values at vertices");
    DoFHandler<3> hp(*p.triangulation);
    hp.distribute_dofs(dealii::hp::FECollection<3>(FE_Q<3>(1), dealii::FE_DGQ<3>(2)));
    const DoubleVector of_hp(hp.n_dofs());
    const Field jumps_hp(grid, hp, of_hp);
    expect_refused([&] { (void)isosurface(grid, jumps_hp, 0.1); }, "has no values at vertices");

    Triangulation<3> anisotropic;
    dealii::GridGenerator::hyper_cube(anisotropic);
    anisotropic.begin_active()->set_refine_flag(dealii::RefinementCase<3>::cut_x);
    anisotropic.execute_coarsening_and_refinement();
    expect_refused([&] { const DealiiGrid<3> refused(anisotropic); }, "in some directions only");
}

}  // namespace
