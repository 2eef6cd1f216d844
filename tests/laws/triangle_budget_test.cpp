// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangle budgets under every criterion that has a threshold, on every family: the threshold found
// keeps within the budget, and the next one below it does not, or it is 0.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/count_triangles.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/least_threshold.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "families.hpp"
#include "refusal.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace triangle_budget_test {

template <class Family>
class TriangleBudgets : public testing::Test {};
TYPED_TEST_SUITE(TriangleBudgets, Families);

/// The bfloat16 number below a positive one.
double next_below(double threshold) {
    return detail::bfloat16_value(
        static_cast<std::uint16_t>(detail::bfloat16_above(static_cast<float>(threshold)) - 1));
}

/// Expects the law of several budgets. Where the coarsest drawing has more, the budget is refused,
/// unless an intermediate threshold keeps within it.
/// \param draw draw(threshold) returns the number of triangles
/// \param find find(budget) returns a TriangleBudget
template <class Draw, class Find>
void expect_kept(const Draw& draw, const Find& find) {
    const std::uint64_t finest = draw(0);
    const std::uint64_t coarsest = draw(1e38);
    for (const std::uint64_t budget : {std::max<std::uint64_t>(coarsest, 1) - 1, coarsest,
                                       (3 * coarsest + finest) / 4, finest, 2 * finest + 1}) {
        if (budget == 0) continue;  // a projection that asks for no number
        SCOPED_TRACE(std::to_string(budget) + " of " + std::to_string(finest));
        TriangleBudget best;
        try {
            best = find(budget);
        } catch (const InvalidInput&) {
            EXPECT_LT(budget, coarsest);
            continue;
        }
        EXPECT_LE(best.triangles, budget);
        EXPECT_EQ(best.triangles, draw(best.threshold));
        EXPECT_LE(best.extracted, static_cast<std::uint64_t>(best.trials) * (budget + 1));
        EXPECT_LE(best.trials, 40);
        EXPECT_EQ(best.threshold == 0, finest <= budget);
        EXPECT_EQ(best.max_triangles, budget);
        EXPECT_EQ(best.end() == BudgetEnd::complete, best.threshold == 0);
        EXPECT_EQ(best.reason().empty(), best.end() == BudgetEnd::filled);
        if (best.threshold == 0) continue;
        const std::uint64_t next = draw(next_below(best.threshold));
        EXPECT_GT(next, budget);
        if (best.end() == BudgetEnd::filled) {
            EXPECT_GE(best.triangles + budget / 10, budget);
            continue;
        }
        EXPECT_LT(best.triangles, budget - budget / 10);
        EXPECT_EQ(best.next_threshold, next_below(best.threshold));
        EXPECT_EQ(best.next_triangles, next <= 16 * budget ? next : 0);
    }
}

/// Calls test(criterion_at) for each way to make a criterion of a threshold.
template <class Grid, class Field, class Test>
void for_each_way(const Grid& grid, const Field& field, Test&& test) {
    const auto of = [&](const char* name, const Indicator& indicator) {
        SCOPED_TRACE(name);
        test([&](double threshold) { return Threshold(&indicator, threshold); });
    };
    const auto blended = [&](const char* name, const Indicator& indicator, double factor) {
        SCOPED_TRACE(name);
        test([&](double threshold) { return Blended(&indicator, threshold, factor); });
    };
    of("visual", visual_indicator({grid, field}));
    of("numerical", numerical_indicator({grid, field}));
    of("wavelet", wavelet_indicator({grid, field}));
    blended("offset, blended", HierarchicalIndicator(grid, field, Spread{.factor = 1.5}), 1.5);
    const Spread twice{.factor = 2};
    blended("visual, blended", visual_indicator({grid, field}, {.spread = twice}), 2);
    blended("numerical, blended", numerical_indicator({grid, field}, {.spread = twice}), 2);
    const HierarchicalIndicator offsets(grid, field);
    of("offset", offsets);
    const SweptIndicator size = mesh_size(grid, {.slope = 0.5});
    const Lens lens(&size, Ball{{0.3, 0.3, 0.2}, 0.1}, {.finest = 0.1});
    SCOPED_TRACE("lens");
    test([&](double threshold) { return Threshold(&offsets, threshold) && lens; });
}

/// Counts triangles, and keeps none.
class Counter final : public SimplexSink<3> {
public:
    explicit Counter(std::size_t& count) : count_{&count} {}
    void take(const Surface<3>& chunk) override { *count_ += chunk.simplices.size(); }

private:
    std::size_t* count_;
};

TYPED_TEST(TriangleBudgets, AreKeptUnderEveryCriterion) {
    constexpr int dimension = TypeParam::Grid::dimension;
    auto grid = TypeParam::grids().back();
    refine_at_sphere(grid, 3 * TypeParam::steps);
    for (const NodalSamples& samples : catching_fields(grid.node_positions(), 21)) {
        SCOPED_TRACE(samples.name);
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const HierarchicalIndicator bounds(grid, field);
        const auto hierarchy = erase(grid, field);
        for_each_way(grid, field, [&](const auto& criterion_at) {
            expect_kept(
                [&](double threshold) {
                    return isosurface(grid, field, 0.0, under(criterion_at(threshold), bounds))
                        .surface.simplices.size();
                },
                [&](std::uint64_t budget) {
                    return isosurface<dimension>(
                               hierarchy, 0.0,
                               under(criterion_at, bounds, {.max_triangles = budget}))
                        .search;
                });
        });
    }
}

