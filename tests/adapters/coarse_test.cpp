// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Coarse grids: borrowed coordinates, the dual graph, and a sentence for everything that is wrong.
#include <random>

#include "coarse_samples.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

/// n x n x n cubes, as hexahedra or as six tetrahedra each.
CoarseGrid block(std::uint32_t n, bool tetrahedra) {
    CoarseGrid grid;
    std::vector<Point> points;
    const std::uint32_t m = n + 1;
    for (std::uint32_t i = 0; i < m * m * m; ++i) {
        const std::uint32_t layer = i / m / m;
        const std::uint32_t row = i / m % m;
        points.push_back({double(i % m), double(row), double(layer)});
    }
    for (std::uint32_t i = 0; i < n * n * n; ++i) {
        const std::uint32_t first = i % n + m * (i / n % n + m * (i / n / n));
        std::array<std::uint32_t, 8> cube{};
        for (std::uint32_t c = 0; c < 8; ++c) {
            cube[c] = first + (c & 1U) + m * (c >> 1 & 1U) + m * m * (c >> 2);
        }
        if (!tetrahedra) {
            grid.add(Shape::hexahedron, cube);
            continue;
        }
        std::array<std::uint32_t, 3> axes{1, 2, 4};
        do {
            grid.add(Shape::tetrahedron,
                     {cube[0], cube[axes[0]], cube[axes[0] + axes[1]], cube[7]});
            const bool even = (axes[0] < axes[1]) ^ (axes[1] < axes[2]) ^ (axes[0] < axes[2]);
            if (!even) mirror(Shape::tetrahedron, grid.element(grid.element_count() - 1));
        } while (std::next_permutation(axes.begin(), axes.end()));
    }
    grid.nodes = Coordinates(std::move(points));
    return grid;
}

/// One element of each solid shape, in a chain.
CoarseGrid mixed_solids() {
    CoarseGrid grid;
    grid.nodes = Coordinates(std::vector<Point>{{0, 0, 0},
                                                {1, 0, 0},
                                                {0, 1, 0},
                                                {1, 1, 0},
                                                {0, 0, 1},
                                                {1, 0, 1},
                                                {0, 1, 1},
                                                {1, 1, 1},
                                                {0.5, 0.5, 2},
                                                {2, 0, 0.5},
                                                {2, 1, 0.5},
                                                {1.5, -1, 0.5}});
    grid.add(Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7});
    grid.add(Shape::pyramid, {4, 5, 6, 7, 8});
    grid.add(Shape::prism, {1, 5, 9, 3, 7, 10});
    grid.add(Shape::tetrahedron, {1, 9, 5, 11});
    return grid;
}

TEST(Coordinates, AreOwnedOrBorrowed) {
    EXPECT_FALSE(Coordinates().borrowed());
    EXPECT_EQ(Coordinates().size(), 0U);
    const Coordinates own(std::vector<Point>{{1, 2, 3}, {4, 5, 6}});
    Coordinates copy;
    copy = own;
    EXPECT_FALSE(copy.borrowed());
    EXPECT_EQ(copy[1], (Point{4, 5, 6}));
    std::vector<double> doubles{1, 2, 3, 0, 4, 5, 6, 0};
    const Coordinates wide = Coordinates::borrow(doubles.data(), 2, 4);
    EXPECT_TRUE(wide.borrowed());
    doubles[5] = 50;
    EXPECT_EQ(wide[1], (Point{4, 50, 6}));
    const std::vector<float> floats{1, 2, 3, 4, 5, 6.5F};
    EXPECT_EQ(Coordinates::borrow(floats.data(), 2)[1], (Point{4, 5, 6.5}));
}

std::size_t inner_faces(const CoarseGrid& grid) {
    std::size_t count = 0;
    detail::for_each_inner_face(grid, [&](const CoarseFace&, const CoarseFace&) { ++count; });
    return count;
}

