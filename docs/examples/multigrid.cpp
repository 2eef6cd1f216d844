// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A small solver on nestgrid's own grid: geometric multigrid for -Laplace u = f with P1 elements on
// adaptively bisected tetrahedra. The isosurface of the solution is extracted in the solver loop,
// straight from its vector.
//
// Grids only grow here, so the nodes of every coarser level are the first ones of the finest, and
// what an adaptation reports (new nodes and their parents) is the prolongation.
#include <cmath>
#include <cstdio>
#include <map>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

using namespace nestgrid;

namespace {

using Vector = std::vector<double>;

// A steep front on a sphere, with the boundary values and the right-hand side it needs.
const Point centre{0.2, 0.3, 0.25};
constexpr double steepness = 20;
constexpr double radius = 0.5;

double exact(const Point& x) { return std::tanh(steepness * (norm(x - centre) - radius)); }
double right_hand_side(const Point& x) {
    const double r = std::max(norm(x - centre), 1e-12);
    const double t = std::tanh(steepness * (r - radius));
    const double slope = steepness * (1 - t * t);
    return 2 * steepness * t * slope - 2 / r * slope;  // minus u'' and 2 u' / r
}

/// The unit cube, cut into Kuhn's six tetrahedra.
CoarseGrid cube() {
    CoarseGrid grid;
    grid.nodes = Coordinates(
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}});
    grid.add(Shape::tetrahedron, {0, 1, 3, 7});
    grid.add(Shape::tetrahedron, {0, 3, 2, 7});
    grid.add(Shape::tetrahedron, {0, 2, 6, 7});
    grid.add(Shape::tetrahedron, {0, 6, 4, 7});
    grid.add(Shape::tetrahedron, {0, 4, 5, 7});
    grid.add(Shape::tetrahedron, {0, 5, 1, 7});
    return grid;
}

bool on_boundary(const Point& x) {
    return std::any_of(x.begin(), x.end(), [](double c) { return c == 0 || c == 1; });
}

/// One level: its stiffness matrix by rows, which nodes are fixed, and how it came about.
struct Level {
    struct Entry {
        std::uint32_t column;
        double value;
    };
    std::vector<std::size_t> row{0};
    std::vector<Entry> entry;
    Vector diagonal;
    std::vector<bool> fixed;
    Adaptation from_coarser;

    std::size_t size() const { return diagonal.size(); }

    double residual(std::size_t i, const Vector& u, const Vector& f) const {
        double r = f[i];
        for (std::size_t k = row[i]; k < row[i + 1]; ++k) r -= entry[k].value * u[entry[k].column];
        return r;
    }
    void smooth(Vector& u, const Vector& f, bool forward) const {
        for (std::size_t k = 0; k < size(); ++k) {
            const std::size_t i = forward ? k : size() - 1 - k;
            if (!fixed[i]) u[i] += residual(i, u, f) / diagonal[i];
        }
    }
};

/// Assembles the matrix of a grid and its load.
Level assemble(const BisectionGrid<3>& grid, Vector& load) {
    const std::vector<Point> x = grid.node_positions();
    std::vector<std::map<std::uint32_t, double>> rows(x.size());
    load.assign(x.size(), 0);
    grid.for_each_leaf([&](const Leaf& leaf) {
        // Gradients of the four basis functions, times six volumes.
        std::array<Point, 4> gradient;
        for (std::size_t i = 0; i < 4; ++i) {
            const Point& a = leaf.corners[(i + 1) % 4];
            const Point normal =
                cross(leaf.corners[(i + 2) % 4] - a, leaf.corners[(i + 3) % 4] - a);
            gradient[i] = dot(normal, leaf.corners[i] - a) > 0 ? normal : -1.0 * normal;
        }
        const double volume = std::abs(measure(leaf.shape, leaf.corners));
        for (std::size_t i = 0; i < 4; ++i) {
            load[leaf.nodes[i]] += volume / 4 * right_hand_side(leaf.corners[i]);
            for (std::size_t k = 0; k < 4; ++k) {
                rows[leaf.nodes[i]][leaf.nodes[k]] += dot(gradient[i], gradient[k]) / (36 * volume);
            }
        }
    });
    Level level;
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (const auto& [column, value] : rows[i]) level.entry.push_back({column, value});
        level.row.push_back(level.entry.size());
        level.diagonal.push_back(rows[i].at(static_cast<std::uint32_t>(i)));
        level.fixed.push_back(on_boundary(x[i]));
    }
    return level;
}

