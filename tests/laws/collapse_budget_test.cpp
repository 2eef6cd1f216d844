// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Collapses to a number of triangles keep within it, at an error, or a distance, that is about the
// least one.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>

#include "families.hpp"
#include "refusal.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace collapse_budget_test {

/// The triangles that collapses within an error leave.
template <class Real>
std::size_t collapsed_triangles(const Hierarchy<Real>& h, double isovalue,
                                const HierarchicalIndicator& deviations, double error) {
    auto surface = isosurface<3>(h, isovalue, under(deviations, collapse_start * error)).surface;
    collapse(surface, h, isovalue, deviations, {.error = error});
    return surface.simplices.size();
}

auto thresholds_of(const HierarchicalIndicator& deviations) {
    return [&](double threshold) { return Threshold(&deviations, threshold); };
}

/// What was found for a number of triangles is what collapses leave, and the next lesser amount
/// that is known of leaves more.
template <class Triangles>
void expect_least(const TriangleBudget& found, std::uint64_t number, const Triangles& left_at) {
    EXPECT_GT(found.threshold, 0);
    EXPECT_LE(found.triangles, number);
    EXPECT_EQ(found.triangles, left_at(found.threshold));
    if (found.end() == BudgetEnd::filled || found.next_threshold == 0) return;
    EXPECT_LT(found.next_threshold, found.threshold);
    EXPECT_EQ(found.next_triangles, left_at(found.next_threshold));
    EXPECT_GT(found.next_triangles, number);
}

template <class Family>
class CollapseBudgets : public testing::Test {};
TYPED_TEST_SUITE(CollapseBudgets, Families);

TYPED_TEST(CollapseBudgets, AreKeptAtTheLeastError) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(1, 8, [](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator deviations(h, NodeError::deviation);
            const std::size_t all =
                isosurface<3>(h, 0.0, under(deviations, 0)).surface.simplices.size();
            if (all < 60) return;
            const auto search = [&](std::uint64_t number) {
                return isosurface<3>(h, 0.0,
                                     under(thresholds_of(deviations), deviations,
                                           {.max_triangles = number, .collapse = true}))
                    .search;
            };
            EXPECT_EQ(search(all).threshold, 0);
            EXPECT_EQ(search(all).triangles, all);
            const std::uint64_t number = all / 2;
            TriangleBudget found;
            try {
                found = search(number);
            } catch (const InvalidInput&) {  // what is left is many small parts
                const double range = deviations.greatest() - deviations.least();
                EXPECT_GT(collapsed_triangles(h, 0.0, deviations, 2 * range), number);
                return;
            }
            expect_least(found, number, [&](double error) {
                return collapsed_triangles(h, 0.0, deviations, error);
            });
        });
    }
}

TYPED_TEST(CollapseBudgets, AreKeptAtTheLeastDistance) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(1, 8, [](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator deviations(h, NodeError::deviation);
            const Surface<3> whole = isosurface<3>(h, 0.0, under(Exact{}, deviations)).surface;
            const std::size_t all = whole.simplices.size();
            if (all < 60) return;
            const auto at = [&](double distance) { return Threshold(&deviations, distance); };
            const auto left_at = [&](double distance) {
                auto surface =
                    isosurface_within(h, 0.0, {whole, distance / 2}, at(distance / 2), deviations)
                        .isosurface.surface;
                collapse(surface, h, 0.0, deviations, {.nearness = Nearness{whole, distance}});
                return surface.simplices.size();
            };
            const auto search = [&](std::uint64_t number) {
                return isosurface<3>(
                           h, 0.0,
                           under(
                               at, deviations,
                               {.max_triangles = number, .collapse = true, .keeps_distance = true}))
                    .search;
            };
            EXPECT_EQ(search(all).threshold, 0);
            EXPECT_EQ(search(all).triangles, all);
            const std::uint64_t number = all / 3;
            TriangleBudget found;
            try {
                found = search(number);
            } catch (const InvalidInput&) {  // what is left is many small parts
                EXPECT_GT(left_at(2), number);
                return;
            }
            expect_least(found, number, left_at);
        });
    }
}

/// Samples with deviations of their own.
struct Sampled {
    explicit Sampled(const SampledField& sampled, const Samples& n)
        : data{sampled},
          grid({.samples = n}),
          field(grid, std::span<const float>(data.values)),
          deviations(grid, field, NodeError::deviation) {}

    TriangleBudget find(std::uint64_t number, const IsosurfaceOptions& options = {}) const {
        return isosurface<3>(erase(grid, field), data.isovalue,
                             under(thresholds_of(deviations), deviations,
                                   {.max_triangles = number, .collapse = true}),
                             options)
            .search;
    }

    SampledField data;
    LatticeBisection<3> grid;
    LatticeField<LatticeBisection<3>, float> field;
    HierarchicalIndicator deviations;
};

TEST(CollapseBudgets, AreFilledInFewTrials) {
    const Samples n{17, 17, 17};
    for (const std::size_t i : {0U, 1U}) {
        const Sampled sampled(sampled_fields(n)[i], n);
        for (const std::uint64_t number : {200U, 900U}) {
            const TriangleBudget found = sampled.find(number);
            if (found.end() != BudgetEnd::filled) {
                EXPECT_EQ(found.end(), BudgetEnd::step);
                EXPECT_GT(found.next_triangles, number);
            }
            EXPECT_LE(found.triangles, number);
            EXPECT_LE(found.trials, 10);
        }
    }
}

TEST(CollapseBudgets, AreFilledByDistancesInFewTrials) {
    const Samples n{17, 17, 17};
    for (const auto& [i, number] : {std::pair{0U, 100U}, {1U, 600U}}) {
        const Sampled sampled(sampled_fields(n)[i], n);
        const Surface<3> whole =
            isosurface(sampled.grid, sampled.field, sampled.data.isovalue).surface;
        const TriangleBudget found =
            isosurface<3>(
                erase(sampled.grid, sampled.field), sampled.data.isovalue,
                under(thresholds_of(sampled.deviations), sampled.deviations,
                      {.max_triangles = number, .collapse = true, .keeps_distance = true}))
                .search;
        EXPECT_TRUE(found.end() == BudgetEnd::filled || found.next_triangles > number);
        EXPECT_LE(found.triangles, number);
        EXPECT_LE(found.trials, 8);
    }
}

TEST(CollapseBudgets, AreRefusedWhereNoErrorKeepsThem) {
    const Samples n{9, 9, 9};
    const auto plane = sample(n, [](double x, double, double) { return x; });
    const Sampled sampled({"plane", plane, 0.4, 1}, n);
    expect_refused([&] { sampled.find(1); }, "after collapses");
}

TEST(CollapseBudgets, EndWhereProgressSaysSo) {
    const Samples n{33, 33, 33};
    const Sampled sampled(sampled_fields(n)[2], n);
    const auto stop = [](const TraversalCounts&) { return false; };
    EXPECT_EQ(sampled.find(100, {.progress = stop}).end(), BudgetEnd::cancelled);
}

}  // namespace collapse_budget_test