TEST(DualGraph, FindsComponents) {
    CoarseGrid grid = torus(8, 6, false);
    EXPECT_EQ(components(grid).second, 1);
    // Two triangles that touch in a node are two components.
    grid = CoarseGrid();
    grid.dimension = 2;
    grid.nodes =
        Coordinates(std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}});
    grid.add(Shape::triangle, {0, 1, 2});
    grid.add(Shape::triangle, {0, 3, 4});
    EXPECT_EQ(components(grid).second, 2);
    EXPECT_NE(components(grid).first[0], components(grid).first[1]);
    EXPECT_EQ(components(CoarseGrid()).second, 0);
    EXPECT_EQ(components(mixed_solids()).second, 1);
    EXPECT_EQ(inner_faces(mixed_solids()), 3U);
    EXPECT_EQ(inner_faces(block(3, false)), 54U);
}

TEST(DualGraph, OrientsASurfaceAfterRandomFlips) {
    std::mt19937 random(7);
    for (const bool quadrilaterals : {false, true}) {
        for (int run = 0; run < 10; ++run) {
            const CoarseGrid sample = torus(16, 9, quadrilaterals);
            CoarseGrid grid = sample;
            std::size_t flipped = 0;
            for (std::size_t e = 1; e < grid.element_count(); ++e) {
                if (random() % 2 == 0) continue;
                mirror(grid.shapes[e], grid.element(e));
                ++flipped;
            }
            EXPECT_EQ(orient(grid), flipped);
            EXPECT_EQ(grid.corners, sample.corners);
            EXPECT_EQ(orient(grid), 0U);
        }
    }
}

TEST(DualGraph, OrientsSolids) {
    for (CoarseGrid grid : {block(3, false), block(3, true), mixed_solids()}) {
        check_and_orient(grid);
        const CoarseGrid right = grid;
        const double volume = total_measure(grid);
        std::mt19937 random(3);
        for (std::size_t e = 1; e < grid.element_count(); ++e) {
            if (random() % 2 == 0) mirror(grid.shapes[e], grid.element(e));
        }
        orient(grid);
        EXPECT_NEAR(total_measure(grid), volume, 1e-12);
        EXPECT_EQ(orient(grid), 0U);
        // All of them inverted: a tool of another sign, not an error.
        for (std::size_t e = 0; e < grid.element_count(); ++e) {
            mirror(grid.shapes[e], grid.element(e));
        }
        check_and_orient(grid);
        EXPECT_NEAR(total_measure(grid), volume, 1e-12);
    }
    EXPECT_NEAR(total_measure(block(3, false)), 27, 1e-12);
}

TEST(DualGraph, RefusesAMoebiusStrip) {
    for (const std::uint32_t n : {5U, 6U, 40U}) {
        CoarseGrid strip = moebius_strip(n);
        expect_sentence<InvalidInput>([&] { orient(strip); },
                                      {"cannot be oriented", "Moebius strip", "edge "});
    }
}

TEST(DualGraph, CuthillMckeeBringsNeighboursTogether) {
    const CoarseGrid sample = block(8, true);
    std::vector<std::uint32_t> shuffled(sample.element_count());
    std::iota(shuffled.begin(), shuffled.end(), 0U);
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(5));
    const CoarseGrid grid = reordered(sample, shuffled);
    const auto bandwidth = [](const CoarseGrid& g) {
        std::size_t width = 0;
        detail::for_each_inner_face(g, [&](const CoarseFace& a, const CoarseFace& b) {
            width = std::max<std::size_t>(
                width, a.element > b.element ? a.element - b.element : b.element - a.element);
        });
        return width;
    };
    std::vector<std::uint32_t> order = reverse_cuthill_mckee(grid);
    const CoarseGrid narrow = reordered(grid, order);
    EXPECT_LT(bandwidth(narrow), bandwidth(grid) / 5);
    EXPECT_LT(bandwidth(narrow), 512U);
    EXPECT_NEAR(total_measure(narrow), total_measure(sample), 1e-9);
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

