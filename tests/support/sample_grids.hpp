// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Coarse grids for tests, and one small set of them per family of hierarchies.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/adapters/prism_grid.hpp>
#include <nestgrid/adapters/red_green.hpp>
#include <nestgrid/optional.hpp>

namespace nestgrid_test {

using namespace nestgrid;

inline CoarseGrid hexahedra(int n) {
    CoarseGrid grid;
    std::vector<Point> x;
    for (int k = 0; k <= n; ++k) {
        for (int j = 0; j <= n; ++j) {
            for (int i = 0; i <= n; ++i) x.push_back({1.0 * i / n, 1.0 * j / n, 1.0 * k / n});
        }
    }
    grid.nodes = Coordinates(std::move(x));
    for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                std::array<std::uint32_t, 8> of{};
                for (int c = 0; c < 8; ++c) {
                    of[static_cast<std::size_t>(c)] = static_cast<std::uint32_t>(
                        ((k + (c >> 2)) * (n + 1) + j + (c >> 1 & 1)) * (n + 1) + i + (c & 1));
                }
                grid.add(Shape::hexahedron, of);
            }
        }
    }
    return grid;
}

/// Kuhn's six tetrahedra in every cube.
inline CoarseGrid tetrahedra(int n) {
    const CoarseGrid cubes = hexahedra(n);
    CoarseGrid grid;
    grid.nodes = cubes.nodes;
    for (std::size_t e = 0; e < cubes.element_count(); ++e) {
        const auto of = cubes.element(e);
        std::array<unsigned, 3> order{0, 1, 2};
        do {
            std::array<std::uint32_t, 4> t{of[0], of[1U << order[0]], of[7U - (1U << order[2])],
                                           of[7]};
            grid.add(Shape::tetrahedron, t);
            std::array<Point, 4> x;
            for (std::size_t i = 0; i < 4; ++i) x[i] = grid.nodes[t[i]];
            if (measure(Shape::tetrahedron, x) < 0) {
                mirror(Shape::tetrahedron, grid.element(grid.element_count() - 1));
            }
        } while (std::next_permutation(order.begin(), order.end()));
    }
    return grid;
}

inline CoarseGrid quadrilaterals(int n) {
    CoarseGrid grid;
    grid.dimension = 2;
    std::vector<Point> x;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) x.push_back({1.0 * i / n, 1.0 * j / n, 0});
    }
    grid.nodes = Coordinates(std::move(x));
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (n + 1) + i);
            const auto row = static_cast<std::uint32_t>(n + 1);
            grid.add(Shape::quadrilateral, {a, a + 1, a + row, a + row + 1});
        }
    }
    return grid;
}

/// Every quadrilateral, or every second one, cut into two triangles.
inline CoarseGrid triangles(int n, bool mixed = false) {
    const CoarseGrid quads = quadrilaterals(n);
    CoarseGrid grid;
    grid.dimension = 2;
    grid.nodes = quads.nodes;
    for (std::size_t e = 0; e < quads.element_count(); ++e) {
        const auto of = quads.element(e);
        if (mixed && e % 2 == 0) {
            grid.add(Shape::quadrilateral, of);
            continue;
        }
        grid.add(Shape::triangle, {of[0], of[1], of[3]});
        grid.add(Shape::triangle, {of[0], of[3], of[2]});
    }
    return grid;
}

