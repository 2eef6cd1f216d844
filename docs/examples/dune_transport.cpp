// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Dune: salt in the ground water that flows over a salt dome, by linear finite elements with
// streamline diffusion. For each of several tolerances the tetrahedra of a UGGrid are refined, red
// and green, where the solution is curved, and the isosurface u = 0.5 is extracted straight from
// the solver's vector: nothing is copied.
//     dune_transport [tolerances] [folder for the last surface]
// The solution is known. The order is that of its error in L2 against the number of unknowns to the
// power of -1/3, and should be 2. It is taken over two tolerances, since a quarter of a tolerance
// is one level more.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <dune/common/fmatrix.hh>
#include <dune/common/parallel/mpihelper.hh>
#include <dune/geometry/quadraturerules.hh>
#include <dune/grid/uggrid.hh>
#include <dune/grid/utility/structuredgridfactory.hh>
#include <dune/istl/bcrsmatrix.hh>
#include <dune/istl/bvector.hh>
#include <dune/istl/matrixindexset.hh>
#include <dune/istl/operators.hh>
#include <dune/istl/preconditioners.hh>
#include <dune/istl/solvers.hh>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/adapters/dune_fields.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

namespace {

using UG = Dune::UGGrid<3>;
using Element = UG::Codim<0>::Entity;
using Point = Dune::FieldVector<double, 3>;
using Matrix = Dune::BCRSMatrix<double>;
using Vector = Dune::BlockVector<double>;

constexpr unsigned coarse_cubes = 4;  // along each side of the domain, six tetrahedra in each
constexpr double diffusion = 0.01;
constexpr std::size_t most_unknowns = 150'000;
constexpr double least_order = 1.8;

/// The solution: a dome of salt on the bottom of the unit cube, with a front of finite width.
struct Exact {
    static constexpr double radius = 0.4;
    static constexpr double width = 0.1;
    Point from_centre;
    double t;

    explicit Exact(const Point& x) : from_centre{x[0] - 0.5, x[1] - 0.5, x[2]} {
        t = std::tanh((radius * radius - from_centre.two_norm2()) / (2 * radius * width));
    }
    double value() const { return (1 + t) / 2; }
    Point gradient() const {
        Point g = from_centre;
        return g *= (t * t - 1) / (2 * radius * width);
    }
    double laplacian() const {
        const double steep = from_centre.two_norm2() / (radius * width);
        return (t * t - 1) / (2 * radius * width) * (3 + 2 * t * steep);
    }
};

/// Of the water; free of sources.
Point velocity(const Point& x) { return {1, x[0] - 0.5, 0.25}; }

double source(const Point& x) {
    const Exact u(x);
    return velocity(x) * u.gradient() - diffusion * u.laplacian();
}

/// A tetrahedron: its vertices, and the gradients of the four functions that are 1 at one of them.
struct Linear {
    std::array<std::size_t, 4> vertex;
    std::array<Point, 4> gradient;

    Linear(const UG& grid, const Element& e) {
        gradient[0] = 0;
        for (unsigned i = 0; i < 4; ++i) {
            vertex[i] = grid.leafIndexSet().subIndex(e, i, 3);
            if (i == 0) continue;
            Point axis(0);
            axis[i - 1] = 1;
            e.geometry().jacobianInverseTransposed({}).mv(axis, gradient[i]);
            gradient[0] -= gradient[i];
        }
    }
    static double value(std::size_t i, const Point& local) {
        return i == 0 ? 1 - local[0] - local[1] - local[2] : local[i - 1];
    }
};

/// Calls f(local, x, weight) at points that integrate polynomials of degree 4.
template <class Function>
void for_each_point(const Element& e, const Function& f) {
    const auto geometry = e.geometry();
    for (const auto& p : Dune::QuadratureRules<double, 3>::rule(e.type(), 4)) {
        f(p.position(), geometry.global(p.position()),
          p.weight() * geometry.integrationElement(p.position()));
    }
}

/// Of the elements of a level; UG's green ones may be larger and copies are.
double width(int level) { return std::ldexp(1.0 / coarse_cubes, -level); }

class Transport {
public:
    void solve();
    double error() const;
    /// Refines the elements of the finest level where linear functions are off by the tolerance.
    /// UG cannot always do it if coarser ones are marked then.
    /// \return whether there were any
    /// \throw std::runtime_error where there are too many
    bool refine(double tolerance);

