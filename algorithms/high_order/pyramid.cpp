// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/pyramid.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nestgrid::engine {

namespace {

constexpr Factors box{3, {1, 1, 1}};
constexpr Factors triangle{1, {2}};
constexpr std::size_t triangles = 4;

/// The fixed one of a and b on a triangle of the pyramid, and where: topology()'s faces 1 to 4.
struct TriangleAt {
    std::size_t fixed;
    int at;
};
constexpr std::array<TriangleAt, triangles> triangle_at{{{1, 0}, {0, 1}, {1, 1}, {0, 0}}};

/// Whether a corner lies on a triangle, whose other coordinate is its own one.
bool lies_on(const Place& corner, const TriangleAt& t) {
    return corner[2] == 1 || corner[t.fixed] == t.at;
}

/// Coefficients on a triangle of the pyramid as on a quadrilateral that is collapsed likewise.
double on_quadrilateral(const double* net, std::size_t degree, const TriangleAt& t, std::size_t i,
                        std::size_t k) {
    const std::size_t n = degree + 1;
    const std::size_t fixed = t.at == 1 ? degree : 0;
    return t.fixed == 0 ? net[fixed + n * (i + n * k)] : net[i + n * (fixed + n * k)];
}

/// (1 - c) times the derivative along x, y or z, in coefficients of the same degree.
std::vector<double> slope(std::span<const double> net, int degree, std::size_t axis) {
    const auto n = static_cast<std::size_t>(degree) + 1;
    const std::array<std::size_t, 3> stride{1, n, n * n};
    std::vector<double> out(net.size(), 0.0);
    for (std::size_t i = 0; i < net.size(); ++i) {
        // p times the differences to both sides along an axis of the box, with their shares.
        const auto add = [&](std::size_t along, bool falling, bool rising) {
            const std::size_t at = i / stride[along] % n;
            if (falling && at > 0) {
                out[i] += static_cast<double>(at) * (net[i] - net[i - stride[along]]);
            }
            if (rising && at + 1 < n) {
                out[i] += static_cast<double>(n - 1 - at) * (net[i + stride[along]] - net[i]);
            }
        };
        if (axis < 2) {
            add(axis, true, true);
        } else {
            add(0, true, false);  // a times the derivative along a
            add(1, true, false);  // b times that along b
            add(2, false, true);  // 1 - c times that along c
        }
    }
    return out;
}

}  // namespace

Point point_at(const Place& at, int level) {
    Point x;
    for (std::size_t d = 0; d < 3; ++d) x[d] = std::ldexp(static_cast<double>(at[d]), -level);
    return x;
}

Point collapsed(const Point& x) {
    const double width = 1 - x[2];
    if (!(width > 0)) return {0, 0, 1};
    return {x[0] / width, x[1] / width, x[2]};
}

std::vector<Point> pyramid_points(int degree) {
    std::vector<Point> points = net_points(degree, box);
    for (Point& x : points) x = {x[0] * (1 - x[2]), x[1] * (1 - x[2]), x[2]};
    return points;
}

CollapsedBox::CollapsedBox(std::span<const Place> points, int level) : low{1, 1, 1}, high{0, 0, 0} {
    for (const Place& at : points) {
        const Point x = collapsed(point_at(at, level));
        for (std::size_t d = 0; d < 3; ++d) {
            low[d] = std::min(low[d], x[d]);
            high[d] = std::max(high[d], x[d]);
        }
    }
}

void CollapsedBox::restrict_net(const double* net, int degree, double* out) const {
    NetPart part;
    for (std::size_t d = 0; d < 3; ++d) {
        part.corner[d][0] = {1 - low[d], low[d], 0, 0};
        part.corner[d][1] = {1 - high[d], high[d], 0, 0};
        part.corners[d] = 2;
    }
    engine::restrict_net(net, degree, box, part, out);
}

double CollapsedBox::distance_from_affine(const double* net, int degree,
                                          std::span<const Point, 4> x,
                                          std::span<const double, 4> u) const {
    const Point across = cross(x[2] - x[0], x[3] - x[0]);
    const double size = 1 / dot(x[1] - x[0], across);
    const Point gradient =
        size * ((u[1] - u[0]) * across + (u[2] - u[0]) * cross(x[3] - x[0], x[1] - x[0]) +
                (u[3] - u[0]) * cross(x[1] - x[0], x[2] - x[0]));
    // Its coefficients are its values at their places, as it has degree 1 in each of a, b and c.
    double greatest = 0;
    std::size_t next = 0;
    const auto at = [&](std::size_t d, int i) { return low[d] + (high[d] - low[d]) * i / degree; };
    for (int k = 0; k <= degree; ++k) {
        const double width = 1 - at(2, k);
        for (int j = 0; j <= degree; ++j) {
            for (int i = 0; i <= degree; ++i) {
                const Point there{at(0, i) * width, at(1, j) * width, at(2, k)};
                const double affine = u[0] + dot(gradient, there - x[0]);
                greatest = std::max(greatest, std::abs(net[next++] - affine));
            }
        }
    }
    return greatest;
}

std::size_t triangle_nets_size(int degree) { return triangles * net_size(degree, triangle); }

