// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Polynomials on products of simplices in Bernstein form: their coefficients, the net.
//
// A shape is a product of simplices, its factors: a hexahedron of three segments, a prism of a
// triangle and a segment, a tetrahedron of itself. A net of degree p has one coefficient for each
// way to deal p to the corners of each factor, the first factor running fastest, within a factor
// the share of corner 1, then that of corner 2. So a coefficient has a place in the reference
// element (its Greville point), in units of 1 / p.
// Invariants:
//   - the polynomial lies between its least and its greatest coefficient, and has the outermost
//     ones at the corners;
//   - a coefficient of a part is a function of net and corners of the part alone, to the last bit,
//     where these are sorted: parts that share a side share its coefficients;
//   - halving boxes takes means alone, with the same consequence;
//   - beta(part) <= beta / 4 for each half of a net, beta of an edge is at most that of a face
//     around it, and beta of a face of a box at most that of the box.
// Consequence: values inside a leaf are the same from all sides, and what is flat stays flat.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// The dimensions of the simplices that a shape is a product of.
struct Factors {
    std::size_t count = 0;
    std::array<std::uint8_t, 3> dimension{};

    constexpr bool all_segments() const {
        for (std::size_t f = 0; f < count; ++f) {
            if (dimension[f] != 1) return false;
        }
        return true;
    }
};

/// A pyramid is a box that is collapsed (pyramid.hpp).
constexpr Factors factors_of(Shape shape) {
    switch (shape) {
        case Shape::segment:
            return {1, {1}};
        case Shape::triangle:
            return {1, {2}};
        case Shape::tetrahedron:
            return {1, {3}};
        case Shape::quadrilateral:
            return {2, {1, 1}};
        case Shape::prism:
            return {2, {2, 1}};
        case Shape::hexahedron:
        case Shape::pyramid:
            return {3, {1, 1, 1}};
        case Shape::point:
            break;
    }
    return {};
}

constexpr std::size_t simplex_size(int degree, int dimension) {
    std::size_t size = 1;
    for (int d = 1; d <= dimension; ++d) {
        size = size * static_cast<std::size_t>(degree + d) / static_cast<std::size_t>(d);
    }
    return size;
}

/// Number of coefficients of degree p.
constexpr std::size_t net_size(int degree, const Factors& factors) {
    std::size_t size = 1;
    for (std::size_t f = 0; f < factors.count; ++f) {
        size *= simplex_size(degree, factors.dimension[f]);
    }
    return size;
}
inline constexpr std::size_t max_net_size = net_size(max_degree, factors_of(Shape::hexahedron));
using NetRoom = std::array<double, max_net_size>;

/// Coordinates in a reference element, in units that the context says.
using Place = std::array<std::int64_t, 3>;

/// Number of the coefficient at a place, in units of 1 / degree.
std::size_t net_index(int degree, const Factors& factors, const Place& at);
/// Number of the coefficient at a corner.
std::size_t net_corner(int degree, const Factors& factors, std::size_t corner);

/// What the coefficients of a net say of its polynomial u.
struct NetFacts {
    double beta = 0;  ///< |u - I u| is at most this, where I interpolates between the corners
    double least = 0;
    double greatest = 0;
};

/// Bounds by the second differences along each edge of each factor (docs/closed_surfaces.md).
NetFacts net_facts(const double* net, int degree, const Factors& factors);

/// Those of several polynomials together: beta is the norm of theirs, the range that of the first.
/// \param facts called with 0 to count - 1
template <class Facts>
NetFacts joined_facts(std::size_t count, const Facts& facts) {
    NetFacts joined = facts(std::size_t{0});
    if (count == 1) return joined;
    double sum = joined.beta * joined.beta;
    for (std::size_t c = 1; c < count; ++c) {
        const double beta = facts(c).beta;
        sum += beta * beta;
    }
    joined.beta = std::sqrt(sum);
    return joined;
}

/// The affine function that fits values at the corners best, and the greatest residual there.
struct AffineFit {
    /// It is the sum of one affine function in each factor, which has these values at its corners.
    std::array<std::array<double, 4>, 3> part{};
    double residual = 0;
};
AffineFit fit_affine(std::span<const double> corners, const Factors& factors);
/// How far u may be from the affine function.
double distance_from_affine(const double* net, int degree, const Factors& factors,
                            const AffineFit& affine);

