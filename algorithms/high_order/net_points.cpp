// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nets and values at points.
#include <algorithm>
#include <cmath>
#include <utility>

#include <high_order/net.hpp>

namespace nestgrid::engine {

namespace {

using NetMatrix = std::vector<double>;  // square, row by row

/// The inverse of a matrix, by elimination with pivots.
NetMatrix inverse(NetMatrix a, std::size_t size) {
    const auto n = static_cast<std::ptrdiff_t>(size);
    NetMatrix b(a.size(), 0.0);
    const auto row = [n](NetMatrix& m, std::ptrdiff_t r) { return m.begin() + r * n; };
    for (std::ptrdiff_t i = 0; i < n; ++i) row(b, i)[i] = 1;
    for (std::ptrdiff_t c = 0; c < n; ++c) {
        std::ptrdiff_t pivot = c;
        for (std::ptrdiff_t r = c; r < n; ++r) {
            if (std::abs(row(a, r)[c]) > std::abs(row(a, pivot)[c])) pivot = r;
        }
        for (NetMatrix* m : {&a, &b}) {
            std::swap_ranges(row(*m, c), row(*m, c) + n, row(*m, pivot));
        }
        const double by = 1 / row(a, c)[c];
        for (NetMatrix* m : {&a, &b}) {
            std::for_each(row(*m, c), row(*m, c) + n, [by](double& x) { x *= by; });
        }
        for (std::ptrdiff_t r = 0; r < n; ++r) {
            const double f = row(a, r)[c];
            if (r == c || f == 0) continue;
            for (NetMatrix* m : {&a, &b}) {
                for (std::ptrdiff_t k = 0; k < n; ++k) row(*m, r)[k] -= f * row(*m, c)[k];
            }
        }
    }
    return b;
}

/// Legendre's polynomial of degree p and its derivative, times x^2 - 1, at x in (-1, 1).
std::pair<double, double> legendre(int degree, double x) {
    double before = 1;
    double at = x;
    for (int k = 2; k <= degree; ++k) {
        before = std::exchange(at, ((2 * k - 1) * x * at - (k - 1) * before) / k);
    }
    return {at, degree * (x * at - before)};
}

/// The ends, and where the derivative of Legendre's polynomial vanishes, in [0, 1].
std::vector<double> lobatto_points(int degree) {
    std::vector<double> points(static_cast<std::size_t>(degree) + 1);
    for (int i = 0; i <= degree; ++i) {
        double x = -std::cos(std::acos(-1.0) * i / degree);
        for (int step = 0; step < 60 && i > 0 && i < degree; ++step) {
            const auto [value, derivative] = legendre(degree, x);
            x -= derivative / (degree * (degree + 1) * value);
        }
        points[static_cast<std::size_t>(i)] = (1 + x) / 2;
    }
    for (std::size_t i = 0; 2 * i <= points.size(); ++i) {
        points[points.size() - 1 - i] = 1 - points[i];
    }
    return points;
}

using Barycentric = std::array<double, 4>;

double bernstein(const SimplexIndex::Alpha& alpha, const Barycentric& at) {
    double value = 1;
    int dealt = 0;
    for (std::size_t c = 0; c < 4; ++c) {
        for (int i = 1; i <= alpha[c]; ++i) value *= at[c] * ++dealt / i;
    }
    return value;
}

/// The points of one simplex and degree, and the matrix from values there to coefficients.
struct NetPoints {
    std::vector<Barycentric> point;
    NetMatrix to_coefficients;
    /// The others are values at corners: exactly those that are given.
    std::vector<std::size_t> between_corners;

    NetPoints(std::size_t dimension, int degree) {
        const auto& alpha = simplex_index(dimension, degree).alpha;
        const std::vector<double> along = lobatto_points(degree);
        for (const auto& a : alpha) {
            Barycentric& at = point.emplace_back();
            for (std::size_t c = 0; c < 4; ++c) at[c] = static_cast<double>(a[c]) / degree;
            if (dimension == 1) at = {1 - along[a[1]], along[a[1]], 0, 0};
        }
        NetMatrix at_points;
        for (const Barycentric& at : point) {
            for (const auto& a : alpha) at_points.push_back(bernstein(a, at));
        }
        to_coefficients = inverse(std::move(at_points), alpha.size());
        for (std::size_t i = 0; i < alpha.size(); ++i) {
            const auto& a = alpha[i];
            if (std::find(a.begin(), a.end(), degree) == a.end()) between_corners.push_back(i);
        }
    }
};

const NetPoints& net_points_of(std::size_t dimension, int degree) {
    static const auto all = [] {
        std::vector<NetPoints> made;
        for (std::size_t d = 1; d <= 3; ++d) {
            for (int p = 1; p <= max_degree; ++p) made.emplace_back(d, p);
        }
        return made;
    }();
    return all[(dimension - 1) * max_degree + static_cast<std::size_t>(degree - 1)];
}

/// Puts the sums of some rows, times their shares.
void put_sums(const double* rows, const Lanes& lanes, const double* shares, double* out) {
    std::size_t i = 0;
    for (; i + 4 <= lanes.stride; i += 4) {
        std::array<double, 4> sum{};
        for (std::size_t k = 0; k < lanes.count; ++k) {
            for (std::size_t j = 0; j < 4; ++j)
                sum[j] += shares[k] * rows[k * lanes.stride + i + j];
        }
        std::copy(sum.begin(), sum.end(), out + i);
    }
    for (; i < lanes.stride; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < lanes.count; ++k) sum += shares[k] * rows[k * lanes.stride + i];
        out[i] = sum;
    }
}

/// Halves lines of coefficients side by side in place: they become the upper halves.
void halve_lines(double* lines, std::size_t count, std::size_t stride, double* lower) {
    for (std::size_t i = 0; i < stride; ++i) lower[i] = lines[i];
    for (std::size_t k = 1; k < count; ++k) {
        const std::size_t left = stride * (count - k);
        for (std::size_t i = 0; i < left; ++i) lines[i] = (lines[i] + lines[i + stride]) / 2;
        for (std::size_t i = 0; i < stride; ++i) lower[k * stride + i] = lines[i];
    }
}

/// A point in all factors: de Casteljau's algorithm, one factor after the other.
NetPart point_part(const Factors& whole, const Point& at) {
    NetPart part;
    std::size_t axis = 0;
    for (std::size_t f = 0; f < whole.count; ++f) {
        Barycentric& own = part.corner[f][0];
        own[0] = 1;
        for (std::size_t d = 0; d < whole.dimension[f]; ++d) {
            own[d + 1] = at[axis++];
            own[0] -= own[d + 1];
        }
        part.corners[f] = 1;
    }
    return part;
}

}  // namespace

