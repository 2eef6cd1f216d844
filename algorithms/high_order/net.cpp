// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/net.hpp>

#include <algorithm>
#include <cmath>

namespace nestgrid::engine {

namespace {

using Alpha = SimplexIndex::Alpha;

std::vector<Alpha> multi_indices(std::size_t dimension, int degree) {
    std::vector<Alpha> all;
    const int most = dimension > 0 ? degree : 0;
    for (int k = 0; k <= (dimension > 2 ? most : 0); ++k) {
        for (int j = 0; j + k <= (dimension > 1 ? most : k); ++j) {
            for (int i = 0; i + j + k <= (dimension > 0 ? most : j + k); ++i) {
                all.push_back({static_cast<std::uint8_t>(degree - i - j - k),
                               static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j),
                               static_cast<std::uint8_t>(k)});
            }
        }
    }
    return all;
}

SimplexIndex make_index(std::size_t dimension, int degree) {
    SimplexIndex index;
    index.alpha = multi_indices(dimension, degree);
    for (std::size_t i = 0; i < index.alpha.size(); ++i) {
        index.number[slot(index.alpha[i])] = static_cast<std::uint16_t>(i);
    }
    const auto number = [&](const Alpha& a) { return index.number[slot(a)]; };
    if (degree > 0) {
        for (const Alpha& a : multi_indices(dimension, degree - 1)) {
            auto& raised = index.raised.emplace_back();
            for (std::size_t c = 0; c <= dimension; ++c) raised[c] = number(with_one_more(a, c));
        }
    }
    for (std::size_t a = 0; degree > 1 && a <= dimension; ++a) {
        for (std::size_t b = a + 1; b <= dimension; ++b) {
            auto& second = index.second.emplace_back();
            for (const Alpha& low : multi_indices(dimension, degree - 2)) {
                const Alpha at_a = with_one_more(low, a);
                const Alpha at_b = with_one_more(low, b);
                second.push_back({number(with_one_more(at_a, a)), number(with_one_more(at_a, b)),
                                  number(with_one_more(at_b, b))});
            }
        }
    }
    return index;
}

/// Bounds of u - I u in one factor, above and below, by p (p - 1) times second differences.
struct NetSides {
    double above = 0;
    double below = 0;
};

/// Least and greatest second difference of some rows.
struct SecondRange {
    double least = 0;
    double greatest = 0;
};

void widen(SecondRange& range, double to) {
    range.least = std::min(range.least, to);
    range.greatest = std::max(range.greatest, to);
}

/// The least and the greatest of many numbers, four at a time.
class Extremes {
public:
    /// \param from a number of their range
    explicit Extremes(double from) {
        least_.fill(from);
        greatest_.fill(from);
    }
    /// \param number called with 0 to count - 1
    template <class Number>
    void add(std::size_t count, const Number& number) {
        std::size_t i = 0;
        for (; i + least_.size() <= count; i += least_.size()) {
            for (std::size_t k = 0; k < least_.size(); ++k) widen(k, number(i + k));
        }
        for (std::size_t k = 0; i + k < count; ++k) widen(k, number(i + k));
    }
    double least() const {
        return std::min(std::min(least_[0], least_[1]), std::min(least_[2], least_[3]));
    }
    double greatest() const {
        return std::max(std::max(greatest_[0], greatest_[1]), std::max(greatest_[2], greatest_[3]));
    }

private:
    void widen(std::size_t k, double to) {
        least_[k] = std::min(least_[k], to);
        greatest_[k] = std::max(greatest_[k], to);
    }

    std::array<double, 4> least_;
    std::array<double, 4> greatest_;
};

NetSides of_segment(const double* net, const Lanes& lanes) {
    Extremes second(0);
    for (std::size_t o = 0; o < lanes.outer; ++o) {
        const double* const at = net + o * lanes.block();
        second.add(lanes.stride * (lanes.count - 2), [&](std::size_t i) {
            return at[i] - 2 * at[i + lanes.stride] + at[i + 2 * lanes.stride];
        });
    }
    return {second.greatest() / 8, -second.least() / 8};
}

/// Along the edges of a triangle or tetrahedron D = middle + oscillation: in u - I u the middles
/// add up to at most k max, the oscillations to at most K max, and all to at most the sum / 8.
NetSides of_simplex(const double* net, const Lanes& lanes, const SimplexIndex& index,
                    std::size_t dimension) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double k = dimension == 2 ? 1.0 / 6 : 3.0 / 16;
    const double greatest_k = dimension == 2 ? 5.0 / 18 : 3.0 / 8;
    NetSides sum;
    NetSides middles;
    NetSides greatest_middle;
    double oscillations = 0;
    double greatest_oscillation = 0;
    for (const auto& second : index.second) {
        SecondRange range{infinity, -infinity};
        for (std::size_t o = 0; o < lanes.outer; ++o) {
            for (const auto& [a, b, c] : second) {
                const double* const at = net + o * lanes.block();
                for (std::size_t s = 0; s < lanes.stride; ++s) {
                    widen(range, at[a * lanes.stride + s] - 2 * at[b * lanes.stride + s] +
                                     at[c * lanes.stride + s]);
                }
            }
        }
        const double middle = (range.least + range.greatest) / 2;
        const double oscillation = (range.greatest - range.least) / 2;
        sum.above += std::max(range.greatest, 0.0);
        sum.below += std::max(-range.least, 0.0);
        middles.above += std::max(middle, 0.0);
        middles.below += std::max(-middle, 0.0);
        greatest_middle.above = std::max(greatest_middle.above, middle);
        greatest_middle.below = std::max(greatest_middle.below, -middle);
        oscillations += oscillation;
        greatest_oscillation = std::max(greatest_oscillation, oscillation);
    }
    const double other = std::min(oscillations / 8, greatest_k * greatest_oscillation);
    const double rounding = 1 + 1e-14;  // so that no edge has more
    return {rounding * std::min(sum.above / 8,
                                std::min(middles.above / 8, k * greatest_middle.above) + other),
            rounding * std::min(sum.below / 8,
                                std::min(middles.below / 8, k * greatest_middle.below) + other)};
}

}  // namespace

