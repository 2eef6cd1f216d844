// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A modal space of one's own: in each cell of [-1, 1]^3 Taylor's polynomial, of a degree of its
// own, around the middle. It is discontinuous, and drawn within tolerances without a crack.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

using namespace nestgrid;
using Place = std::array<std::uint32_t, 3>;
constexpr std::uint32_t n = 4;  // cells along each direction
Place place(std::uint32_t cell) { return {cell % n, cell / n % n, cell / (n * n)}; }

struct Cells {
    using Element = std::uint32_t;
    static constexpr int dimension = 3;

    std::size_t coarse_count() const { return n * n * n; }
    CoarseElement<Element> coarse(std::size_t i) const {
        CoarseElement<Element> c{static_cast<Element>(i), Shape::hexahedron};
        for (std::uint32_t k = 0; k < 8; ++k) {
            Place at = place(c.element);
            for (std::size_t d = 0; d < 3; ++d) {
                at[d] += k >> d & 1U;
                c.corners[k][d] = -1 + 2.0 * at[d] / n;
            }
            c.ids[k] = at[0] + (n + 1) * (at[1] + (n + 1) * at[2]);
        }
        return c;
    }
    const Rule* split(Element) const { return nullptr; }
    void children(Element, std::span<Element> out) const { std::ranges::fill(out, 0U); }
};

/// Taylor's polynomial of degree p of sin(2 x) around a.
double taylor(double x, double a, int p) {
    double sum = 0;
    double term = 1;
    for (int k = 0; k <= p; term *= 2 * (x - a) / ++k) sum += term * std::sin(2 * a + k * M_PI_2);
    return sum;
}

// [own_high_order]
struct Modes {
    using value_type = double;

    int degree(std::uint32_t cell) const { return 3 + static_cast<int>(cell % 4); }
    void evaluate(std::uint32_t cell, std::span<const Point> x, std::span<double> out) const {
        std::ranges::fill(out, 0.0);
        for (std::size_t i = 0; i < 3 * out.size(); ++i) {
            const double low = -1 + 2.0 * place(cell)[i % 3] / n;
            out[i / 3] += taylor(low + 2 * x[i / 3][i % 3] / n, low + 1.0 / n, degree(cell));
        }
    }
    // A discontinuous field has several values at a node. Nothing below asks for them.
    NodeMask coarse_values(std::size_t, std::span<double>) const { return ~NodeMask{0}; }
    NodeMask new_values(std::uint32_t, NodeMask, std::span<double>) const { return ~NodeMask{0}; }
};

int main() {
    const Cells cells;
    const Modes modes;
    const HighOrder data(cells, modes);
    std::printf("degree %d, jumps of %.4f\n", data.greatest_degree(), data.jump());
    for (const double tolerance : {0.1, 0.01, 0.001}) {
        const VirtualRefinement fine(data, {.tolerance = tolerance});
        const auto result = isosurface<3>(fine, 0.5, under(fine.criterion(), fine.bounds()));
        std::printf("tolerance %5.3f: %5zu triangles, %zu open edges, at most %.4f off\n",
                    tolerance, result.surface.simplices.size(),
                    surface_report(result.surface).open_edges, result.error_bound);
    }
}
// [own_high_order]
