// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators of lattices, which are saturated row by row: laws of mesh sizes at every split, and
// the sweep over all splits beside all of them.
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>
#include <walk/for_each_element.hpp>

using namespace nestgrid;

namespace lattice_indicators_test {

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
    const Spread spread = size.spread();
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
                const double least = spread.factor * (split.size[n] + spread.slope * distance);
                open += split.size[k] < rounding * least ? 1 : 0;
            }
        }
    });
    EXPECT_EQ(small, 0U);
    EXPECT_EQ(open, 0U);
    EXPECT_EQ(inside, 0U);
}

/// The same lattice, all of whose splits are kept.
template <class Grid>
struct WithoutStars : Grid {
    using Grid::Grid;
    bool knows_stars() const { return false; }
};

template <int dim>
std::vector<LatticeGeometry<dim>> geometries(const Point& spacing) {
    if constexpr (dim == 2) {
        return {{.samples = {17, 17}, .spacing = spacing},
                {.samples = {23, 9}, .spacing = spacing},
                {.samples = {33, 21}, .spacing = spacing, .block_levels = 2}};
    } else {
        return {{.samples = {9, 9, 9}, .spacing = spacing},
                {.samples = {14, 7, 18}, .spacing = spacing},
                {.samples = {17, 9, 11}, .spacing = spacing, .block_levels = 1}};
    }
}

std::vector<float> noise(std::size_t count) {
    std::mt19937 random(1);
    std::vector<float> values(count);
    for (float& v : values) v = std::uniform_real_distribution<float>(-1, 1)(random);
    return values;
}

template <class Grid>
class LatticeIndicators : public testing::Test {};
using Lattices =
    testing::Types<LatticeBisection<2>, LatticeBisection<3>, LatticeOctree<2>, LatticeOctree<3>>;
TYPED_TEST_SUITE(LatticeIndicators, Lattices);

/// Lattices so thin that nodes in different directions are equally far apart in key.
template <int dim>
std::vector<LatticeGeometry<dim>> thin_geometries(const Point& spacing) {
    if constexpr (dim == 2) {
        return {{.samples = {3, 9}, .spacing = spacing}, {.samples = {5, 5}, .spacing = spacing}};
    } else {
        return {{.samples = {3, 9, 9}, .spacing = spacing},
                {.samples = {5, 5, 5}, .spacing = spacing},
                {.samples = {5, 9, 9}, .spacing = spacing}};
    }
}

TYPED_TEST(LatticeIndicators, SizesAreDiametersAndSaturated) {
    for (const Point& spacing : {Point{1, 1, 1}, Point{0.3, 1, 2.7}}) {
        auto all = geometries<TypeParam::dimension>(spacing);
        for (const auto& thin : thin_geometries<TypeParam::dimension>(spacing)) all.push_back(thin);
        for (const auto& geometry : all) {
            const TypeParam grid(geometry);
            for (const Spread& spread : spreads) expect_sizes(grid, mesh_size(grid, spread));
        }
    }
}

/// Expects that no number exceeds that of the sweep over all splits, in which a split hands on by
/// its greatest distance. Without a slope the numbers are equal.
void expect_no_greater(const Indicator& eta, const Indicator& swept, std::size_t nodes) {
    std::size_t greater = 0;
    std::size_t less = 0;
    for (NodeKey node = 0; node < nodes; ++node) {
        greater += eta.stop(node) > swept.stop(node) ? 1 : 0;
        less += eta.stop(node) < swept.stop(node) ? 1 : 0;
    }
    EXPECT_EQ(greater, 0U);
    EXPECT_TRUE(less == 0 || eta.spread().slope > 0) << less;
}

TYPED_TEST(LatticeIndicators, AreNoGreaterThanThoseOfTheSweep) {
    using Unknown = WithoutStars<TypeParam>;
    constexpr int dim = TypeParam::dimension;
    for (const Point& spacing : {Point{1, 1, 1}, Point{0.25, 1, 3}}) {
        for (const auto& geometry : geometries<dim>(spacing)) {
            const TypeParam grid(geometry);
            const Unknown unknown(geometry);
            const auto values = noise(grid.sample_count());
            const LatticeField<TypeParam, float> field(grid, values);
            const LatticeField<Unknown, float> same(unknown, values);
            for (const Spread& spread : spreads) {
                const auto expect = [&](const Indicator& eta, const Indicator& swept) {
                    expect_no_greater(eta, swept, grid.node_count());
                };
                expect(mesh_size(grid, spread), mesh_size(unknown, spread));
                expect(visual_indicator({grid, field}, {.spread = spread}),
                       visual_indicator({unknown, same}, {.spread = spread}));
                expect(numerical_indicator({grid, field}, {.spread = spread}),
                       numerical_indicator({unknown, same}, {.spread = spread}));
                expect(wavelet_indicator({grid, field}, {.spread = spread}),
                       wavelet_indicator({unknown, same}, {.spread = spread}));
            }
        }
    }
}

}  // namespace lattice_indicators_test
