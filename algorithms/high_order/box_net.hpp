// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Polynomials on boxes in Bernstein form: their coefficients, the net.
//
// A net of degree p in 1, 2 or 3 directions has p + 1 coefficients along each, the first direction
// running fastest; all lie over the unit box.
// Invariants:
//   - the polynomial lies between its least and its greatest coefficient, and has the outermost
//     ones at the corners of the box;
//   - halving takes means alone: two halves share the coefficients between them to the last bit,
//     and what lies in a face at an end of the box is not touched by halving towards it;
//   - beta(part) <= beta / 4 for each half of a net in all directions, and beta of a face or an
//   edge
//     is at most that of the box.
// Consequence: values inside a leaf are the same from all sides, and what is flat stays flat.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// Of boxes: 2^dimension corners, and as many halves in all directions.
inline constexpr std::size_t max_box_corners = 8;

/// Number of coefficients of degree p.
constexpr std::size_t net_size(int degree, int dimension) {
    std::size_t size = 1;
    for (int d = 0; d < dimension; ++d) size *= static_cast<std::size_t>(degree) + 1;
    return size;
}

/// Number of the coefficient at a corner of the box.
constexpr std::size_t net_corner(int degree, int dimension, std::size_t corner) {
    std::size_t at = 0;
    std::size_t stride = 1;
    for (int d = 0; d < dimension; ++d, stride *= static_cast<std::size_t>(degree) + 1) {
        at += (corner >> d & 1U) * static_cast<std::size_t>(degree) * stride;
    }
    return at;
}

/// What the coefficients of a net say of its polynomial u.
struct NetFacts {
    double beta = 0;  ///< |u - I u| is at most this, where I interpolates between the corners
    double least = 0;
    double greatest = 0;
};

/// Bounds by the second differences along each direction: with D_i = p (p - 1) times those,
/// |u - I u| <= max(sum of the greatest D_i above 0, sum of the least below 0) / 8.
NetFacts net_facts(const double* net, int degree, int dimension);

/// How far u may be from the affine function with these values at the corners: A = mean + slopes.
/// \param affine the mean in the middle of the box, then the slope along each direction
double distance_from_affine(const double* net, int degree, int dimension,
                            std::span<const double> affine);

/// The affine function that fits values at the corners of a box best, and the greatest residual.
struct AffineFit {
    std::array<double, 4> affine{};  ///< the mean, then the slope along each direction
    double residual = 0;
};
AffineFit fit_affine(std::span<const double> corners, int dimension);

/// Puts the parts of a net in the 2^dimension halves of its box behind one another.
void halve_all(const double* net, int degree, int dimension, double* halves);
/// Replaces a net by its lower (0) or upper (1) half along one direction.
void keep_half(double* net, int degree, int dimension, int direction, unsigned half);

/// The value of a net in one direction at a point of [0, 1], by de Casteljau's means; exact at the
/// ends. The net is used up.
inline double line_value(double* net, int degree, double at) {
    if (at == 0 || at == 1) return net[at == 0 ? 0 : degree];
    for (int left = degree; left > 0; --left) {
        for (int i = 0; i < left; ++i) net[i] = (1 - at) * net[i] + at * net[i + 1];
    }
    return net[0];
}
/// u at a point of the unit box.
double net_value(const double* net, int degree, int dimension, std::span<const double> at);

/// Replaces the values of u at the tensor product of Gauss-Lobatto points, first direction fastest,
/// by its coefficients.
void to_coefficients(double* net, int degree, int dimension);
/// The Gauss-Lobatto points of degree p in [0, 1], ascending.
std::span<const double> lobatto_points(int degree);
/// Their tensor product, first direction fastest.
std::vector<Point> lobatto_grid(int degree, int dimension);

/// The coefficients of the same polynomial as one of a higher degree.
std::vector<double> elevated(const double* net, int degree, int dimension, int to_degree);

}  // namespace nestgrid::engine