double put_triangle_nets(const double* net, int degree, double* out) {
    const auto p = static_cast<std::size_t>(degree);
    double off = 0;
    for (const TriangleAt& t : triangle_at) {
        // Row k is a polynomial of degree p - k in the coefficients of degree p: it loses a degree
        // after the other, from both sides, which the rounding of the middle does not leave.
        for (std::size_t k = 0; k <= p; ++k) {
            std::vector<double> row(p + 1);
            for (std::size_t i = 0; i <= p; ++i) row[i] = on_quadrilateral(net, p, t, i, k);
            for (std::size_t q = p; q > p - k; --q) {
                const auto share = [&](std::size_t i) {
                    return static_cast<double>(i) / static_cast<double>(q);
                };
                std::vector<double> less(q);
                for (std::size_t i = 0; 2 * i < q; ++i) {
                    const double before = i > 0 ? share(i) * less[i - 1] : 0;
                    less[i] = (row[i] - before) / (1 - share(i));
                }
                for (std::size_t i = q; 2 * i > q + 1; --i) {
                    const double after = i < q ? (1 - share(i)) * less[i] : 0;
                    less[i - 1] = (row[i] - after) / share(i);
                }
                row = less;
            }
            for (std::size_t i = 0; i + k <= p; ++i) {
                out[net_index(degree, triangle, {static_cast<int>(i), static_cast<int>(k), 0})] =
                    row[i];
            }
            const std::vector<double> again =
                elevated(row.data(), degree - static_cast<int>(k), {1, {1}}, degree);
            for (std::size_t i = 0; i <= p; ++i) {
                off = std::max(off, std::abs(again[i] - on_quadrilateral(net, p, t, i, k)));
            }
        }
        out += net_size(degree, triangle);
    }
    return off;
}

void take_pyramid_part(const double* net, const double* triangle_nets, int degree,
                       std::span<const Place> frame, const Factors& part, double* out) {
    const bool on_base =
        std::all_of(frame.begin(), frame.end(), [](const Place& corner) { return corner[2] == 0; });
    if (on_base) return take_part(net, degree, box, frame, part, out);
    std::size_t number = 0;
    while (!std::all_of(frame.begin(), frame.end(), [&](const Place& corner) {
        return lies_on(corner, triangle_at[number]);
    })) {
        ++number;
    }
    std::array<Place, 3> in_triangle{};
    for (std::size_t i = 0; i < frame.size(); ++i) {
        in_triangle[i] = {frame[i][1 - triangle_at[number].fixed], frame[i][2], 0};
    }
    take_part(triangle_nets + number * net_size(degree, triangle), degree, triangle,
              std::span<const Place>(in_triangle).first(frame.size()), part, out);
}

PyramidCurvature::PyramidCurvature(const double* net, int degree) : degree_{degree} {
    const std::span<const double> u(net, net_size(degree, box));
    std::size_t next = 0;
    for (std::size_t second = 0; second < 3; ++second) {
        const std::vector<double> first = slope(u, degree, second);
        for (std::size_t axis = 0; axis <= second; ++axis) {
            // The derivative of (1 - c) along z is -1.
            second_[next] = slope(first, degree, axis);
            for (std::size_t i = 0; axis == 2 && i < first.size(); ++i) {
                second_[next][i] += first[i];
            }
            ++next;
        }
    }
    // slope() of second before axis: xx; xy, yy; xz, yz, zz.
}

/// The greatest second derivative in a box, over a step.
double PyramidCurvature::second_along(const CollapsedBox& around, const Point& step) const {
    NetRoom along{};
    NetRoom there{};
    const std::size_t size = net_size(degree_, box);
    for (std::size_t i = 0; i < size; ++i) {
        const auto at = [&](std::size_t which) { return second_[which][i]; };
        along[i] = step[0] * (step[0] * at(0) + 2 * step[1] * at(1)) + step[1] * step[1] * at(2) +
                   step[2] * (2 * (step[0] * at(3) + step[1] * at(4)) + step[2] * at(5));
    }
    around.restrict_net(along.data(), degree_, there.data());
    double greatest = 0;
    for (std::size_t i = 0; i < size; ++i) greatest = std::max(greatest, std::abs(there[i]));
    const double width = 1 - around.high[2];
    return greatest / (width * width);
}

double PyramidCurvature::beta(Shape shape, std::span<const Place> x, int level) const {
    const CollapsedBox around(x, level);
    if (!(around.high[2] < 1)) return std::numeric_limits<double>::infinity();
    double greatest = 0;
    double sum = 0;
    const auto add = [&](std::size_t a, std::size_t b) {
        const Place step{x[b][0] - x[a][0], x[b][1] - x[a][1], x[b][2] - x[a][2]};
        const double second = second_along(around, point_at(step, level));
        greatest = std::max(greatest, second);
        sum += second;
        return second;
    };
    if (shape == Shape::quadrilateral) return (add(0, 1) + add(0, 2)) / 8;
    if (shape == Shape::pyramid) {  // the tetrahedra 0124 and 1243, whose base is a parallelogram
        const double shared = add(0, 1) + add(0, 2) + add(1, 2) + add(1, 4) + add(2, 4);
        sum = shared + std::max(add(0, 4), add(3, 4));
    } else {
        const Topology& t = topology(shape);
        for (std::size_t e = 0; e < t.edges; ++e) add(t.edge[e][0], t.edge[e][1]);
    }
    const double share = shape == Shape::segment    ? 1.0 / 8
                         : shape == Shape::triangle ? 5.0 / 18
                                                    : 3.0 / 8;
    return std::min(sum / 8, share * greatest);
}

}  // namespace nestgrid::engine
