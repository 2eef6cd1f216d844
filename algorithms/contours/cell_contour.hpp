// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The level set inside one element: which corners a face joins, and whether a tunnel joins two
// loops through the inside.
//
// The functions are multilinear (for the pyramid the rational one, bilinear on its base), so what
// follows is exact up to rounding:
//   - on a quadrilateral whose signs alternate, the diagonal of the saddle's sign is joined (the
//     asymptotic decider of Nielson and Hamann 1991);
//   - in prisms and pyramids every loop bounds a disc of the level set: a section of a prism is
//     linear and meets it in one arc, and the sections of a pyramid along its axis meet the levels
//     of one bilinear function in falling or in rising order;
//   - in a hexahedron two regions of one sign, apart on its surface, may be joined inside. A
//     section has no component without a corner of its own, so they are joined if and only if in
//     some section across an axis opposite corners are joined whose regions differ (after
//     Chernyaev 1995).
#pragma once

#include <cmath>
#include <optional>
#include <span>

#include <contours/contour_table.hpp>
#include <nestgrid/detail/pack.hpp>

namespace nestgrid::engine {

/// Whether the corners with U >= C are joined across a quadrilateral whose signs alternate.
/// a, b, c, d are the values U - C around it; a function of the face alone, to the last bit.
constexpr bool joins_across(double a, double b, double c, double d) {
    return a >= 0 ? a * c >= b * d : b * d >= a * c;
}

/// Whether each corner of a quadrilateral or hexahedron is the first corner plus edges at it, to
/// the last bit, as in boxes along the axes.
template <std::size_t n>
bool is_parallelepiped(std::span<const Point, n> x) {
    using Indices = std::array<std::size_t, 3>;  // a corner, and the two whose sum it is
    constexpr std::array<Indices, 4> sums{{{3, 1, 2}, {5, 1, 4}, {6, 2, 4}, {7, 1, 6}}};
    constexpr std::size_t count = n == 4 ? 1 : sums.size();
    // All bits are 0 where `corner` is the sum of a and b, all relative to `first`.
    const auto off = [](const auto& corner, const auto& a, const auto& b, const auto& first) {
        return ((corner - first) - ((a - first) + (b - first))).template as<std::uint64_t>();
    };
    const auto xy = [&](std::size_t i) { return Pack<double, 2>::load(x[i].data()); };
    auto xy_off = Pack<std::uint64_t, 2>::all(0);
    for (const auto& [corner, a, b] : std::span(sums).first(count)) {
        xy_off = xy_off | off(xy(corner), xy(a), xy(b), xy(0));
    }
    using All = Pack<double, 4>;
    const auto z = [&](std::size_t which) {
        return All::make([&](auto i)
                             NESTGRID_INLINE_LAMBDA { return x[sums[i % count][which]][2]; });
    };
    const auto any_xy = xy_off.numbers();
    const auto any_z = off(z(0), z(1), z(2), All::all(x[0][2])).numbers();
    return (any_xy[0] | any_xy[1] | any_z[0] | any_z[1] | any_z[2] | any_z[3]) == 0;
}

/// The affine_residual() of a parallelepiped. The fit leaves nothing but the twists: products of
/// two or three coordinates, which are 1 or -1 at the corners.
template <std::size_t n>
double affine_residual_of_parallelepiped(std::span<const double, n> u) {
    if constexpr (n == 4) {
        return std::abs((u[0] - u[1]) - (u[2] - u[3])) / 4;
    } else {
        std::array<double, 4> sum;
        std::array<double, 4> rise;
        for (std::size_t i = 0; i < 4; ++i) {
            sum[i] = u[i] + u[i + 4];
            rise[i] = u[i + 4] - u[i];
        }
        const double xy = (sum[0] - sum[1]) - (sum[2] - sum[3]);
        const double xz = (rise[1] - rise[0]) + (rise[3] - rise[2]);
        const double yz = (rise[2] - rise[0]) + (rise[3] - rise[1]);
        const double xyz = (rise[0] - rise[1]) - (rise[2] - rise[3]);
        // At a corner the signs of xy, xz and yz multiply to 1, and xyz has either sign.
        const double even = std::max(std::abs(xy + xz + yz), std::abs(xy - xz - yz));
        const double odd = std::max(std::abs(xz - xy - yz), std::abs(yz - xy - xz));
        return (std::max(even, odd) + std::abs(xyz)) / 8;
    }
}

/// Whether the edges of a prism between its two triangles are equal, to the last bit.
inline bool is_sheared_prism(std::span<const Point, 6> x) {
    bool same = true;
    for (std::size_t i = 4; i < 6; ++i) {
        for (std::size_t d = 0; d < 3; ++d) same &= x[i][d] - x[i - 3][d] == x[3][d] - x[0][d];
    }
    return same;
}

/// The affine_residual() of a sheared prism. The fit has the mean value of u in the middle of each
/// of these edges, because an affine function can have any three values there, and rises along all
/// three by the mean of their differences.
inline double affine_residual_of_sheared_prism(std::span<const double, 6> u) {
    std::array<double, 3> slope;
    for (std::size_t i = 0; i < 3; ++i) slope[i] = (u[i + 3] - u[i]) / 2;
    const double mean = (slope[0] + slope[1] + slope[2]) / 3;
    double greatest = 0;
    for (const double s : slope) greatest = std::max(greatest, std::abs(s - mean));
    return greatest;
}

/// How far the values at the corners of an element are from an affine function: the greatest
/// residual of a least-squares fit. Affine functions are interpolated exactly, and the shape
/// functions are a partition of 1 and nowhere below 0, so within the element the interpolated
/// function deviates from the fit by no more. Between points where it has one value, on a segment
/// or triangle within the element, it deviates from that value by twice as much at most.
template <std::size_t n>  // number of corners; the compiler unrolls the short loops
double affine_residual(std::span<const Point, n> x, std::span<const double, n> u) {
    if constexpr (n == 4 || n == 8) {
        if (is_parallelepiped(x)) return affine_residual_of_parallelepiped(u);
    }
    if constexpr (n == 6) {
        if (is_sheared_prism(x)) return affine_residual_of_sheared_prism(u);
    }
    std::array<std::array<double, n>, 4> basis;  // 1, x, y, z at the corners
    std::array<double, n> rest;
    for (std::size_t i = 0; i < n; ++i) {
        basis[0][i] = 1;
        for (std::size_t d = 0; d < 3; ++d) basis[d + 1][i] = x[i][d] - x[0][d];
        rest[i] = u[i];
    }
    const auto product = [&](const auto& a, const auto& b) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
        return sum;
    };
    for (std::size_t k = 0; k < basis.size(); ++k) {  // Gram and Schmidt
        const double length = product(basis[k], basis[k]);
        for (std::size_t j = 0; j < k; ++j) {
            const double part = product(basis[k], basis[j]);
            for (std::size_t i = 0; i < n; ++i) basis[k][i] -= part * basis[j][i];
        }
        const double left = product(basis[k], basis[k]);
        const double scale = left > 1e-24 * length ? 1 / std::sqrt(left) : 0;  // 0: a flat element
        for (std::size_t i = 0; i < n; ++i) basis[k][i] *= scale;
        const double part = product(rest, basis[k]);
        for (std::size_t i = 0; i < n; ++i) rest[i] -= part * basis[k][i];
    }
    double greatest = 0;
    for (std::size_t i = 0; i < n; ++i) greatest = std::max(greatest, std::abs(rest[i]));
    return greatest;
}

inline double affine_residual(std::span<const Point> x, std::span<const double> u) {
    switch (u.size()) {
        case 4:
            return affine_residual(x.first<4>(), u.first<4>());
        case 5:
            return affine_residual(x.first<5>(), u.first<5>());
        case 6:
            return affine_residual(x.first<6>(), u.first<6>());
        case 8:
            return affine_residual(x.first<8>(), u.first<8>());
        default:
            return 0;  // simplices of lower dimension
    }
}

/// A tunnel between two loops of a contour.
struct Tunnel {
    std::size_t from = 0;  ///< the two loops it joins
    std::size_t to = 0;
    std::array<Point, 4> ring;  ///< points of the level set around its neck, reference coordinates
};

/// The tunnel of a hexahedron, if it has one. u are the values U - C at its corners.
std::optional<Tunnel> find_tunnel(const Contour& contour, const std::array<double, 8>& u);

}  // namespace nestgrid::engine
