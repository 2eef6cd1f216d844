// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Coarse grids, files and expectations that the tests of the coarse adapters share.
#pragma once

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <nestgrid/adapters/coarse_checks.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// Expects an exception whose text holds all of the given words.
template <class Error, class Function>
void expect_sentence(Function&& function, std::initializer_list<std::string> words) {
    try {
        function();
        ADD_FAILURE() << "nothing was thrown, although " << *words.begin();
    } catch (const Error& error) {
        for (const std::string& word : words) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
                << "'" << word << "' is not in: " << error.what();
        }
    }
}

/// Writes a file of the test; returns its path.
inline std::string write_file(const std::string& name, const std::string& content) {
    std::string path = testing::TempDir() + name;
    std::ofstream(path, std::ios::binary) << content;
    return path;
}

/// Sum of areas or volumes.
inline double total_measure(const CoarseGrid& grid) {
    double sum = 0;
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        sum += measure(grid.shapes[e], grid.positions(e));
    }
    return sum;
}

/// A torus of n times m cells, as triangles or quadrilaterals, outward.
inline CoarseGrid torus(std::uint32_t n, std::uint32_t m, bool quadrilaterals) {
    CoarseGrid grid;
    grid.dimension = 2;
    std::vector<Point> points;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t k = 0; k < m; ++k) {
            const double a = 2 * std::numbers::pi * i / n;
            const double b = 2 * std::numbers::pi * k / m;
            const double r = 2 + std::cos(b);
            points.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
            const std::uint32_t next_i = (i + 1) % n;
            const std::uint32_t next_k = (k + 1) % m;
            const std::uint32_t loop[4] = {i * m + k, next_i * m + k, next_i * m + next_k,
                                           i * m + next_k};
            if (quadrilaterals) {
                grid.add_loop(loop);
            } else {
                grid.add(Shape::triangle, {loop[0], loop[1], loop[2]});
                grid.add(Shape::triangle, {loop[0], loop[2], loop[3]});
            }
        }
    }
    grid.nodes = Coordinates(std::move(points));
    return grid;
}

/// A band of n quadrilaterals with half a turn in it.
inline CoarseGrid moebius_strip(std::uint32_t n) {
    CoarseGrid grid;
    grid.dimension = 2;
    std::vector<Point> points;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        for (const double w : {-0.5, 0.5}) {
            const double r = 2 + w * std::cos(a / 2);
            points.push_back({r * std::cos(a), r * std::sin(a), w * std::sin(a / 2)});
        }
        std::uint32_t next[2] = {2 * i + 2, 2 * i + 3};
        if (i + 1 == n) {
            next[0] = 1;
            next[1] = 0;
        }
        grid.add(Shape::quadrilateral, {2 * i, next[0], 2 * i + 1, next[1]});
    }
    grid.nodes = Coordinates(std::move(points));
    return grid;
}

/// A surface as an OFF file.
inline std::string off_file(const CoarseGrid& grid) {
    std::string text = "OFF\n" + std::to_string(grid.nodes.size()) + " " +
                       std::to_string(grid.element_count()) + " 0\n";
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
        const Point x = grid.nodes[i];
        text +=
            std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + "\n";
    }
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        const auto nodes = grid.element(e);
        text += std::to_string(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            text += " " + std::to_string(nodes[nodes.size() == 4 && i >= 2 ? 5 - i : i]);
        }
        text += "\n";
    }
    return text;
}

}  // namespace nestgrid_test