/// The surface of an octahedron: triangles in space, without a boundary.
inline CoarseGrid octahedron() {
    CoarseGrid grid;
    grid.dimension = 2;
    grid.nodes = Coordinates({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
    for (std::uint32_t i = 0; i < 8; ++i) {
        grid.add(Shape::triangle, {i & 1U, 2 + (i >> 1U & 1U), 4 + (i >> 2U)});
    }
    return grid;
}

/// The same grid with other node numbers, another order of the elements and moved inner nodes.
inline CoarseGrid shaken(const CoarseGrid& grid, unsigned seed, double amount) {
    std::mt19937 random(seed);
    std::vector<std::uint32_t> to(grid.nodes.size()), order(grid.element_count());
    std::iota(to.begin(), to.end(), 0U);
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(to.begin(), to.end(), random);
    std::shuffle(order.begin(), order.end(), random);
    std::uniform_real_distribution<double> move(-amount, amount);
    std::vector<Point> x(to.size());
    for (std::size_t i = 0; i < to.size(); ++i) {
        Point p = grid.nodes[i];
        for (std::size_t d = 0; d < 3; ++d) {
            const double by = move(random);
            if (p[d] > 1e-9 && p[d] < 1 - 1e-9) p[d] += by;
        }
        x[to[i]] = p;
    }
    CoarseGrid result;
    result.dimension = grid.dimension;
    result.nodes = Coordinates(std::move(x));
    for (const std::uint32_t e : order) {
        std::vector<std::uint32_t> of;
        for (const std::uint32_t n : grid.element(e)) of.push_back(to[n]);
        result.add(grid.shapes[e], of);
    }
    return result;
}

/// A family of hierarchies: the type of grid, and some to start from.
struct BisectionTriangles {
    using Grid = BisectionGrid<2>;
    static constexpr int steps = 2;  ///< refinements per level
    static std::vector<Grid> grids() {
        return {Grid(triangles(2)), Grid(shaken(triangles(3), 1, 0.05)), Grid(octahedron())};
    }
};
struct BisectionTetrahedra {
    using Grid = BisectionGrid<3>;
    static constexpr int steps = 3;
    static std::vector<Grid> grids() {
        return {Grid(tetrahedra(1)), Grid(shaken(tetrahedra(2), 2, 0.08))};
    }
};
struct RedGreenTriangles {
    using Grid = RedGreenSimplices<2>;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        return {Grid(triangles(2)), Grid(shaken(triangles(3), 3, 0.05)), Grid(octahedron())};
    }
};
struct RedGreenTetrahedra {
    using Grid = RedGreenSimplices<3>;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        return {Grid(tetrahedra(1)), Grid(shaken(tetrahedra(2), 4, 0.08))};
    }
};
struct RedGreenMixed2 {
    using Grid = RedGreenGrid<2>;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        return {Grid(quadrilaterals(2)), Grid(triangles(3, true)),
                Grid(shaken(triangles(4, true), 5, 0.04))};
    }
};
struct RedGreenMixed3 {
    using Grid = RedGreenGrid<3>;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        return {Grid(hexahedra(2)), Grid(shaken(hexahedra(3), 6, 0)), Grid(tetrahedra(1))};
    }
};
struct BalancedQuadtree {
    using Grid = OctreeGrid<2>;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        return {Grid(quadrilaterals(1)), Grid(shaken(quadrilaterals(3), 7, 0.05))};
    }
};
struct UnbalancedQuadtree {
    using Grid = OctreeGrid<2>;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        return {Grid(quadrilaterals(2), {.balanced = false}),
                Grid(shaken(quadrilaterals(3), 8, 0.05), {.balanced = false})};
    }
};
struct BalancedOctree {
    using Grid = OctreeGrid<3>;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        return {Grid(hexahedra(1)), Grid(shaken(hexahedra(2), 9, 0.05))};
    }
};
struct UnbalancedOctree {
    using Grid = OctreeGrid<3>;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        return {Grid(hexahedra(2), {.balanced = false}),
                Grid(shaken(hexahedra(2), 10, 0.05), {.balanced = false})};
    }
};
struct Prisms {
    using Grid = PrismGrid;
    static constexpr int steps = 1;
    static std::vector<Grid> grids() {
        const std::vector<double> layers{0.5, 0.2, 0.3};
        return {Grid(extrude(triangles(2), std::vector<double>{1.0})),
                Grid(extrude(shaken(triangles(2), 11, 0.1), layers))};
    }
};

/// Distance to a sphere around the middle of the unit cube (or square).
inline double to_sphere(const Point& x, int dimension) {
    return norm(x - Point{0.5, 0.5, dimension == 3 ? 0.5 : x[2]}) - 0.35;
}

/// Whether a leaf's centre is nearer to that sphere than so many times its radius.
inline bool near_sphere(const Leaf& leaf, int dimension, double times = 1) {
    double size = 0;
    for (const Point& x : leaf.corners) size = std::max(size, norm(x - leaf.centre()));
    return std::abs(to_sphere(leaf.centre(), dimension)) < times * size;
}

/// One step of refinement at the sphere, of leaves that have less than `levels` levels.
template <class Grid>
void refine_at_sphere_once(Grid& grid, int levels) {
    grid.adapt([&](const Leaf& leaf) {
        return leaf.level < levels && near_sphere(leaf, Grid::dimension) ? Mark::refine
                                                                         : Mark::keep;
    });
}

/// Refines the leaves at the sphere until they have `levels` levels.
template <class Grid>
void refine_at_sphere(Grid& grid, int levels) {
    for (int level = 0; level < levels; ++level) refine_at_sphere_once(grid, levels);
}

/// Values of a function at all nodes.
template <class Grid, class Function>
std::vector<double> sample_nodes(const Grid& grid, Function&& f) {
    std::vector<double> values;
    for (const Point& x : grid.node_positions()) values.push_back(f(x));
    return values;
}

/// Refines everything once, then leaves at random, one in `rarity`, until there are enough of them;
/// neighbours differ by several levels where the family allows it.
template <class Grid>
void refine_at_random(Grid& grid, std::mt19937& random, int rounds, int finest, unsigned rarity,
                      std::size_t enough) {
    for (int i = 0; i < rounds && grid.leaf_count() < enough; ++i) {
        [[maybe_unused]] const auto way = random() % 4;
        try {
            grid.adapt([&](const Leaf& leaf) {
                if (leaf.level >= finest || (i > 0 && random() % rarity != 0)) return Mark::keep;
                if constexpr (std::is_same_v<Grid, PrismGrid>) {
                    const std::array marks{Mark::refine, Mark::refine_horizontally,
                                           Mark::refine_vertically};
                    return marks[(way == 3 ? random() : way) % 3];
                } else {
                    return Mark::refine;
                }
            });
        } catch (const InvalidInput&) {  // prisms refuse some mixtures of directions
        }
    }
}

}  // namespace nestgrid_test
