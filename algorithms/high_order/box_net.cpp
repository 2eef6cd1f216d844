// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/box_net.hpp>

#include <algorithm>
#include <cmath>

namespace nestgrid::engine {

namespace {

using Index = std::ptrdiff_t;

/// How a net is laid out seen along one direction: `outer` blocks of `count` rows of `stride`.
struct Lines {
    Index count;
    Index stride = 1;
    Index outer = 1;

    Lines(int degree, int dimension, int direction) : count{degree + 1} {
        for (int d = 0; d < direction; ++d) stride *= count;
        for (int d = direction + 1; d < dimension; ++d) outer *= count;
    }
    Index block() const { return count * stride; }
};

using Matrix = std::vector<double>;  // square, row by row

/// Weights of the Bernstein polynomials of degree p at a point.
void bernstein_weights(int degree, double at, double* weight) {
    std::fill_n(weight, degree + 1, 0.0);
    weight[0] = 1;
    for (int q = 1; q <= degree; ++q) {
        for (int k = q; k > 0; --k) weight[k] = (1 - at) * weight[k] + at * weight[k - 1];
        weight[0] *= 1 - at;
    }
}

/// The inverse of a matrix, by elimination with pivots.
Matrix inverse(Matrix a, Index n) {
    Matrix b(a.size(), 0.0);
    const auto row = [n](Matrix& m, Index r) { return m.begin() + r * n; };
    for (Index i = 0; i < n; ++i) row(b, i)[i] = 1;
    for (Index c = 0; c < n; ++c) {
        Index pivot = c;
        for (Index r = c; r < n; ++r) {
            if (std::abs(row(a, r)[c]) > std::abs(row(a, pivot)[c])) pivot = r;
        }
        for (Matrix* m : {&a, &b}) {
            std::swap_ranges(row(*m, c), row(*m, c) + n, row(*m, pivot));
        }
        const double by = 1 / row(a, c)[c];
        for (Matrix* m : {&a, &b}) {
            std::for_each(row(*m, c), row(*m, c) + n, [by](double& x) { x *= by; });
        }
        for (Index r = 0; r < n; ++r) {
            const double f = row(a, r)[c];
            if (r == c || f == 0) continue;
            for (Matrix* m : {&a, &b}) {
                for (Index k = 0; k < n; ++k) row(*m, r)[k] -= f * row(*m, c)[k];
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

/// The ends, and where the derivative of Legendre's polynomial vanishes.
std::vector<double> find_lobatto_points(int degree) {
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

/// What belongs to one degree.
struct OfDegree {
    std::vector<double> points;
    Matrix to_coefficients;

    explicit OfDegree(int degree) : points{find_lobatto_points(degree)} {
        const Index n = degree + 1;
        Matrix at_points(static_cast<std::size_t>(n * n));
        for (Index i = 0; i < n; ++i) {
            bernstein_weights(degree, points[static_cast<std::size_t>(i)],
                              at_points.data() + i * n);
        }
        to_coefficients = inverse(at_points, n);
    }
};

const OfDegree& of_degree(int degree) {
    static const std::vector<OfDegree> all = [] {
        std::vector<OfDegree> made;
        for (int p = 1; p <= max_degree; ++p) made.emplace_back(p);
        return made;
    }();
    return all[static_cast<std::size_t>(degree - 1)];
}

/// Halves one line of coefficients in place: it becomes the upper half.
inline void halve_line(double* line, Index count, double* lower) {
    lower[0] = line[0];
    for (Index k = 1; k < count; ++k) {
        for (Index i = 0; i < count - k; ++i) line[i] = (line[i] + line[i + 1]) / 2;
        lower[k] = line[0];
    }
}

/// The same of `stride` lines side by side.
inline void halve_lines(double* lines, Index count, Index stride, double* lower) {
    for (Index i = 0; i < stride; ++i) lower[i] = lines[i];
    for (Index k = 1; k < count; ++k) {
        const Index left = stride * (count - k);
        for (Index i = 0; i < left; ++i) lines[i] = (lines[i] + lines[i + stride]) / 2;
        for (Index i = 0; i < stride; ++i) lower[k * stride + i] = lines[i];
    }
}

/// Halves along one direction. `lower` and `upper` may each be the net itself, but not both.
void halve(const double* net, const Lines& lines, double* lower, double* upper) {
    if (upper != net) std::copy_n(net, lines.outer * lines.block(), upper);
    for (Index o = 0; o < lines.outer; ++o) {
        const Index at = o * lines.block();
        if (lines.stride == 1) {
            halve_line(upper + at, lines.count, lower + at);
        } else {
            halve_lines(upper + at, lines.count, lines.stride, lower + at);
        }
    }
}

}  // namespace

NetFacts net_facts(const double* net, int degree, int dimension) {
    const auto size = static_cast<Index>(net_size(degree, dimension));
    NetFacts facts{0, net[0], net[0]};
    for (Index i = 1; i < size; ++i) {
        facts.least = std::min(facts.least, net[i]);
        facts.greatest = std::max(facts.greatest, net[i]);
    }
    double above = 0;
    double below = 0;
    for (int d = 0; d < dimension; ++d) {
        const Lines lines(degree, dimension, d);
        double most = 0;
        double least = 0;
        for (Index o = 0; o < lines.outer; ++o) {
            const double* const at = net + o * lines.block();
            for (Index i = 0; i < lines.stride * (lines.count - 2); ++i) {
                const double second = at[i] - 2 * at[i + lines.stride] + at[i + 2 * lines.stride];
                most = std::max(most, second);
                least = std::min(least, second);
            }
        }
        above += most;
        below -= least;
    }
    facts.beta = degree * (degree - 1) * std::max(above, below) / 8;
    return facts;
}

double distance_from_affine(const double* net, int degree, int dimension,
                            std::span<const double> affine) {
    const Index n = degree + 1;
    const Index rows = static_cast<Index>(net_size(degree, dimension)) / n;
    const double step = 1.0 / degree;
    const double first = affine[1] * step;
    double greatest = 0;
    for (Index row = 0; row < rows; ++row) {
        double base = affine[0] - affine[1] / 2;
        Index left = row;
        for (int d = 1; d < dimension; ++d, left /= n) {
            base += affine[static_cast<std::size_t>(d) + 1] *
                    (static_cast<double>(left % n) * step - 0.5);
        }
        for (Index i = 0; i < n; ++i) {
            const double off = net[row * n + i] - base - first * static_cast<double>(i);
            greatest = std::max(greatest, std::abs(off));
        }
    }
    return greatest;
}

AffineFit fit_affine(std::span<const double> corners, int dimension) {
    AffineFit fit;
    const double share = 1.0 / static_cast<double>(corners.size());
    const auto side = [](std::size_t k, int d) { return (k >> d & 1U) != 0 ? 0.5 : -0.5; };
    for (std::size_t k = 0; k < corners.size(); ++k) {
        fit.affine[0] += share * corners[k];
        for (int d = 0; d < dimension; ++d) {
            fit.affine[static_cast<std::size_t>(d) + 1] += 4 * share * side(k, d) * corners[k];
        }
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
        double at = fit.affine[0];
        for (int d = 0; d < dimension; ++d) {
            at += fit.affine[static_cast<std::size_t>(d) + 1] * side(k, d);
        }
        fit.residual = std::max(fit.residual, std::abs(corners[k] - at));
    }
    return fit;
}

void halve_all(const double* net, int degree, int dimension, double* halves) {
    const std::size_t size = net_size(degree, dimension);
    std::copy_n(net, size, halves);
    for (int d = 0; d < dimension; ++d) {
        const Lines lines(degree, dimension, d);
        const std::size_t made = std::size_t{1} << d;
        for (std::size_t k = made; k-- > 0;) {
            double* const lower = halves + k * size;
            halve(lower, lines, lower, halves + (k + made) * size);
        }
    }
}

void keep_half(double* net, int degree, int dimension, int direction, unsigned half) {
    std::array<double, (max_degree + 1) * (max_degree + 1) * (max_degree + 1)> other;
    const Lines lines(degree, dimension, direction);
    halve(net, lines, half == 0 ? net : other.data(), half == 0 ? other.data() : net);
}

double net_value(const double* net, int degree, int dimension, std::span<const double> at) {
    std::array<double, (max_degree + 1) * (max_degree + 1) * (max_degree + 1)> left;
    std::size_t size = net_size(degree, dimension);
    std::copy_n(net, size, left.begin());
    const auto n = static_cast<std::size_t>(degree) + 1;
    for (int d = 0; d < dimension; ++d) {
        const double t = at[static_cast<std::size_t>(d)];
        size /= n;
        for (std::size_t row = 0; row < size; ++row) {
            left[row] = line_value(left.data() + row * n, degree, t);
        }
    }
    return left[0];
}

void to_coefficients(double* net, int degree, int dimension) {
    const Matrix& matrix = of_degree(degree).to_coefficients;
    std::array<double, max_degree + 1> line;
    for (int d = 0; d < dimension; ++d) {
        const Lines lines(degree, dimension, d);
        for (Index o = 0; o < lines.outer; ++o) {
            for (Index s = 0; s < lines.stride; ++s) {
                double* const at = net + o * lines.block() + s;
                for (Index r = 0; r < lines.count; ++r) {
                    double sum = 0;
                    for (Index k = 0; k < lines.count; ++k) {
                        sum += matrix[static_cast<std::size_t>(r * lines.count + k)] *
                               at[k * lines.stride];
                    }
                    line[static_cast<std::size_t>(r)] = sum;
                }
                // The ends are values: exactly those that are given.
                for (Index r = 1; r + 1 < lines.count; ++r) {
                    at[r * lines.stride] = line[static_cast<std::size_t>(r)];
                }
            }
        }
    }
}

std::span<const double> lobatto_points(int degree) { return of_degree(degree).points; }

std::vector<Point> lobatto_grid(int degree, int dimension) {
    const std::span<const double> points = lobatto_points(degree);
    std::vector<Point> grid(net_size(degree, dimension), Point{0, 0, 0});
    for (std::size_t i = 0; i < grid.size(); ++i) {
        std::size_t left = i;
        for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
            grid[i][d] = points[left % points.size()];
            left /= points.size();
        }
    }
    return grid;
}

std::vector<double> elevated(const double* net, int degree, int dimension, int to_degree) {
    std::vector<double> result(net, net + net_size(degree, dimension));
    for (int p = degree; p < to_degree; ++p) {
        for (int d = 0; d < dimension; ++d) {
            // Directions before d have p + 2 coefficients already.
            Index stride = 1;
            for (int e = 0; e < d; ++e) stride *= p + 2;
            const Index count = p + 1;
            const Index outer = static_cast<Index>(result.size()) / (count * stride);
            std::vector<double> more(static_cast<std::size_t>(outer * (count + 1) * stride));
            for (Index o = 0; o < outer; ++o) {
                for (Index k = 0; k <= count; ++k) {
                    const double share = static_cast<double>(k) / static_cast<double>(count);
                    for (Index s = 0; s < stride; ++s) {
                        const auto at = [&](Index i) {
                            return result[static_cast<std::size_t>((o * count + i) * stride + s)];
                        };
                        more[static_cast<std::size_t>((o * (count + 1) + k) * stride + s)] =
                            (k > 0 ? share * at(k - 1) : 0.0) +
                            (k < count ? (1 - share) * at(k) : 0.0);
                    }
                }
            }
            result = std::move(more);
        }
    }
    return result;
}

}  // namespace nestgrid::engine
