// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Colours, views, coarse grids and data of the figures.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/algorithms/surface.hpp>

#include "bucky_ball.hpp"
#include "picture.hpp"

namespace figures {

using namespace nestgrid;

inline constexpr Colour sand{0.93, 0.85, 0.70};
inline constexpr Colour red{0.85, 0.10, 0.10};
inline constexpr Colour blue{0.10, 0.35, 0.75};
inline constexpr Colour grey{0.70, 0.73, 0.78};

/// From blue over green to yellow; t between 0 and 1.
inline Colour ramp(double t) {
    static constexpr std::array<Colour, 4> stop{
        Colour{0.29, 0.33, 0.65}, {0.16, 0.58, 0.65}, {0.40, 0.78, 0.45}, {0.96, 0.86, 0.30}};
    const double at = std::clamp(t, 0.0, 1.0) * 3;
    const auto i = std::min(static_cast<std::size_t>(at), std::size_t{2});
    Colour c{};
    for (std::size_t d = 0; d < 3; ++d) {
        c[d] = stop[i][d] + (at - static_cast<double>(i)) * (stop[i + 1][d] - stop[i][d]);
    }
    return c;
}

/// From blue over violet to red.
inline Colour hot(double t) { return {0.10 + 0.75 * t, 0.25 * (1 - t), 0.75 * (1 - t) + 0.1}; }

/// \param colour_of called with the number of each triangle
template <class ColourOf>
void draw(Picture& picture, const Surface<3>& surface, bool edges, const ColourOf& colour_of) {
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const auto& [a, b, c] = surface.simplices[t];
        picture.triangle({surface.vertices[a], surface.vertices[b], surface.vertices[c]},
                         colour_of(t), edges);
    }
}

inline void draw(Picture& picture, const Surface<2>& lines, const Colour& colour, double width) {
    for (const auto& [a, b] : lines.simplices) {
        picture.line(lines.vertices[a], lines.vertices[b], colour, width);
    }
}

/// Draws a circle across the z axis.
inline void draw_circle(Picture& picture, const Point& centre, double radius) {
    constexpr int sides = 90;
    const auto at = [&](int i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        return centre + radius * Point{std::cos(angle), std::sin(angle), 0};
    };
    for (int i = 0; i < sides; ++i) picture.line(at(i), at(i + 1), red, 2.5);
}

/// The colour of the level of the element that a triangle comes from.
inline auto by_level(const Surface<3>& surface) {
    const auto [least, most] = std::ranges::minmax(surface.level_of);
    return [&surface, least = least, range = std::max(most - least, 1)](std::size_t t) {
        return ramp(double(surface.level_of[surface.element_of[t]] - least) / range);
    };
}

/// The square or the cube between -1 and 1.
inline CoarseGrid box(int dimension) {
    CoarseGrid grid;
    grid.dimension = dimension;
    std::vector<Point> corners;
    for (unsigned k = 0; k < 1U << dimension; ++k) {
        corners.push_back({k & 1U ? 1.0 : -1.0, k & 2U ? 1.0 : -1.0,
                           dimension == 2 ? 0.0
                           : k & 4U       ? 1.0
                                          : -1.0});
    }
    grid.nodes = Coordinates(std::move(corners));
    if (dimension == 2) {
        grid.add(Shape::quadrilateral, {0, 1, 2, 3});
    } else {
        grid.add(Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7});
    }
    return grid;
}

inline CoarseGrid two_triangles() {
    CoarseGrid grid = box(2);
    CoarseGrid cut;
    cut.dimension = 2;
    cut.nodes = grid.nodes;
    cut.add(Shape::triangle, {0, 1, 3});
    cut.add(Shape::triangle, {0, 3, 2});
    return cut;
}

/// Kuhn's six tetrahedra in the cube between -1 and 1.
inline CoarseGrid six_tetrahedra() {
    const CoarseGrid cube = box(3);
    CoarseGrid cut;
    cut.nodes = cube.nodes;
    for (const auto& [a, b] :
         {std::pair(1U, 3U), {3U, 2U}, {2U, 6U}, {6U, 4U}, {4U, 5U}, {5U, 1U}}) {
        cut.add(Shape::tetrahedron, {0, a, b, 7});
    }
    return cut;
}

/// Refines uniformly, then wherever the mean of the corner values of a leaf misses the value at its
/// centre by more than the tolerance.
template <class Grid, class Function>
void refine(Grid& grid, const Function& u, int uniformly, int adaptively, double tolerance) {
    for (int step = 0; step < uniformly; ++step) grid.refine_uniformly();
    for (int step = 0; step < adaptively; ++step) {
        grid.adapt([&](const Leaf& leaf) {
            double mean = 0;
            for (const Point& x : leaf.corners) mean += u(x) / double(leaf.corners.size());
            return std::abs(mean - u(leaf.centre())) > tolerance ? Mark::refine : Mark::keep;
        });
    }
}

template <class Grid, class Function>
std::vector<double> values(const Grid& grid, const Function& u) {
    std::vector<double> result;
    for (const Point& x : grid.node_positions()) result.push_back(u(x));
    return result;
}

