// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Anisotropic hexahedra and prisms: where nodes hang on their own parents, surfaces are closed;
// where they do not, check_grid and the preroll refuse the grid.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>

#include "anisotropic_grids.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace {

/// A function of the place, random: two nodes at one place have one value.
ForestField<3> noise(const Forest<3>& forest, unsigned seed) {
    std::map<Point, double> at;
    std::mt19937 random(seed);
    for (const Point& x : forest.positions) at.try_emplace(x, 0);
    for (auto& [x, value] : at) value = uniform(random) - 0.5;
    return {forest, [&](const Point& x) { return at.at(x); }};
}

/// Calls test(forest, random) for random grids.
template <class Test>
void on_random_grids(unsigned count, unsigned seed, Test&& test) {
    for (unsigned i = 0; i < count; ++i) {
        std::mt19937 random(seed + i);
        const Forest<3> forest = random_anisotropic_grid(random);
        SCOPED_TRACE(seed + i);
        test(forest, random);
    }
}

template <class Grid>
std::string refused_by_preroll(const Grid& grid, const ForestField<3>& field) {
    return refusal<GridError>([&] { HierarchicalIndicator(grid, field); });
}

template <class Grid>
void expect_closed_surfaces(const Grid& grid, const ForestField<3>& field) {
    const HierarchicalIndicator indicator(grid, field);
    for (const double epsilon : six_thresholds) {
        SCOPED_TRACE(epsilon);
        expect_closed(
            isosurface(grid, field, 0.0, Threshold(&indicator, epsilon), indicator).surface);
    }
}

template <class Grid>
void expect_refused_by_both(const Grid& grid, const ForestField<3>& field) {
    EXPECT_TRUE(check_grid(grid, field));
    EXPECT_NE(refused_by_preroll(grid, field).find("different directions"), std::string::npos);
}

TEST(Anisotropic, UnsupportedGridsAreRefusedByBoth) {
    unsigned unsupported = 0;
    on_random_grids(6000, 0, [&](const Forest<3>& forest, std::mt19937& random) {
        if (unsupported == 1000 || Judge(forest, random).supports()) return;
        ++unsupported;
        const auto field = noise(forest, unsupported);
        expect_refused_by_both(forest, field);
        expect_refused_by_both(KeysByPlace(forest), field);
    });
    EXPECT_EQ(unsupported, 1000U);
}

TEST(Anisotropic, SupportedGridsDrawClosedSurfaces) {
    unsigned supported = 0;
    unsigned hanging = 0;
    unsigned refused = 0;
    on_random_grids(6000, 100000, [&](const Forest<3>& forest, std::mt19937& random) {
        const Judge judge(forest, random);
        if (supported == 900 || !judge.supports()) return;
        ++supported;
        if (judge.hanging() > 0) ++hanging;
        const auto field = noise(forest, supported);
        const KeysByPlace keyed(forest);
        const bool checked = !check_grid(forest, field);
        EXPECT_EQ(checked, !check_grid(keyed, field));
        EXPECT_EQ(checked, refused_by_preroll(forest, field).empty());
        EXPECT_EQ(checked, refused_by_preroll(keyed, field).empty());
        if (!checked) {
            ++refused;
            return;
        }
        expect_closed_surfaces(forest, field);
        expect_closed_surfaces(keyed, field);
    });
    EXPECT_EQ(supported, 900U);
    EXPECT_GT(hanging, 300U);
    EXPECT_LE(refused, 36U);
    std::printf("%u hang, %u refused of %u\n", hanging, refused, supported);
}

}  // namespace
