// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lagrange polynomials of all shapes.
#pragma once

#include <array>
#include <cmath>

#include <nestgrid/adapters/lagrange_cells.hpp>

namespace nestgrid {

namespace detail {

/// The Lagrange polynomials of a degree at equispaced nodes, at a place.
inline std::array<double, max_degree + 1> lagrange_basis(int degree, double x) {
    std::array<double, max_degree + 1> basis{};
    for (int i = 0; i <= degree; ++i) {
        double product = 1;
        for (int m = 0; m <= degree; ++m) {
            if (m != i) product *= (degree * x - m) / (i - m);
        }
        basis[static_cast<std::size_t>(i)] = product;
    }
    return basis;
}

/// The factors of Lagrange polynomials on a simplex, for one barycentric coordinate: the product of
/// (p x - m) / (m + 1) over all m below i.
inline std::array<double, max_degree + 1> simplex_factors(int degree, double x) {
    std::array<double, max_degree + 1> factors{1};
    for (int i = 0; i < degree; ++i) {
        const auto n = static_cast<std::size_t>(i);
        factors[n + 1] = factors[n] * (degree * x - i) / (i + 1);
    }
    return factors;
}

/// The polynomial of a cell with values at its lattice.
/// \param node called with the number of a node, i first
template <class Value, class Node>
Value lattice_polynomial(Shape shape, int degree, const Point& x, const Node& node) {
    if (shape == Shape::pyramid) {
        const double width = 1 - x[2];
        const Point in_box = width > 0 ? Point{x[0] / width, x[1] / width, x[2]} : Point{0, 0, 1};
        return lattice_polynomial<Value>(Shape::hexahedron, degree, in_box, node);
    }
    const bool box = is_box(shape);
    const bool plane = topology(shape).dimension == 2;
    const bool tetrahedron = shape == Shape::tetrahedron;
    const auto factors = [&](bool simplex, double at) {
        return simplex ? simplex_factors(degree, at) : lagrange_basis(degree, at);
    };
    const auto in_x = factors(!box, x[0]);
    const auto in_y = factors(!box, x[1]);
    auto in_z = factors(tetrahedron, x[2]);
    if (plane) in_z = {1};
    const auto rest = factors(true, 1 - x[0] - x[1] - (tetrahedron ? x[2] : 0));
    const auto p = static_cast<std::size_t>(degree);
    Value sum{};
    for (std::size_t k = 0, number = 0; k <= (plane ? 0 : p); ++k) {
        const std::size_t most = tetrahedron ? p - k : p;
        for (std::size_t j = 0; j <= most; ++j) {
            const double outer = in_y[j] * in_z[k];
            for (std::size_t i = 0; i <= (box ? p : most - j); ++i) {
                const double last = box ? 1 : rest[most - j - i];
                sum = sum + in_x[i] * outer * last * node(number++);
            }
        }
    }
    return sum;
}

}  // namespace detail

}  // namespace nestgrid
