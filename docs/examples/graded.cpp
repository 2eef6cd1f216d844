// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A grid that is graded towards a wall: docs/graded_refinement.md goes through it.
#include <cmath>
#include <cstdio>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/rule.hpp>

using namespace nestgrid;

namespace {

// [rule]
/// Cuts a hexahedron at a quarter of its height, seen from its lower face.
Rule cut_near_the_wall() {
    const auto quarter = [](int low, int high) {
        return weighted_mean_of({{low, 0.75}, {high, 0.25}});
    };
    // The new nodes are 8 to 11.
    return make_rule("cut near the wall", Shape::hexahedron,
                     {quarter(0, 4), quarter(1, 5), quarter(2, 6), quarter(3, 7)},
                     {Child{.shape = Shape::hexahedron, .corner = {0, 1, 2, 3, 8, 9, 10, 11}},
                      Child{.shape = Shape::hexahedron, .corner = {8, 9, 10, 11, 4, 5, 6, 7}}});
}
// [rule]

/// Columns over the unit square with the wall at z = 0. Of each element that touches the wall the
/// lower child is cut again, most often in the middle of the square.
class BoundaryLayer {
public:
    struct Element {
        int column = 0;
        int cuts = 0;         // of the element itself and those above it
        bool at_wall = true;  // the upper children are leaves
    };
    static constexpr int dimension = 3;
    static constexpr int columns = 16;  // along x and y

    std::size_t coarse_count() const { return columns * columns; }
    CoarseElement<Element> coarse(std::size_t i) const {
        CoarseElement<Element> result{.element = {.column = static_cast<int>(i)},
                                      .shape = Shape::hexahedron};
        for (std::size_t k = 0; k < 8; ++k) {
            const std::size_t x = i % columns + (k & 1U);
            const std::size_t y = i / columns + (k >> 1U & 1U);
            const std::size_t z = k >> 2U;
            result.corners[k] = {double(x) / columns, double(y) / columns, double(z)};
            result.ids[k] = x + (columns + 1) * (y + (columns + 1) * z);
        }
        return result;
    }
    const Rule* split(const Element& e) const {
        return e.at_wall && e.cuts < greatest_cuts(e.column) ? &rule_ : nullptr;
    }
    void children(const Element& e, std::span<Element> out) const {
        out[0] = {e.column, e.cuts + 1, true};
        out[1] = {e.column, e.cuts + 1, false};
    }
    // [constrained]
    /// A new node hangs where a column beside it is not cut as often.
    NodeMask constrained(const Element& e) const {
        NodeMask mask = 0;
        for (int n = 0; n < 4; ++n) {
            const int x = e.column % columns + (n & 1);
            const int y = e.column / columns + (n >> 1);
            for (const auto& [i, j] : {std::array{x - 1, y - 1}, {x, y - 1}, {x - 1, y}, {x, y}}) {
                const bool exists = std::min(i, j) >= 0 && std::max(i, j) < columns;
                if (exists && greatest_cuts(i + columns * j) <= e.cuts) mask |= NodeMask{1} << n;
            }
        }
        return mask;
    }
    // [constrained]

private:
    static int greatest_cuts(int column) {
        const int row = column / columns;
        const double x = (column % columns + 0.5) / columns - 0.5;
        const double y = (row + 0.5) / columns - 0.5;
        return std::hypot(x, y) < 0.3 ? 6 : 4;
    }
    Rule rule_ = cut_near_the_wall();
};

/// A velocity that grows fast near the wall. Columns know where their nodes are.
class Velocity {
public:
    using value_type = double;

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        const auto coarse = BoundaryLayer().coarse(i);
        for (std::size_t k = 0; k < 8; ++k) out[k] = at(coarse.corners[k]);
        return 0;
    }
    NodeMask new_values(const BoundaryLayer::Element& e, NodeMask, std::span<double> out) const {
        const int n = BoundaryLayer::columns;
        const double height = std::pow(0.25, e.cuts + 1);
        for (int k = 0; k < 4; ++k) {
            const int x = e.column % n + (k & 1);
            const int y = e.column / n + (k >> 1);
            out[static_cast<std::size_t>(k)] = at({double(x) / n, double(y) / n, height});
        }
        return 0;
    }

private:
    static double at(const Point& x) {
        const double thickness = 0.01 * (1.5 + std::sin(9 * x[0]) * std::cos(7 * x[1]));
        return 1 - std::exp(-x[2] / thickness);
    }
};

}  // namespace

int main() {
    const BoundaryLayer grid;
    const Velocity field;
    if (const auto violation = check_grid(grid, field)) {
        std::fprintf(stderr, "%s\n", violation->sentence.c_str());
        return 1;
    }
    const HierarchicalIndicator indicator(grid, field);
    std::size_t open = 0;
    for (const double threshold : {0.0, 0.05, 0.2, 1.0}) {
        const auto result = isosurface(grid, field, 0.5, under(indicator, threshold));
        open += surface_report(result.surface).open_edges;
        std::printf("threshold %4.2f: %4zu triangles, at most %.3f off\n", threshold,
                    result.surface.simplices.size(), result.error_bound);
    }
    std::printf("%zu open edges\n", open);
    return open == 0 ? 0 : 1;
}