/// Where a part lies: a product of one simplex in each factor of the whole.
struct NetPart {
    Factors factors;  ///< of the part; points are left out
    /// The corners of the simplex in each factor of the whole, in barycentric coordinates there.
    std::array<std::array<std::array<double, 4>, 4>, 3> corner{};
    std::array<std::uint8_t, 3> corners{};
    /// Which corner of the part's net each of the points is that it was made of.
    std::array<std::uint8_t, max_corners> number{};
};
/// The part with these corners, sorted. \param points in units of 2^-level
NetPart part_at(const Factors& whole, std::span<const Place> points, int level);
/// Puts the coefficients on a part.
void restrict_net(const double* net, int degree, const Factors& whole, const NetPart& part,
                  double* out);
/// Where the coefficients on an edge or face of a box are: their numbers are linear in the place.
struct BoxRows {
    std::size_t count;  ///< in a row
    std::size_t rows;
    std::ptrdiff_t first = 0;
    std::ptrdiff_t along = 0;   ///< from one in a row to the next
    std::ptrdiff_t across = 0;  ///< from row to row

    /// \param frame as in take_part()
    BoxRows(int degree, const Factors& box, std::span<const Place> frame);
    std::size_t operator()(std::size_t i, std::size_t row) const {
        return static_cast<std::size_t>(first + static_cast<std::ptrdiff_t>(i) * along +
                                        static_cast<std::ptrdiff_t>(row) * across);
    }
};
/// Copies the coefficients on an edge or face of the whole.
/// \param frame corner 0 of the part's net and its neighbours, corners of the reference element
void take_part(const double* net, int degree, const Factors& whole, std::span<const Place> frame,
               const Factors& part, double* out);

/// Puts the parts of a net in the 2^dimension halves of its box behind one another.
void halve_all(const double* net, int degree, std::size_t dimension, double* halves);

/// u and its derivatives along the axes at a point of the reference element.
double net_value(const double* net, int degree, const Factors& factors, const Point& at);
Point net_gradient(const double* net, int degree, const Factors& factors, const Point& at);

/// The points at which a field is asked for its values, in the order of coefficients: those of
/// Gauss and Lobatto along segments, in equal steps in triangles and tetrahedra.
std::vector<Point> net_points(int degree, const Factors& factors);
/// Replaces values at the net_points() by coefficients.
void to_coefficients(double* net, int degree, const Factors& factors);
/// The coefficients of the same polynomial as one of a higher degree.
std::vector<double> elevated(const double* net, int degree, const Factors& factors, int to_degree);

/// The multi-indices of one simplex and degree.
struct SimplexIndex {
    using Alpha = std::array<std::uint8_t, 4>;
    std::vector<Alpha> alpha;
    /// For each multi-index of one degree less: the numbers of the multi-indices that have one more
    /// at corner 0, at corner 1 and so on.
    std::vector<std::array<std::uint16_t, 4>> raised;
    /// For each two corners, what a second difference takes.
    std::vector<std::vector<std::array<std::uint16_t, 3>>> second;
    std::array<std::uint16_t, 9 * 9 * 9> number{};  ///< by shares of corners 1, 2 and 3
};
/// Where a multi-index lies in SimplexIndex::number.
constexpr std::size_t slot(const SimplexIndex::Alpha& a) { return a[1] + 9U * (a[2] + 9U * a[3]); }
constexpr SimplexIndex::Alpha with_one_more(SimplexIndex::Alpha a, std::size_t corner) {
    ++a[corner];
    return a;
}
/// \param dimension 0 to 3 \param degree 0 to max_degree
const SimplexIndex& simplex_index(std::size_t dimension, int degree);

/// How a net is laid out seen along one factor: `outer` blocks of `count` rows of `stride`.
struct Lanes {
    std::size_t count = 1;
    std::size_t stride = 1;
    std::size_t outer = 1;

    Lanes(int degree, const Factors& factors, std::size_t factor) {
        for (std::size_t f = 0; f < factors.count; ++f) {
            (f < factor    ? stride
             : f == factor ? count
                           : outer) *= simplex_size(degree, factors.dimension[f]);
        }
    }
    std::size_t block() const { return count * stride; }
};

}  // namespace nestgrid::engine