TEST(DualGraph, CuthillMckeeVisitsEveryComponent) {
    CoarseGrid two = torus(6, 5, false);
    const std::size_t half = two.element_count();
    for (std::size_t e = 0; e < half; ++e) {
        const auto n = two.element(e);
        two.add(Shape::triangle, {n[0] + 30, n[1] + 30, n[2] + 30});
    }
    std::vector<std::uint32_t> order = reverse_cuthill_mckee(two);
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

TEST(DualGraph, ColoursDifferInEveryElement) {
    for (const CoarseGrid& grid :
         {torus(16, 9, false), torus(16, 9, true), block(4, false), block(4, true)}) {
        const std::vector<std::uint32_t> colour = node_colours(grid);
        ASSERT_EQ(colour.size(), grid.nodes.size());
        for (std::size_t e = 0; e < grid.element_count(); ++e) {
            const auto nodes = grid.element(e);
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                for (std::size_t k = 0; k < i; ++k) EXPECT_NE(colour[nodes[i]], colour[nodes[k]]);
            }
        }
        EXPECT_LT(*std::max_element(colour.begin(), colour.end()), 27U);
    }
    EXPECT_TRUE(node_colours(CoarseGrid()).empty());
}

/// Plane points in a row of two, and whatever a test adds.
CoarseGrid plane(std::vector<Point> more = {}) {
    CoarseGrid grid;
    grid.dimension = 2;
    std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    points.insert(points.end(), more.begin(), more.end());
    grid.nodes = Coordinates(std::move(points));
    grid.add(Shape::triangle, {0, 1, 2});
    return grid;
}

void refused(CoarseGrid grid, std::initializer_list<std::string> words) {
    expect_sentence<InvalidInput>([&] { check_and_orient(grid); }, words);
}

TEST(CoarseChecks, HaveASentenceForEveryFault) {
    refused(CoarseGrid(), {"no element"});
    refused(plane({{0, std::nan(""), 0}}), {"node 4", "no number"});
    refused(plane({{0, HUGE_VAL, 0}}), {"node 4", "no number"});
    refused(plane({{5, 5, 5}, {1, 1, 0}}), {"duplicate vertex", "3 and 5", "same place"});

    CoarseGrid grid = plane();
    grid.add(Shape::tetrahedron, {0, 1, 2, 3});
    refused(grid, {"tetrahedron 1", "dimension 2"});
    grid = plane();
    grid.add(Shape::quadrilateral, {0, 1, 2});
    refused(grid, {"quadrilateral 1", "3 corners"});
    grid = plane();
    grid.add(Shape::triangle, {1, 3, 9});
    refused(grid, {"triangle 1", "node 9", "there are 4"});
    grid = plane();
    grid.add(Shape::triangle, {1, 3, 1});
    refused(grid, {"triangle 1", "node 1 twice"});
    grid = plane({{2, 0, 0}});
    grid.add(Shape::triangle, {0, 1, 4});
    refused(grid, {"triangle 1 is flat"});
    grid = plane({{0, 0, 1}});
    grid.add(Shape::triangle, {1, 3, 2});
    grid.add(Shape::triangle, {1, 2, 4});
    refused(grid, {"not a manifold", "0, 1 and 2", "edge 1-2"});
    refused(moebius_strip(7), {"cannot be oriented"});
    // Folded over: the second triangle lies on the first.
    grid = plane({{0.25, 0.25, 0}});
    grid.add(Shape::triangle, {1, 4, 2});
    grid.add(Shape::triangle, {0, 3, 1});
    refused(grid, {"inverted element"});

    grid = block(2, true);
    mirror(Shape::tetrahedron, grid.element(11));
    refused(grid, {"inverted element", "tetrahedron 11"});
}

TEST(CoarseChecks, TakeSlitsIfToldSo) {
    CoarseGrid grid = plane({{1, 0, 0}, {0, 1, 0}});
    grid.add(Shape::triangle, {4, 3, 5});
    refused(grid, {"duplicate vertex"});
    check_and_orient(grid, {.slits = true});
    EXPECT_EQ(components(grid).second, 2);
}

TEST(CoarseChecks, TurnPlaneGridsCounterclockwise) {
    CoarseGrid grid = plane();
    grid.add(Shape::triangle, {1, 2, 3});
    mirror(Shape::triangle, grid.element(0));
    check_and_orient(grid);
    for (std::size_t e = 0; e < 2; ++e) {
        EXPECT_GT(measure_vector(grid.shapes[e], grid.positions(e))[2], 0);
    }
}

}  // namespace