/// Draws the edges of the leaves of a grid of dimension 2.
template <class Grid>
void draw_leaves(Picture& picture, const Grid& grid) {
    grid.for_each_leaf([&](const Leaf& leaf) {
        const Topology& t = topology(leaf.shape);
        for (std::size_t i = 0; i < t.edges; ++i) {
            picture.line(leaf.corners[t.edge[i][0]], leaf.corners[t.edge[i][1]], grey, 0.8);
        }
    });
}

/// Draws where the leaves of an octree meet the plane z = height.
inline void draw_slice(Picture& picture, const OctreeGrid<3>& grid, double height) {
    grid.for_each_leaf([&](const Leaf& leaf) {
        const Point low = leaf.corners.front();
        const Point high = leaf.corners.back();
        if (height < low[2] || height >= high[2]) return;
        const std::array<Point, 4> loop{Point{low[0], low[1], height},
                                        {high[0], low[1], height},
                                        {high[0], high[1], height},
                                        {low[0], high[1], height}};
        for (std::size_t i = 0; i < 4; ++i) picture.line(loop[i], loop[(i + 1) % 4], grey, 0.8);
    });
}

/// Two linked rings: negative inside.
inline double rings(const Point& x) {
    const auto ring = [](double along, double across, double height) {
        return std::hypot(std::hypot(along, across) - 0.5, height) - 0.17;
    };
    return std::min(ring(x[0] + 0.25, x[1], x[2]), ring(x[0] - 0.25, x[2], x[1]));
}

/// Hills and hollows over the square.
inline double hills(const Point& x) {
    const auto hill = [&x](double a, double b, double steep) {
        return std::exp(-steep * (std::pow(x[0] - a, 2) + std::pow(x[1] - b, 2)));
    };
    return hill(0.45, 0.4, 25) + 0.7 * hill(-0.4, -0.5, 5) - 0.8 * hill(-0.5, 0.5, 8) -
           0.5 * hill(0.6, -0.5, 12);
}

/// A few drops of different size: positive inside.
inline double drops(const Point& x) {
    static constexpr std::array<std::array<double, 4>, 7> drop{{{-0.45, 0.35, 0.2, 0.34},
                                                                {0.4, -0.4, 0.25, 0.38},
                                                                {-0.3, -0.45, -0.3, 0.28},
                                                                {0.35, 0.4, -0.35, 0.25},
                                                                {0.6, 0.3, 0.5, 0.14},
                                                                {-0.7, -0.1, 0.65, 0.12},
                                                                {-0.05, 0.1, -0.65, 0.16}}};
    double nearest = -2;
    for (const auto& [a, b, c, r] : drop) nearest = std::max(nearest, r - norm(x - Point{a, b, c}));
    return nearest;
}

inline const View from_above{.towards_eye = {-1, -2, 1.6}, .up = {0, 0, 1}, .height = 2.1};
inline const View ball{
    .towards_eye = {1.1, 1.5, 0.7}, .up = {0, 0, 1}, .centre = {32, 32, 32}, .height = 64};
inline const View plane{.height = 2.06};

/// Draws a surface of the bucky ball into one of the picture's views.
inline void draw_ball(Picture& picture, int view, const Surface<3>& surface) {
    picture.look(view, ball);
    draw(picture, surface, true, [](std::size_t) { return sand; });
}

/// The samples of the bucky ball with 65 a side, and their hierarchy of tetrahedra.
struct Bucky {
    LatticeBisection<3> grid{{.samples = {65, 65, 65}}};
    std::vector<float> samples = bucky_ball(65);
    LatticeField<LatticeBisection<3>, float> field{grid, std::span<const float>(samples)};

    /// Of the trilinear interpolant, at a point of the domain.
    double value(const Point& x) const {
        double sum = 0;
        for (std::size_t k = 0; k < 8; ++k) {
            double weight = 1;
            std::size_t sample = 0;
            for (std::size_t d = 3; d-- > 0;) {
                const auto cell =
                    std::clamp(static_cast<std::size_t>(x[d]), std::size_t{0}, std::size_t{63});
                const double part = x[d] - static_cast<double>(cell);
                weight *= (k >> d & 1U) != 0 ? part : 1 - part;
                sample = 65 * sample + cell + (k >> d & 1U);
            }
            sum += weight * double(samples[sample]);
        }
        return sum;
    }
};

/// Paints the part of the plane through the middle, across the view, where low <= U < high.
inline void draw_section(Picture& picture, const Bucky& bucky, double low, double high) {
    const auto unit = [](const Point& a) { return 1 / norm(a) * a; };
    constexpr double step = 0.1;
    constexpr double side = 1.1;  // of a small square, in steps: they overlap
    const Point right = step * unit(cross(ball.up, ball.towards_eye));
    const Point up = step * unit(cross(ball.towards_eye, right));
    for (int i = -300; i < 300; ++i) {
        for (int k = -300; k < 300; ++k) {
            const Point x = ball.centre + double(i) * right + double(k) * up;
            if (std::ranges::min(x) < 0 || std::ranges::max(x) > 64) continue;
            const double u = bucky.value(x);
            if (u < low || u >= high) continue;
            const Point behind = x - 0.01 * ball.towards_eye;
            const Point a = behind + side * right;
            const Point b = behind + side * up;
            picture.triangle({behind, a, b}, ramp(1), false);
            picture.triangle({a, b + side * right, b}, ramp(1), false);
        }
    }
}

}  // namespace figures