/// Triangles are counted up to a number, alone and with those of an isosurface.
template <class Real>
void expect_counted(const Hierarchy<Real>& hierarchy, SliceRequest request,
                    const Criterion& criterion, const Bounds& bounds, std::size_t count,
                    const IsosurfaceOptions& options) {
    const auto counted = [&](std::uint64_t most) {
        return count_triangles(hierarchy, request, under(criterion, bounds), most, options);
    };
    EXPECT_EQ(counted(count), count);
    EXPECT_TRUE(count == 0 || !counted(count - 1));
    request.isovalues = {0.0};
    count +=
        isosurface<3>(hierarchy, 0, under(criterion, bounds), options).surface.simplices.size();
    EXPECT_EQ(counted(count), count);
    EXPECT_TRUE(count == 0 || !counted(count - 1));
}

TYPED_TEST(TriangleBudgets, AreKeptBySlicesAndBoundaries) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        auto grid = TypeParam::grids().back();
        refine_at_sphere(grid, 3 * TypeParam::steps);
        const auto samples = catching_fields(grid.node_positions(), 22)[0];
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const HierarchicalIndicator bounds(grid, field);
        const auto hierarchy = erase(grid, field);
        const Plane plane({0.5, 0.5, 0.4}, {0.1, 0.2, 1});
        const detail::Everywhere everywhere;
        for (const auto& [function, cap] :
             {std::pair<const LevelFunction*, bool>{&plane, false}, {&everywhere, true}}) {
            for_each_way(grid, field, [&, f = function, cap = cap](const auto& criterion_at) {
                const IsosurfaceOptions options{.cap = cap};
                expect_kept(
                    [&](double threshold) {
                        std::size_t count = 0;
                        extract_slices({grid, field}, {{f}}, std::vector{Counter(count)},
                                       under(criterion_at(threshold), bounds), options);
                        expect_counted(hierarchy, {{f}}, criterion_at(threshold), bounds, count,
                                       options);
                        const auto merged =
                            slice(grid, field, *f, under(criterion_at(threshold), bounds), options);
                        EXPECT_LE(merged.surface.simplices.size(), count);
                        return count;
                    },
                    [&](std::uint64_t budget) {
                        return slice(hierarchy, *f,
                                     under(criterion_at, bounds, {.max_triangles = budget}),
                                     options)
                            .search;
                    });
            });
        }
    }
}

TYPED_TEST(TriangleBudgets, AreKeptByHeightsAndShadings) {
    if constexpr (TypeParam::Grid::dimension == 2) {
        auto grid = TypeParam::grids().back();
        refine_at_sphere(grid, 4 * TypeParam::steps);
        for (const NodalSamples& samples : catching_fields(grid.node_positions(), 23)) {
            SCOPED_TRACE(samples.name);
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const HierarchicalIndicator bounds(grid, field);
            for (const double flatness : {std::numeric_limits<double>::infinity(), 0.01}) {
                const ShadingOptions options{.flatness = flatness};
                for_each_way(grid, field, [&](const auto& criterion_at) {
                    expect_kept(
                        [&](double threshold) {
                            const auto s = criterion_at(threshold);
                            const auto flat = shading(grid, field, under(s, bounds), options);
                            const auto lifted =
                                height_field(grid, field, 3, under(s, bounds), options);
                            const std::size_t count = flat.surface.simplices.size();
                            EXPECT_EQ(lifted.surface.simplices.size(), count);
                            for (const std::uint64_t most : {count - 1, count}) {
                                const auto counted =
                                    count_triangles({grid, field}, under(s, bounds), most, options,
                                                    {ThreadExecutor(2)});
                                EXPECT_EQ(counted.has_value(), most == count);
                                EXPECT_EQ(counted.value_or(count), count);
                            }
                            return count;
                        },
                        [&](std::uint64_t budget) {
                            return shading(erase(grid, field),
                                           under(criterion_at, bounds, {.max_triangles = budget}),
                                           options)
                                .search;
                        });
                });
            }
        }
    }
}