    std::unique_ptr<UG> grid = Dune::StructuredGridFactory<UG>::createSimplexGrid(
        Point(0), Point(1), {coarse_cubes, coarse_cubes, coarse_cubes});
    Vector solution;  // by leaf index of the vertex

private:
    void assemble(Matrix& matrix, Vector& rhs) const;
    void fix_boundary(Matrix& matrix, Vector& rhs) const;
    double curvature(const Element& e, const std::vector<Point>& gradients) const;
};

void Transport::assemble(Matrix& matrix, Vector& rhs) const {
    for (const auto& e : elements(grid->leafGridView())) {
        const Linear shape(*grid, e);
        const double h = std::cbrt(6 * e.geometry().volume());
        for_each_point(e, [&](const Point& local, const Point& x, double weight) {
            const Point b = velocity(x);
            const double f = source(x);
            const double upwind = 1 / (2 * b.two_norm() / h + 12 * diffusion / (h * h));
            for (std::size_t i = 0; i < 4; ++i) {
                const double test = Linear::value(i, local) + upwind * (b * shape.gradient[i]);
                rhs[shape.vertex[i]] += weight * f * test;
                for (std::size_t j = 0; j < 4; ++j) {
                    matrix[shape.vertex[i]][shape.vertex[j]] +=
                        weight * (diffusion * (shape.gradient[i] * shape.gradient[j]) +
                                  (b * shape.gradient[j]) * test);
                }
            }
        });
    }
}

void Transport::fix_boundary(Matrix& matrix, Vector& rhs) const {
    const auto view = grid->leafGridView();
    for (const auto& e : elements(view)) {
        for (const auto& side : intersections(view, e)) {
            if (!side.boundary()) continue;
            const auto corners = referenceElement(e.geometry());
            for (int k = 0; k < 3; ++k) {
                const int corner = corners.subEntity(side.indexInInside(), 1, k, 3);
                const std::size_t row = grid->leafIndexSet().subIndex(e, unsigned(corner), 3);
                matrix[row] = 0;
                matrix[row][row] = 1;
                rhs[row] = Exact(e.geometry().corner(corner)).value();
            }
        }
    }
}

void Transport::solve() {
    const auto n = static_cast<std::size_t>(grid->size(3));
    Dune::MatrixIndexSet pattern(n, n);
    for (const auto& e : elements(grid->leafGridView())) {
        const Linear shape(*grid, e);
        for (const std::size_t i : shape.vertex) {
            for (const std::size_t j : shape.vertex) pattern.add(i, j);
        }
    }
    Matrix matrix;
    pattern.exportIdx(matrix);
    matrix = 0;
    Vector rhs(n);
    rhs = 0;
    assemble(matrix, rhs);
    fix_boundary(matrix, rhs);

    solution.resize(n);
    solution = 0;
    Dune::MatrixAdapter<Matrix, Vector, Vector> linear(matrix);
    Dune::SeqILU<Matrix, Vector, Vector> preconditioner(matrix, 1.0);
    Dune::BiCGSTABSolver<Vector> solver(linear, preconditioner, 1e-10, 1000, 0);
    Dune::InverseOperatorResult result;
    solver.apply(solution, rhs, result);
    if (!result.converged) throw std::runtime_error("the linear solver did not converge");
}

double Transport::error() const {
    double square = 0;
    for (const auto& e : elements(grid->leafGridView())) {
        const Linear shape(*grid, e);
        for_each_point(e, [&](const Point& local, const Point& x, double weight) {
            double difference = -Exact(x).value();
            for (std::size_t i = 0; i < 4; ++i) {
                difference += solution[shape.vertex[i]] * Linear::value(i, local);
            }
            square += weight * difference * difference;
        });
    }
    return std::sqrt(square);
}

/// Of the solution, from the means of its gradients around vertices.
double Transport::curvature(const Element& e, const std::vector<Point>& gradients) const {
    const Linear shape(*grid, e);
    Dune::FieldMatrix<double, 3, 3> second(0);
    for (std::size_t i = 0; i < 4; ++i) {
        for (int d = 0; d < 3; ++d) {
            second[d].axpy(gradients[shape.vertex[i]][d], shape.gradient[i]);
        }
    }
    return second.frobenius_norm();
}

bool Transport::refine(double tolerance) {
    std::vector<Point> gradients(solution.size(), Point(0));
    std::vector<double> volumes(solution.size());
    for (const auto& e : elements(grid->leafGridView())) {
        const Linear shape(*grid, e);
        const double volume = e.geometry().volume();
        for (const std::size_t v : shape.vertex) {
            volumes[v] += volume;
            for (std::size_t i = 0; i < 4; ++i) {
                gradients[v].axpy(volume * solution[shape.vertex[i]], shape.gradient[i]);
            }
        }
    }
    for (std::size_t v = 0; v < volumes.size(); ++v) gradients[v] /= volumes[v];
    std::size_t marked = 0;
    const double square = width(grid->maxLevel()) * width(grid->maxLevel());
    for (const auto& e : elements(grid->leafGridView())) {
        if (e.level() < grid->maxLevel()) continue;
        if (square * curvature(e, gradients) > tolerance) marked += grid->mark(1, e) ? 1U : 0U;
    }
    if (solution.size() + marked > most_unknowns) {
        throw std::runtime_error("the tolerance needs too many tetrahedra");
    }
    grid->preAdapt();
    grid->adapt();
    grid->postAdapt();
    return marked > 0;
}

/// UG closes its grids by green tetrahedra: no node hangs.
struct Closed : nestgrid::DuneTraits<UG> {
    static constexpr bool conforming = true;
};

template <class Surface>
void write(const Surface& surface, const std::string& file) {
    const vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(nestgrid::make_poly_data(surface));
    writer->SetFileName(file.c_str());
    if (writer->Write() != 1 || writer->GetErrorCode() != 0) {
        throw std::runtime_error(file + " could not be written");
    }
}

void run(long tolerances, const std::string& folder) {
    std::printf(
        "tolerance tetrahedra unknowns   L2 error  order triangles open edges area error\n");
    std::vector<double> errors, unknowns;
    for (long row = 0; row < tolerances; ++row) {
        const double tolerance = std::ldexp(1.0, static_cast<int>(-row));
        Transport problem;
        do problem.solve();
        while (problem.refine(tolerance));
        errors.push_back(problem.error());
        unknowns.push_back(static_cast<double>(problem.solution.size()));

        // All there is to it: the grid, the field, the surface, as exact as the solution.
        const nestgrid::DuneGrid<UG, Closed> grid(*problem.grid);
        const nestgrid::DuneVertexField field(grid, problem.solution);
        const auto surface =
            nestgrid::isosurface(grid, field, 0.5, {.threshold = errors.back()}).surface;

        const auto report = nestgrid::surface_report(surface);
        const double exact_area = 2 * M_PI * Exact::radius * Exact::radius;
        std::printf("%9.4f %10d %8.0f %10.3e ", tolerance, problem.grid->size(0), unknowns.back(),
                    errors.back());
        double order = least_order;
        if (row < 2) std::printf("      ");
        if (row >= 2) {
            const auto before = static_cast<std::size_t>(row - 2);
            order = 3 * std::log(errors[before] / errors.back()) /
                    std::log(unknowns.back() / unknowns[before]);
            std::printf("%6.2f", order);
        }
        std::printf(" %9zu %10zu %9.2f%%\n", report.triangles, report.open_edges,
                    100 * std::abs(report.area / exact_area - 1));
        if (!(errors.back() < tolerance / 4)) {
            throw std::runtime_error("the error is more than a quarter of the tolerance");
        }
        if (report.open_edges > 0) throw std::runtime_error("the surface is open");
        if (!(order >= least_order)) {
            throw std::runtime_error("the error does not fall as it should: its order is below " +
                                     std::to_string(least_order));
        }
        if (!folder.empty() && row + 1 == tolerances) write(surface, folder + "/salt.vtp");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Dune::MPIHelper::instance(argc, argv);
    try {
        char* end = nullptr;
        const long tolerances = argc > 1 ? std::strtol(argv[1], &end, 10) : 6;
        const std::string folder = argc > 2 ? argv[2] : "";
        if (argc > 3)
            throw std::runtime_error("there are more arguments than [tolerances] [folder]");
        if (tolerances < 1 || (end != nullptr && *end != '\0')) {
            throw std::runtime_error(std::string("this is not a number of tolerances: ") + argv[1]);
        }
        if (argc > 2 && !std::filesystem::is_directory(folder)) {
            throw std::runtime_error("there is no folder " + folder);
        }
        run(tolerances, folder);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dune_transport: %s\n", e.what());
        return 1;
    }
    return 0;
}
