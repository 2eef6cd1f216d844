// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Finds tunnels through hexahedra in the sections across their third axis.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <contours/cell_contour.hpp>

namespace nestgrid::engine {

namespace {

/// A section of a hexahedron at height t; corners a, b, c, d in a loop from (0, 0) on.
struct Section {
    double a, b, c, d;

    Section(const std::array<double, 8>& u, double t)
        : a{u[0] + t * (u[4] - u[0])},
          b{u[1] + t * (u[5] - u[1])},
          c{u[3] + t * (u[7] - u[3])},
          d{u[2] + t * (u[6] - u[2])} {}

    double at(double x, double y) const {
        return (1 - y) * ((1 - x) * a + x * b) + y * ((1 - x) * d + x * c);
    }
    std::array<double, 2> saddle() const {
        const double sum = (a - b) + (c - d);
        return {std::clamp((a - d) / sum, 0.0, 1.0), std::clamp((a - b) / sum, 0.0, 1.0)};
    }
    /// The zero between the saddle and a corner of the other sign.
    Point zero_towards(double x, double y, double t) const {
        const auto [sx, sy] = saddle();
        const bool sign = at(x, y) >= 0;
        double lo = 0;
        double hi = 1;
        for (int i = 0; i < 50; ++i) {
            const double m = (lo + hi) / 2;
            ((at(sx + m * (x - sx), sy + m * (y - sy)) >= 0) == sign ? hi : lo) = m;
        }
        return {sx + hi * (x - sx), sy + hi * (y - sy), t};
    }
};

/// Heights at which the edges from u[i] to u[i + 4] have the wanted signs, or nothing.
std::optional<std::array<double, 2>> heights(const std::array<double, 8>& u,
                                             const std::array<double, 4>& wanted) {
    std::array<double, 2> range{0, 1};
    for (std::size_t i = 0; i < 4; ++i) {
        const double below = wanted[i] * u[i];
        const double above = wanted[i] * u[i + 4];
        if (below < 0 && above < 0) return std::nullopt;
        if (below < 0) range[0] = std::max(range[0], below / (below - above));
        if (above < 0) range[1] = std::min(range[1], below / (below - above));
    }
    if (!(range[0] < range[1])) return std::nullopt;
    return range;
}

/// How sections join two opposite corners that are joined nowhere on the surface.
struct Joining {
    unsigned diagonal = 0;  ///< 0: corners 0 and 3 of a section, 1: corners 1 and 2
    double sign = 1;        ///< of the corners that are joined
    double best = 0;        ///< the height of the section that joins them most
    double low = 0;         ///< the heights between which sections join them
    double high = 0;
};

std::optional<Joining> find_joining(const std::array<double, 8>& u, unsigned diagonal,
                                    double sign) {
    const double one = diagonal == 0 ? sign : -sign;
    const auto range = heights(u, {one, -one, -one, one});
    if (!range) return std::nullopt;
    // a c - b d as a polynomial p + q t + r t^2: above 0 where a and c are joined.
    const double da = u[4] - u[0], db = u[5] - u[1], dd = u[6] - u[2], dc = u[7] - u[3];
    const double turn = diagonal == 0 ? 1 : -1;
    const double p = turn * (u[0] * u[3] - u[1] * u[2]);
    const double q = turn * (u[0] * dc + u[3] * da - u[1] * dd - u[2] * db);
    const double r = turn * (da * dc - db * dd);
    if (!(r < 0)) return std::nullopt;  // its greatest value lies at an end: joined on the surface
    const double best = -q / (2 * r);
    if (!(best > (*range)[0] && best < (*range)[1])) return std::nullopt;
    const double discriminant = q * q - 4 * p * r;
    if (!(discriminant > 0)) return std::nullopt;
    const double half = std::sqrt(discriminant) / (-2 * r);
    return Joining{diagonal, sign, best, std::max(best - half, (*range)[0]),
                   std::min(best + half, (*range)[1])};
}

/// The loops around the regions that are joined, or nothing where these are one region.
std::optional<std::array<std::size_t, 2>> find_loops(const Contour& contour,
                                                     const std::array<double, 8>& u,
                                                     const Joining& joining) {
    const double sign = joining.sign;
    const auto region = [&](std::size_t i) {
        return contour.region[(u[i] >= 0) == (sign > 0) ? i : i + 4];
    };
    const std::uint8_t from = region(joining.diagonal == 0 ? 0 : 1);
    const std::uint8_t to = region(joining.diagonal == 0 ? 3 : 2);
    if (from == to) return std::nullopt;
    for (std::size_t i = 0; i < contour.loop_count; ++i) {
        for (std::size_t j = 0; j < contour.loop_count; ++j) {
            const ContourLoop& a = contour.loop[i];
            const ContourLoop& b = contour.loop[j];
            const bool around =
                sign > 0 ? a.positive == from && b.positive == to && a.negative == b.negative
                         : a.negative == from && b.negative == to && a.positive == b.positive;
            if (around) return std::array{i, j};
        }
    }
    return std::nullopt;
}

/// Points of the level set around the neck: two in its best section, and the saddles of the first
/// and the last section that join the corners.
std::array<Point, 4> ring_around(const std::array<double, 8>& u, const Joining& joining) {
    const Section neck(u, joining.best);
    const auto low = Section(u, joining.low).saddle();
    const auto high = Section(u, joining.high).saddle();
    const bool first = joining.diagonal == 0;
    return {neck.zero_towards(first ? 1 : 0, 0, joining.best), Point{low[0], low[1], joining.low},
            neck.zero_towards(first ? 0 : 1, 1, joining.best),
            Point{high[0], high[1], joining.high}};
}

}  // namespace

std::optional<Tunnel> find_tunnel(const Contour& contour, const std::array<double, 8>& u) {
    if (contour.loop_count < 2) return std::nullopt;
    for (const unsigned diagonal : {0U, 1U}) {
        for (const double sign : {1.0, -1.0}) {
            const auto joining = find_joining(u, diagonal, sign);
            if (!joining) continue;
            const auto loops = find_loops(contour, u, *joining);
            if (loops) return Tunnel{(*loops)[0], (*loops)[1], ring_around(u, *joining)};
        }
    }
    return std::nullopt;
}

}  // namespace nestgrid::engine