/// Grids that stick out of the domain: no element may stop there at any threshold.
template <class Grid>
void expect_closed_within_budgets() {
    const Samples n{20, 9, 12};
    const SampledField data = sampled_fields(n)[1];
    const Grid grid({.samples = n});
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator bounds(grid, field);
    const auto hierarchy = erase(grid, field);
    const detail::Everywhere everywhere;
    for_each_way(grid, field, [&](const auto& criterion_at) {
        const auto draw = [&](double threshold) {
            const auto s = isosurface(grid, field, data.isovalue,
                                      under(criterion_at(threshold), bounds), {.cap = true});
            expect_closed(s.surface, true);
            return s.surface.simplices.size();
        };
        expect_kept(draw, [&](std::uint64_t budget) {
            return isosurface<3>(hierarchy, data.isovalue,
                                 under(criterion_at, bounds, {.max_triangles = budget}),
                                 {.cap = true})
                .search;
        });
        const std::size_t finest =
            boundary_surface(grid, field, under(criterion_at(0), bounds)).surface.simplices.size();
        for (const std::size_t budget : {finest / 8, finest / 2, finest}) {
            try {
                const TriangleBudget best =
                    slice(hierarchy, everywhere,
                          under(criterion_at, bounds, {.max_triangles = budget}), {.cap = true})
                        .search;
                expect_closed(
                    boundary_surface(grid, field, under(criterion_at(best.threshold), bounds))
                        .surface,
                    true);
            } catch (const InvalidInput&) {
                EXPECT_LT(budget, finest);
            }
        }
    });
}

TEST(TriangleBudgetsOfPaddedLattices, AreKeptByClosedSurfaces) {
    expect_closed_within_budgets<LatticeBisection<3>>();
    expect_closed_within_budgets<LatticeOctree<3>>();
}

/// Several results, blended by another indicator than that of the bounds, share a budget.
TEST(LeastThreshold, IsOneOfAnythingThatCounts) {
    const Samples n{33, 33, 33};
    const SampledField data = sampled_fields(n)[1];
    const LatticeOctree<3> grid({.samples = n});
    const LatticeField field(grid, std::span<const float>(data.values));
    const double isovalue = data.isovalue;
    const HierarchicalIndicator bounds(grid, field);
    const SweptIndicator jumps = numerical_indicator({grid, field}, {.spread = {.factor = 1.5}});
    const Plane plane({16, 16, 15.3}, {0.1, 0.2, 1});
    const auto hierarchy = erase(grid, field);
    for (const std::uint64_t budget : {3000U, 6000U}) {
        // [least_threshold]
        const auto count = [&](double threshold, std::uint64_t most) {
            return count_triangles(hierarchy, {{&plane}, {isovalue}},
                                   under(Blended(&jumps, threshold, 1.5), bounds), most);
        };
        const TriangleBudget found = least_threshold(count, 1.0, budget);
        // [least_threshold]
        EXPECT_LE(found.triangles, budget);
        EXPECT_EQ(count(found.threshold, budget), found.triangles);
        EXPECT_FALSE(count(next_below(found.threshold), budget));
    }
}

/// The search itself, for a number of triangles that falls at one place, from any start.
/// Wherever progress cancels, what was found by then keeps the budget, and nothing is thrown.
TEST(LeastThreshold, EndsWhereProgressCancels) {
    const Samples n{65, 65, 65};
    const SampledField data = sampled_fields(n)[1];
    const LatticeBisection<3> grid({.samples = n});
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    const auto at = [&](double threshold) { return Threshold(&indicator, threshold); };
    const std::uint64_t finest =
        isosurface(grid, field, data.isovalue, under(indicator, 0)).surface.simplices.size();
    const std::uint64_t budget = finest / 2;
    int cancelled = 0;
    for (int calls = 0; calls < 20; ++calls) {
        int left = calls;
        const IsosurfaceOptions options{.progress = [&](const auto&) { return left-- > 0; }};
        const TriangleBudget found =
            isosurface<3>(erase(grid, field), data.isovalue,
                          under(at, indicator, {.max_triangles = budget}), options)
                .search;
        cancelled += found.cancelled ? 1 : 0;
        EXPECT_LE(found.triangles, budget);
        const auto drawn =
            isosurface(grid, field, data.isovalue, under(at(found.threshold), indicator));
        EXPECT_LE(drawn.surface.simplices.size(), budget);
        left = calls;
        EXPECT_LE(isosurface(grid, field, data.isovalue, {.max_triangles = budget}, options)
                      .surface.simplices.size(),
                  budget);
    }
    EXPECT_GT(cancelled, 3);
}

TEST(LeastThreshold, EndsAtThePlaceWhereTheNumberFalls) {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double place : {1e-30, 1e-3, 1.0, 255.0, 1e30, 3.38e38}) {
        for (const double start : {0.0, 1e-38, 1e-3, 1.0, 7e4, 1e38, infinity}) {
            SCOPED_TRACE(std::to_string(place) + " from " + std::to_string(start));
            const CountTriangles count = [&](double threshold, std::uint64_t most) {
                const std::uint64_t triangles = threshold >= place ? 10 : 1000;
                return triangles <= most ? std::optional(triangles) : std::nullopt;
            };
            const TriangleBudget best = least_threshold(count, start, 10);
            EXPECT_GE(best.threshold, place);
            EXPECT_LT(next_below(best.threshold), place);
            EXPECT_EQ(best.triangles, 10U);
            EXPECT_EQ(least_threshold(count, start, 1000).threshold, 0);
            expect_refused([&] { least_threshold(count, start, 9); },
                           "even the coarsest surface has more than 9 triangles: 10");
        }
    }
}

}  // namespace triangle_budget_test
