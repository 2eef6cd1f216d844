// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A complete adapter: docs/write_an_adapter.md quotes this file part by part.
// [solver]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <vector>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/standard_rules.hpp>

struct Solver {
    struct Cell {
        std::array<std::size_t, 8> vertex{};  // x fastest, then y, then z
        std::size_t first_child = 0;          // of eight in a row; 0 where it is not divided
    };
    std::vector<Cell> cells;  // the coarse ones first
    std::size_t coarse_cells = 0;
    std::vector<std::array<double, 3>> vertices;
    std::vector<double> u;  // the solution, at the vertices
};

// A cube, divided until cells near one corner have 1/64 of its size, and a gyroid for a solution.
Solver solve() {
    Solver solver;
    std::map<std::array<double, 3>, std::size_t> known;
    const auto cell_at = [&](const std::array<double, 3>& low, double size) {
        Solver::Cell cell;
        for (unsigned k = 0; k < 8; ++k) {
            const double x = low[0] + size * (k & 1U);
            const double y = low[1] + size * (k >> 1U & 1U);
            const double z = low[2] + size * (k >> 2U);
            const auto [vertex, is_new] = known.try_emplace({x, y, z}, known.size());
            cell.vertex[k] = vertex->second;
            if (!is_new) continue;
            solver.vertices.push_back({x, y, z});
            solver.u.push_back(std::sin(5 * x) * std::cos(5 * y) +
                               std::sin(5 * y) * std::cos(5 * z) +
                               std::sin(5 * z) * std::cos(5 * x));
        }
        solver.cells.push_back(cell);
    };
    cell_at({0, 0, 0}, 1);
    solver.coarse_cells = 1;
    for (std::size_t i = 0; i < solver.cells.size(); ++i) {
        const auto low = solver.vertices[solver.cells[i].vertex[0]];
        const double half = 0.5 * (solver.vertices[solver.cells[i].vertex[1]][0] - low[0]);
        const double distance = std::hypot(1 - low[0], 1 - low[1], 1 - low[2]);
        if (half <= std::max(1.0 / 128, 0.03 * distance)) continue;
        solver.cells[i].first_child = solver.cells.size();
        for (unsigned c = 0; c < 8; ++c) {
            cell_at({low[0] + half * (c & 1U), low[1] + half * (c >> 1U & 1U),
                     low[2] + half * (c >> 2U)},
                    half);
        }
    }
    return solver;
}
// [solver]

// [grid]
class SolverGrid {
public:
    using Element = std::size_t;  // any small value that finds the cell again
    static constexpr int dimension = 3;

    explicit SolverGrid(const Solver& solver) : solver_{&solver} {}

    std::size_t coarse_count() const { return solver_->coarse_cells; }

    nestgrid::CoarseElement<Element> coarse(std::size_t i) const {
        nestgrid::CoarseElement<Element> result;
        result.element = i;
        result.shape = nestgrid::Shape::hexahedron;
        for (std::size_t k = 0; k < 8; ++k) {
            const std::size_t vertex = solver_->cells[i].vertex[k];
            result.corners[k] = solver_->vertices[vertex];
            result.ids[k] = vertex;  // the same from each coarse cell that has the vertex
        }
        return result;
    }
    const nestgrid::Rule* split(const Element& e) const {
        return solver_->cells[e].first_child == 0 ? nullptr : rule_;  // nullptr: not divided
    }
    void children(const Element& e, std::span<Element> out) const {
        for (std::size_t c = 0; c < 8; ++c) out[c] = solver_->cells[e].first_child + c;
    }

    const Solver& solver() const { return *solver_; }

private:
    const Solver* solver_;
    const nestgrid::Rule* rule_ = &nestgrid::dyadic_rule(nestgrid::Shape::hexahedron);
};
// [grid]

// [field]
class SolverField {
public:
    using value_type = double;

    explicit SolverField(const SolverGrid& grid) : grid_{&grid} {}

    nestgrid::NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        for (std::size_t k = 0; k < 8; ++k) out[k] = value(i, k);
        return 0;  // no value is missing
    }
    nestgrid::NodeMask new_values(std::size_t e, nestgrid::NodeMask which,
                                  std::span<double> out) const {
        const nestgrid::Rule& rule = *grid_->split(e);
        for (std::size_t n = 0; n < rule.new_corner.size(); ++n) {
            if ((which >> n & 1U) == 0) continue;
            const auto [child, corner] = rule.new_corner[n];  // new node n is a corner there
            out[n] = value(grid_->solver().cells[e].first_child + child, corner);
        }
        return 0;
    }

private:
    double value(std::size_t cell, std::size_t corner) const {
        const Solver& solver = grid_->solver();
        return solver.u[solver.cells[cell].vertex[corner]];
    }
    const SolverGrid* grid_;
};
// [field]

// [use]
void write_obj(const nestgrid::Surface<3>& surface, const char* path) {
    std::ofstream file(path);
    for (const auto& [x, y, z] : surface.vertices)
        file << "v " << x << ' ' << y << ' ' << z << '\n';
    for (const auto& [a, b, c] : surface.simplices) {
        file << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
    }
}

int main() {
    const Solver solver = solve();
    const SolverGrid grid(solver);
    const SolverField field(grid);
    if (const auto violation = nestgrid::check_grid(grid, field)) {
        std::fprintf(stderr, "%s\n", violation->sentence.c_str());
        return 1;
    }
    std::printf("%zu cells\n", solver.cells.size());
    for (const double threshold : {0.02, 0.0}) {
        const auto result = nestgrid::isosurface(grid, field, 0.0, {.threshold = threshold});
        const auto report = nestgrid::surface_report(result.surface);
        std::printf("threshold %.2f: %zu triangles, %zu open edges, |U| <= %.2f on them\n",
                    threshold, report.triangles, std::size_t(report.open_edges),
                    result.error_bound);
        write_obj(result.surface, "own_grid.obj");
    }
}
// [use]