/// One V-cycle with two Gauss-Seidel sweeps before and after.
void cycle(const std::vector<Level>& levels, std::size_t at, Vector& u, const Vector& f) {
    const Level& level = levels[at];
    if (at == 0) {
        for (int i = 0; i < 20; ++i) level.smooth(u, f, true);
        return;
    }
    for (int i = 0; i < 2; ++i) level.smooth(u, f, true);
    // Restriction is the transpose of the prolongation: every node hands half to its parents.
    Vector r(level.size());
    for (std::size_t i = 0; i < level.size(); ++i) {
        r[i] = level.fixed[i] ? 0 : level.residual(i, u, f);
    }
    const Adaptation& p = level.from_coarser;
    for (std::size_t i = p.created.size(); i-- > 0;) {
        for (std::size_t k = p.first_parent[i]; k < p.first_parent[i + 1]; ++k) {
            r[p.parent[k]] += 0.5 * r[p.created[i]];
        }
    }
    r.resize(levels[at - 1].size());
    Vector correction(r.size(), 0);
    cycle(levels, at - 1, correction, r);
    p.interpolate(correction, level.size());
    for (std::size_t i = 0; i < level.size(); ++i) {
        if (!level.fixed[i]) u[i] += correction[i];
    }
    for (int i = 0; i < 2; ++i) level.smooth(u, f, false);
}

double residual_norm(const Level& level, const Vector& u, const Vector& f) {
    double sum = 0;
    for (std::size_t i = 0; i < level.size(); ++i) {
        if (!level.fixed[i]) sum += std::pow(level.residual(i, u, f), 2);
    }
    return std::sqrt(sum);
}

}  // namespace

int main() {
    BisectionGrid<3> grid(cube());
    Vector u(grid.node_count(), 0);
    std::vector<Level> levels;
    Adaptation step;
    std::printf("%9s %9s %7s %10s %8s %10s %6s\n", "elements", "nodes", "cycles", "max error",
                "order", "triangles", "open");
    double last_error = 0;
    double last_nodes = 0;
    for (int refinement = 0; refinement <= 18; ++refinement) {
        Vector f;
        Level level = assemble(grid, f);
        level.from_coarser = std::move(step);
        levels.push_back(std::move(level));
        const std::vector<Point> x = grid.node_positions();
        for (std::size_t i = 0; i < u.size(); ++i) {
            if (levels.back().fixed[i]) u[i] = exact(x[i]);
        }
        int cycles = 0;
        Vector zero(u.size(), 0);
        for (std::size_t i = 0; i < u.size(); ++i) zero[i] = levels.back().fixed[i] ? u[i] : 0;
        const double start = residual_norm(levels.back(), zero, f);
        while (cycles < 50 && residual_norm(levels.back(), u, f) > 1e-8 * start) {
            cycle(levels, levels.size() - 1, u, f);
            ++cycles;
        }
        double error = 0;
        for (std::size_t i = 0; i < u.size(); ++i) {
            error = std::max(error, std::abs(u[i] - exact(x[i])));
        }

        if (refinement % 3 == 0 && refinement >= 6) {
            // [visualize] The solver's own vector is the field; nothing is copied.
            const NodeField<BisectionGrid<3>, double> field(grid, u);
            const auto surface = isosurface(grid, field, 0.0, {.threshold = 0.02}).surface;
            // [visualize]
            const SurfaceReport report = surface_report(surface);
            const auto nodes = static_cast<double>(grid.used_node_count());
            const double order =
                last_nodes > 0 ? 3 * std::log(last_error / error) / std::log(nodes / last_nodes)
                               : 0;
            std::printf("%9zu %9zu %7d %10.2e %8.2f %10zu %6zu\n", grid.leaf_count(),
                        grid.used_node_count(), cycles, error, order, report.triangles,
                        report.open_edges);
            last_error = error;
            last_nodes = nodes;
            if (cycles > 10 || report.open_edges > 0) return 1;
        }
        if (refinement == 18) break;
        // Refine where the offset of a node from the mean of its parents is large (section 4.1).
        const double tolerance = 2.0 * std::pow(0.5, refinement / 3.0);
        step = grid.adapt([&](const Leaf& leaf) {
            double least = 1e30;
            double greatest = -1e30;
            for (const std::uint32_t node : leaf.nodes) {
                least = std::min(least, u[node]);
                greatest = std::max(greatest, u[node]);
            }
            return refinement < 9 || greatest - least > tolerance ? Mark::refine : Mark::keep;
        });
        step.interpolate(u, grid.node_count());
    }
    return last_error < 0.05 ? 0 : 1;
}
