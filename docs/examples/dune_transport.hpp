// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solver of dune_transport.cpp, which knows nothing of nestgrid: linear finite elements with
// streamline diffusion on a UGGrid, refined where the solution is curved.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include <dune/common/fmatrix.hh>
#include <dune/geometry/quadraturerules.hh>
#include <dune/grid/uggrid.hh>
#include <dune/grid/utility/structuredgridfactory.hh>
#include <dune/istl/bcrsmatrix.hh>
#include <dune/istl/bvector.hh>
#include <dune/istl/matrixindexset.hh>
#include <dune/istl/operators.hh>
#include <dune/istl/preconditioners.hh>
#include <dune/istl/solvers.hh>

namespace dune_transport {

using Grid = Dune::UGGrid<3>;
using Element = Grid::Codim<0>::Entity;
using Point = Dune::FieldVector<double, 3>;
using Matrix = Dune::BCRSMatrix<double>;
using Vector = Dune::BlockVector<double>;

inline constexpr unsigned coarse_cubes =
    4;  // along each side of the domain, six tetrahedra in each
inline constexpr double diffusion = 0.01;
inline constexpr std::size_t most_unknowns = 150'000;

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
inline Point velocity(const Point& x) { return {1, x[0] - 0.5, 0.25}; }

inline double source(const Point& x) {
    const Exact u(x);
    return velocity(x) * u.gradient() - diffusion * u.laplacian();
}

/// A tetrahedron: its vertices, and the gradients of the four functions that are 1 at one of them.
struct Linear {
    std::array<std::size_t, 4> vertex;
    std::array<Point, 4> gradient;

    Linear(const Grid& grid, const Element& e) {
        gradient[0] = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            vertex[i] = grid.leafIndexSet().subIndex(e, static_cast<int>(i), 3);
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
inline double width(int level) { return std::ldexp(1.0 / coarse_cubes, -level); }

class Transport {
public:
    void solve();
    double error() const;
    /// Refines the elements of the finest level where linear functions are off by the tolerance.
    /// UG cannot always do it if coarser ones are marked then.
    /// \return whether there were any
    /// \throw std::runtime_error where there are too many
    bool refine(double tolerance);

    std::unique_ptr<Grid> grid = Dune::StructuredGridFactory<Grid>::createSimplexGrid(
        Point(0), Point(1), {coarse_cubes, coarse_cubes, coarse_cubes});
    Vector solution;  // by leaf index of the vertex

private:
    void assemble(Matrix& matrix, Vector& rhs) const;
    void fix_boundary(Matrix& matrix, Vector& rhs) const;
    double curvature(const Element& e, const std::vector<Point>& gradients) const;
};

inline void Transport::assemble(Matrix& matrix, Vector& rhs) const {
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

inline void Transport::fix_boundary(Matrix& matrix, Vector& rhs) const {
    const auto view = grid->leafGridView();
    for (const auto& e : elements(view)) {
        for (const auto& side : intersections(view, e)) {
            if (!side.boundary()) continue;
            const auto corners = referenceElement(e.geometry());
            for (int k = 0; k < 3; ++k) {
                const int corner = corners.subEntity(side.indexInInside(), 1, k, 3);
                const std::size_t row = grid->leafIndexSet().subIndex(e, corner, 3);
                matrix[row] = 0;
                matrix[row][row] = 1;
                rhs[row] = Exact(e.geometry().corner(corner)).value();
            }
        }
    }
}

inline void Transport::solve() {
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

inline double Transport::error() const {
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
inline double Transport::curvature(const Element& e, const std::vector<Point>& gradients) const {
    const Linear shape(*grid, e);
    Dune::FieldMatrix<double, 3, 3> second(0);
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t d = 0; d < 3; ++d) {
            second[d].axpy(gradients[shape.vertex[i]][d], shape.gradient[i]);
        }
    }
    return second.frobenius_norm();
}

inline bool Transport::refine(double tolerance) {
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

}  // namespace dune_transport
