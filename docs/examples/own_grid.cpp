// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A complete adapter for a format nobody has: docs/write_an_adapter.md goes through it.
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/standard_rules.hpp>

/// The solver's own: hexahedra in an array, the coarse ones first, each divided into eight or not.
struct Solver {
    struct Cell {
        std::array<int, 8> vertex{};  // x fastest, then y, then z
        int first_child = -1;         // of eight in a row; -1 where it is not divided
    };
    std::vector<Cell> cells;
    std::size_t coarse_cells = 0;
    std::vector<std::array<double, 3>> vertices;
    std::vector<double> u;  // at the vertices
};

// [adapter]
class SolverGrid {
public:
    using Element = int;  // any small value that finds the cell again
    static constexpr int dimension = 3;

    explicit SolverGrid(const Solver& solver)
        : solver_{&solver}, halving_{&nestgrid::dyadic_rule(nestgrid::Shape::hexahedron)} {}

    std::size_t coarse_count() const { return solver_->coarse_cells; }

    nestgrid::CoarseElement<Element> coarse(std::size_t i) const {
        nestgrid::CoarseElement<Element> result;
        result.element = static_cast<int>(i);
        result.shape = nestgrid::Shape::hexahedron;
        for (std::size_t k = 0; k < 8; ++k) {
            const int v = solver_->cells[i].vertex[k];
            result.corners[k] = solver_->vertices[static_cast<std::size_t>(v)];
            result.ids[k] = static_cast<std::uint64_t>(v);
        }
        return result;
    }
    const nestgrid::Rule* split(const Element& e) const {
        return cell(e).first_child < 0 ? nullptr : halving_;
    }
    void children(const Element& e, std::span<Element> out) const {
        for (std::size_t c = 0; c < 8; ++c) out[c] = cell(e).first_child + static_cast<int>(c);
    }

    const Solver::Cell& cell(Element e) const {
        return solver_->cells[static_cast<std::size_t>(e)];
    }
    const Solver& solver() const { return *solver_; }

private:
    const Solver* solver_;
    const nestgrid::Rule* halving_;
};

class SolverField {
public:
    using value_type = double;

    explicit SolverField(const SolverGrid& grid) : grid_{&grid} {}

    nestgrid::NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        for (std::size_t k = 0; k < 8; ++k) out[k] = value(static_cast<int>(i), k);
        return 0;  // nothing is missing
    }
    nestgrid::NodeMask new_values(int e, nestgrid::NodeMask which, std::span<double> out) const {
        const nestgrid::Rule& rule = *grid_->split(e);
        for (std::size_t n = 0; n < rule.new_corner.size(); ++n) {
            if ((which >> n & 1U) == 0) continue;
            const auto [child, corner] = rule.new_corner[n];  // where new node n is a corner
            out[n] = value(grid_->cell(e).first_child + child, corner);
        }
        return 0;
    }

private:
    double value(int e, std::size_t corner) const {
        return grid_->solver().u[static_cast<std::size_t>(grid_->cell(e).vertex[corner])];
    }
    const SolverGrid* grid_;
};
// [adapter]

namespace {

/// Divides a cell; vertices are found again by where they are, as this solver happens to do it.
void divide(Solver& solver, std::size_t at) {
    static std::map<std::array<double, 3>, int> known;
    if (known.empty()) {
        for (std::size_t v = 0; v < solver.vertices.size(); ++v) {
            known[solver.vertices[v]] = static_cast<int>(v);
        }
    }
    const std::array<double, 3> low =
        solver.vertices[static_cast<std::size_t>(solver.cells[at].vertex[0])];
    const std::array<double, 3> high =
        solver.vertices[static_cast<std::size_t>(solver.cells[at].vertex[7])];
    solver.cells[at].first_child = static_cast<int>(solver.cells.size());
    for (unsigned c = 0; c < 8; ++c) {
        Solver::Cell child;
        for (unsigned k = 0; k < 8; ++k) {
            std::array<double, 3> x;
            for (unsigned d = 0; d < 3; ++d) {
                const unsigned halves = (c >> d & 1U) + (k >> d & 1U);
                x[d] = low[d] + halves * 0.5 * (high[d] - low[d]);
            }
            const auto [entry, is_new] =
                known.try_emplace(x, static_cast<int>(solver.vertices.size()));
            if (is_new) solver.vertices.push_back(x);
            child.vertex[k] = entry->second;
        }
        solver.cells.push_back(child);
    }
}

double solution(const std::array<double, 3>& x) { return std::hypot(x[0], x[1], x[2]); }

Solver solve() {
    Solver solver;
    for (unsigned k = 0; k < 8; ++k) {
        solver.vertices.push_back({double(k & 1U), double(k >> 1U & 1U), double(k >> 2U & 1U)});
    }
    solver.cells.push_back({{0, 1, 2, 3, 4, 5, 6, 7}, -1});
    solver.coarse_cells = 1;
    for (std::size_t at = 0; at < solver.cells.size(); ++at) {  // finer around 0.7 from the origin
        const auto& vertex = solver.cells[at].vertex;
        const auto& low = solver.vertices[static_cast<std::size_t>(vertex[0])];
        const auto& high = solver.vertices[static_cast<std::size_t>(vertex[7])];
        const bool crosses = solution(low) < 0.7 && solution(high) > 0.7;
        if (crosses && high[0] - low[0] > 1.0 / 20) divide(solver, at);
    }
    for (const auto& x : solver.vertices) solver.u.push_back(solution(x));
    return solver;
}

}  // namespace

int main() {
    const Solver solver = solve();
    // [use]
    const SolverGrid grid(solver);
    const SolverField field(grid);
    if (const auto violation = nestgrid::check_grid(grid, field)) {
        std::fprintf(stderr, "%s\n", violation->sentence.c_str());
        return 1;
    }
    const auto result = nestgrid::isosurface(grid, field, 0.7, {.threshold = 0.001});
    // [use]
    const auto report = nestgrid::surface_report(result.surface);
    std::printf("%zu cells, %zu triangles, %zu open edges inside\n", solver.cells.size(),
                result.surface.simplices.size(), static_cast<std::size_t>(report.open_edges));
    return report.open_edges == 0 && !result.surface.simplices.empty() ? 0 : 1;
}
