// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Mesh sizes of lattices, which are found row by row: laws at every split, and the sweep over all
// splits beside them.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <walk/for_each_element.hpp>

using namespace nestgrid;

namespace {

constexpr std::array<Spread, 4> spreads{{{}, {.slope = 0.5}, {.factor = 1.5}, {1.25, 1}}};

/// What an indicator says at a split: sizes and positions of the corners and, behind them, of the
/// new nodes.
struct SizedSplit {
    std::size_t corners;
    std::vector<double> size;
    std::vector<Point> x;
    double diameter;
    NodeMask outside;
};

template <class Grid, class Function>
void for_each_sized_split(const Grid& grid, const Indicator& size, const Function& function) {
    const ZeroField<Grid> zero;
    const auto hierarchy = erase(grid, zero);
    const engine::Walk<float> walk(hierarchy, {.values = false, .keys = true, .positions = true});
    engine::for_each_element(walk, true, [&](const auto& view, const engine::Split& split) {
        if (split.rule == nullptr) return;
        engine::SplitKeys keys;
        engine::SplitPositions positions;
        const auto x = walk.split_positions(view, split, positions);
        SizedSplit sized{view.corner_count(), {}, {x.begin(), x.end()}, 0, split.outside};
        for (const NodeKey key : walk.split_keys(view, split, keys)) {
            sized.size.push_back(size.stop(key));
        }
        for (const Point& a : x.first(sized.corners)) {
            for (const Point& b : x.first(sized.corners)) {
                sized.diameter = std::max(sized.diameter, norm(a - b));
            }
        }
        function(sized);
    });
}

/// Nowhere below the diameter, and saturated.
template <class Grid>
void expect_sizes(const Grid& grid, const SweptIndicator& size) {
    constexpr double rounding = 1 - 1e-12;
    const auto [factor, slope] = size.spread();
    std::size_t small = 0;
    std::size_t open = 0;
    std::size_t inside = 0;
    for_each_sized_split(grid, size, [&](const SizedSplit& split) {
        for (std::size_t n = split.corners; n < split.x.size(); ++n) {
            small += split.size[n] < rounding * split.diameter ? 1 : 0;
            const bool outside = (split.outside >> (n - split.corners) & 1U) != 0;
            inside += outside && !std::isinf(split.size[n]) ? 1 : 0;
            for (std::size_t k = 0; k < split.corners; ++k) {
                const double distance = norm(split.x[n] - split.x[k]);
                const double least = factor * (split.size[n] + slope * distance);
                open += split.size[k] < rounding * least ? 1 : 0;
            }
        }
    });
    EXPECT_EQ(small, 0U);
    EXPECT_EQ(open, 0U);
    EXPECT_EQ(inside, 0U);
}

template <class Grid>
SweptIndicator swept_size(const Grid& grid, const Spread& spread) {
    const ZeroField<Grid> zero;
    const auto diameters = [](const MeasuredSplit& split, std::span<double> eta) {
        std::ranges::fill(eta, split.diameter());
    };
    return measured_indicator(grid, zero, diameters, spread);
}

template <class Grid>
std::vector<Grid> lattices(const Point& spacing) {
    std::vector<Grid> grids;
    if constexpr (Grid::dimension == 2) {
        grids.emplace_back(LatticeGeometry<2>{.samples = {17, 17}, .spacing = spacing});
        grids.emplace_back(LatticeGeometry<2>{.samples = {23, 9}, .spacing = spacing});
        grids.emplace_back(
            LatticeGeometry<2>{.samples = {33, 21}, .spacing = spacing, .block_levels = 2});
    } else {
        grids.emplace_back(LatticeGeometry<3>{.samples = {9, 9, 9}, .spacing = spacing});
        grids.emplace_back(LatticeGeometry<3>{.samples = {14, 7, 18}, .spacing = spacing});
        grids.emplace_back(
            LatticeGeometry<3>{.samples = {17, 9, 11}, .spacing = spacing, .block_levels = 1});
    }
    return grids;
}

template <class Grid>
class LatticeSizes : public testing::Test {};
using Lattices =
    testing::Types<LatticeBisection<2>, LatticeBisection<3>, LatticeOctree<2>, LatticeOctree<3>>;
TYPED_TEST_SUITE(LatticeSizes, Lattices);

TYPED_TEST(LatticeSizes, AreDiametersAndSaturated) {
    for (const Point& spacing : {Point{1, 1, 1}, Point{0.3, 1, 2.7}}) {
        for (const auto& grid : lattices<TypeParam>(spacing)) {
            for (const Spread& spread : spreads) expect_sizes(grid, mesh_size(grid, spread));
        }
    }
}

template <class Grid>
void expect_no_greater(const Grid& grid, const Spread& spread) {
    const SweptIndicator size = mesh_size(grid, spread);
    const SweptIndicator swept = swept_size(grid, spread);
    std::size_t greater = 0;
    std::size_t less = 0;
    for (NodeKey node = 0; node < grid.node_count(); ++node) {
        greater += size.stop(node) > swept.stop(node) ? 1 : 0;
        less += size.stop(node) < swept.stop(node) ? 1 : 0;
    }
    EXPECT_EQ(greater, 0U);
    EXPECT_TRUE(less == 0 || spread.slope > 0) << less;
}

/// In the sweep, a split hands on by its greatest distance. Without a slope the sizes are equal.
TYPED_TEST(LatticeSizes, AreNoGreaterThanThoseOfTheSweep) {
    for (const Point& spacing : {Point{1, 1, 1}, Point{0.25, 1, 3}}) {
        for (const auto& grid : lattices<TypeParam>(spacing)) {
            for (const Spread& spread : spreads) expect_no_greater(grid, spread);
        }
    }
}

}  // namespace