const SimplexIndex& simplex_index(std::size_t dimension, int degree) {
    static const auto all = [] {
        std::vector<SimplexIndex> made;
        for (std::size_t d = 0; d <= 3; ++d) {
            for (int p = 0; p <= max_degree; ++p) made.push_back(make_index(d, p));
        }
        return made;
    }();
    return all[dimension * (max_degree + 1) + static_cast<std::size_t>(degree)];
}

std::size_t net_index(int degree, const Factors& factors, const Place& at) {
    std::size_t index = 0;
    std::size_t stride = 1;
    std::size_t axis = 0;
    for (std::size_t f = 0; f < factors.count; ++f) {
        const std::size_t dimension = factors.dimension[f];
        std::size_t share = 0;
        for (std::size_t d = dimension; d-- > 0;) {
            share = 9 * share + static_cast<std::size_t>(at[axis + d]);
        }
        if (dimension > 1) share = simplex_index(dimension, degree).number[share];
        index += share * stride;
        stride *= simplex_size(degree, factors.dimension[f]);
        axis += dimension;
    }
    return index;
}

std::size_t net_corner(int degree, const Factors& factors, std::size_t corner) {
    Place at{};
    std::size_t axis = 0;
    for (std::size_t f = 0; f < factors.count; ++f) {
        const std::size_t dimension = factors.dimension[f];
        const std::size_t own = corner % (dimension + 1);
        corner /= dimension + 1;
        if (own > 0) at[axis + own - 1] = degree;
        axis += dimension;
    }
    return net_index(degree, factors, at);
}

NetFacts net_facts(const double* net, int degree, const Factors& factors) {
    const std::size_t size = net_size(degree, factors);
    Extremes all(net[0]);
    all.add(size, [net](std::size_t i) { return net[i]; });
    NetFacts facts{0, all.least(), all.greatest()};
    if (degree < 2) return facts;
    NetSides sum;
    for (std::size_t f = 0; f < factors.count; ++f) {
        const Lanes lanes(degree, factors, f);
        const std::size_t dimension = factors.dimension[f];
        const NetSides sides =
            dimension == 1 ? of_segment(net, lanes)
                           : of_simplex(net, lanes, simplex_index(dimension, degree), dimension);
        sum.above += sides.above;
        sum.below += sides.below;
    }
    facts.beta = degree * (degree - 1) * std::max(sum.above, sum.below);
    return facts;
}

AffineFit fit_affine(std::span<const double> corners, const Factors& factors) {
    AffineFit fit;
    const auto count = static_cast<double>(corners.size());
    double mean = 0;
    for (const double value : corners) mean += value / count;
    const auto number_in = [&](std::size_t corner, std::size_t factor) {
        for (std::size_t f = 0; f < factor; ++f) corner /= factors.dimension[f] + std::size_t{1};
        return corner % (factors.dimension[factor] + std::size_t{1});
    };
    for (std::size_t f = 0; f < factors.count; ++f) {
        const double share = (factors.dimension[f] + 1) / count;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            fit.part[f][number_in(k, f)] += share * corners[k];
        }
        for (double& value : fit.part[f]) value -= f == 0 ? 0 : mean;
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
        double at = 0;
        for (std::size_t f = 0; f < factors.count; ++f) at += fit.part[f][number_in(k, f)];
        fit.residual = std::max(fit.residual, std::abs(corners[k] - at));
    }
    return fit;
}

double distance_from_affine(const double* net, int degree, const Factors& factors,
                            const AffineFit& affine) {
    constexpr std::size_t most = simplex_size(max_degree, 3);
    std::array<std::array<double, most>, 3> at{};  // of each factor, at its Greville points
    std::array<std::size_t, 3> count{1, 1, 1};
    for (std::size_t f = 0; f < factors.count; ++f) {
        const auto& alpha = simplex_index(factors.dimension[f], degree).alpha;
        count[f] = alpha.size();
        for (std::size_t i = 0; i < alpha.size(); ++i) {
            at[f][i] = 0;
            for (std::size_t c = 0; c <= factors.dimension[f]; ++c) {
                at[f][i] += alpha[i][c] * affine.part[f][c];
            }
            at[f][i] /= degree;
        }
    }
    double greatest = 0;
    const double* row = net;
    for (std::size_t k = 0; k < count[2]; ++k) {
        for (std::size_t j = 0; j < count[1]; ++j, row += count[0]) {
            const double base = at[1][j] + at[2][k];
            for (std::size_t i = 0; i < count[0]; ++i) {
                greatest = std::max(greatest, std::abs(row[i] - (base + at[0][i])));
            }
        }
    }
    return greatest;
}

}  // namespace nestgrid::engine