std::vector<Point> net_points(int degree, const Factors& factors) {
    std::vector<Point> points(net_size(degree, factors), Point{0, 0, 0});
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::size_t left = i;
        std::size_t axis = 0;
        for (std::size_t f = 0; f < factors.count; ++f) {
            const auto& own = net_points_of(factors.dimension[f], degree).point;
            const Barycentric& at = own[left % own.size()];
            left /= own.size();
            for (std::size_t d = 0; d < factors.dimension[f]; ++d) points[i][axis++] = at[d + 1];
        }
    }
    return points;
}

void to_coefficients(double* net, int degree, const Factors& factors) {
    NetRoom values;
    for (std::size_t f = 0; f < factors.count; ++f) {
        const Lanes lanes(degree, factors, f);
        const NetPoints& points = net_points_of(factors.dimension[f], degree);
        for (std::size_t o = 0; o < lanes.outer; ++o) {
            double* const block = net + o * lanes.block();
            std::copy_n(block, lanes.block(), values.begin());
            for (const std::size_t r : points.between_corners) {
                const double* const shares = points.to_coefficients.data() + r * lanes.count;
                put_sums(values.data(), lanes, shares, block + r * lanes.stride);
            }
        }
    }
}

std::vector<double> elevated(const double* net, int degree, const Factors& factors, int to_degree) {
    std::vector<double> result(net, net + net_size(degree, factors));
    for (int p = degree; p < to_degree; ++p) {
        std::size_t stride = 1;
        for (std::size_t f = 0; f < factors.count; ++f) {
            const auto& alpha = simplex_index(factors.dimension[f], p).alpha;
            const auto& raised = simplex_index(factors.dimension[f], p + 1).raised;
            const std::size_t made = simplex_size(p + 1, factors.dimension[f]);
            const std::size_t outer = result.size() / (alpha.size() * stride);
            std::vector<double> more(outer * made * stride, 0.0);
            for (std::size_t o = 0; o < outer; ++o) {
                for (std::size_t i = 0; i < alpha.size(); ++i) {
                    for (std::size_t c = 0; c <= factors.dimension[f]; ++c) {
                        const double share = (alpha[i][c] + 1.0) / (p + 1);
                        for (std::size_t s = 0; s < stride; ++s) {
                            more[(o * made + raised[i][c]) * stride + s] +=
                                share * result[(o * alpha.size() + i) * stride + s];
                        }
                    }
                }
            }
            result = std::move(more);
            stride *= made;
        }
    }
    return result;
}

void halve_all(const double* net, int degree, std::size_t dimension, double* halves) {
    const Factors box{dimension, {1, 1, 1}};
    const std::size_t size = net_size(degree, box);
    std::copy_n(net, size, halves);
    for (std::size_t d = 0; d < dimension; ++d) {
        const Lanes lanes(degree, box, d);
        const std::size_t made = std::size_t{1} << d;
        for (std::size_t k = made; k-- > 0;) {
            double* const lower = halves + k * size;
            double* const upper = halves + (k + made) * size;
            std::copy_n(lower, size, upper);
            for (std::size_t o = 0; o < lanes.outer; ++o) {
                halve_lines(upper + o * lanes.block(), lanes.count, lanes.stride,
                            lower + o * lanes.block());
            }
        }
    }
}

double net_value(const double* net, int degree, const Factors& factors, const Point& at) {
    double value = 0;
    restrict_net(net, degree, factors, point_part(factors, at), &value);
    return value;
}

Point net_gradient(const double* net, int degree, const Factors& factors, const Point& at) {
    Point gradient{0, 0, 0};
    std::size_t axis = 0;
    for (std::size_t f = 0; f < factors.count; ++f) {
        // The whole factor, and a point in the others: a net whose polar form at degree - 1 times
        // the point, then a corner, is linear in the corner.
        NetPart line = point_part(factors, at);
        const Barycentric here = line.corner[f][0];
        const std::size_t dimension = factors.dimension[f];
        for (std::size_t c = 0; c <= dimension; ++c) {
            line.corner[f][c] = {};
            line.corner[f][c][c] = 1;
        }
        line.corners[f] = static_cast<std::uint8_t>(dimension + 1);
        NetRoom along;
        restrict_net(net, degree, factors, line, along.data());
        for (int q = degree; q > 1; --q) {
            const auto& raised = simplex_index(dimension, q).raised;
            for (std::size_t i = 0; i < raised.size(); ++i) {
                double sum = 0;
                for (std::size_t c = 0; c <= dimension; ++c) sum += here[c] * along[raised[i][c]];
                along[i] = sum;
            }
        }
        for (std::size_t d = 0; d < dimension; ++d) {
            gradient[axis++] = degree * (along[d + 1] - along[0]);
        }
    }
    return gradient;
}

}  // namespace nestgrid::engine
