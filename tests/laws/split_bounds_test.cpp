// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bounds at full resolution, on every family: true, no looser than those of a preroll, the same for
// any number of threads, and good for the same surface.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/split_bounds.hpp>

#include "families.hpp"
#include "for_each_split.hpp"
#include "same_surface.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace split_bounds_test {

template <class Family>
class SplitBoundsOf : public testing::Test {};
TYPED_TEST_SUITE(SplitBoundsOf, Families);

/// Calls test(hierarchy, dimension) for some fields of refined grids of a family.
template <class Family, class Test>
void for_each_hierarchy(unsigned seed, const Test& test) {
    for_each_field_at_sphere<Family>(2, seed, [&](const auto& grid, const auto& samples) {
        using Grid = typename Family::Grid;
        const NodeField<Grid, double> field(grid, samples.values);
        test(erase(grid, field), std::integral_constant<int, Grid::dimension>{});
    });
}

/// A divided element, the range of the values at its corners, and the bound that is told.
struct Divided {
    int level;
    double least;
    double greatest;
    double bound;
};

TYPED_TEST(SplitBoundsOf, HoldAtAllNodesInEachElement) {
    std::size_t tight = 0;
    for_each_hierarchy<TypeParam>(51, [&](const auto& hierarchy, auto) {
        const SplitBounds bounds(hierarchy);
        std::vector<Divided> open;
        for_each_split(hierarchy, bounds.hanging(),
                       [&](const auto& view, const engine::Split& split, auto keys, auto value) {
                           while (!open.empty() && open.back().level >= view.level) open.pop_back();
                           const std::size_t corners = view.corner_count();
                           const auto [low, high] = std::minmax_element(value, value + corners);
                           open.push_back({view.level, *low, *high,
                                           bounds.bound(*split.rule, keys.subspan(corners))});
                           for (const Divided& e : open) {
                               for (std::size_t n = corners; n < keys.size(); ++n) {
                                   ASSERT_LE(value[n], e.greatest + e.bound);
                                   ASSERT_GE(value[n], e.least - e.bound);
                                   if (e.bound > 0 && value[n] > e.greatest + e.bound * 0.99)
                                       ++tight;
                               }
                           }
                       });
    });
    EXPECT_GT(tight, 0U);
}

/// But for the rounding of one number to bfloat16.
TYPED_TEST(SplitBoundsOf, AreNoLooserThanThoseOfAPreroll) {
    for_each_hierarchy<TypeParam>(52, [](const auto& hierarchy, auto) {
        const SplitBounds bounds(hierarchy);
        const HierarchicalIndicator indicator(hierarchy);
        EXPECT_EQ(bounds.least(), indicator.least());
        EXPECT_EQ(bounds.greatest(), indicator.greatest());
        EXPECT_EQ(bounds.finest_level(), indicator.finest_level());
        for_each_split(hierarchy, bounds.hanging(),
                       [&](const auto& view, const engine::Split& split, auto keys, auto) {
                           const auto made = keys.subspan(view.corner_count());
                           ASSERT_LE(bounds.bound(*split.rule, made),
                                     indicator.bound(*split.rule, made) * (1 + 1.0 / 128));
                       });
    });
}

TYPED_TEST(SplitBoundsOf, DoNotDependOnTheNumberOfThreads) {
    for_each_hierarchy<TypeParam>(53, [](const auto& hierarchy, auto) {
        const SplitBounds bounds(hierarchy);
        for (const std::size_t threads : {2U, 3U}) {
            const SplitBounds same(hierarchy, ThreadExecutor(threads));
            EXPECT_EQ(same.least(), bounds.least());
            EXPECT_EQ(same.greatest(), bounds.greatest());
            for_each_split(hierarchy, bounds.hanging(),
                           [&](const auto& view, const engine::Split& split, auto keys, auto) {
                               const auto made = keys.subspan(view.corner_count());
                               ASSERT_EQ(same.bound(*split.rule, made),
                                         bounds.bound(*split.rule, made));
                           });
        }
    });
}

TYPED_TEST(SplitBoundsOf, GiveTheSurfaceOfAPreroll) {
    for_each_hierarchy<TypeParam>(54, [](const auto& hierarchy, auto dimension) {
        const HierarchicalIndicator indicator(hierarchy);
        const auto expected = isosurface<dimension>(hierarchy, 0, under(Exact{}, indicator));
        const auto found =
            isosurface<dimension>(hierarchy, 0, under(Exact{}, SplitBounds(hierarchy)));
        expect_same(found.surface, expected.surface);
        EXPECT_EQ(found.error_bound, expected.error_bound);
        EXPECT_LE(found.counts.visited, expected.counts.visited);
    });
}

}  // namespace split_bounds_test
