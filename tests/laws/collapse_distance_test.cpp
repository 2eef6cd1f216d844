// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A surface that is collapsed within a distance keeps it there and back, by brute force over points
// of both surfaces, and stays a manifold in the domain with fewer triangles.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/probe.hpp>

#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "surface_distance.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace collapse_distance_test {

constexpr double rounding = 1e-9;

/// A surface within half of a distance, to begin with.
template <class Real>
Surface<3> begun(const Hierarchy<Real>& h, const Nearness& nearness, double isovalue,
                 const HierarchicalIndicator& indicator) {
    const Threshold coarse(&indicator, 0.05 * (indicator.greatest() - indicator.least()));
    return isosurface_within(h, isovalue, {nearness.whole, nearness.distance / 2}, coarse,
                             indicator, {.cuts = Cuts::finest})
        .isosurface.surface;
}

template <class Family>
class CollapseWithin : public testing::Test {};
TYPED_TEST_SUITE(CollapseWithin, Families);

TYPED_TEST(CollapseWithin, KeepsTheDistanceTheManifoldAndTheDomain) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        std::size_t before = 0;
        std::size_t after = 0;
        for_each_field_at_sphere<TypeParam>(1, 8, [&](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h);
            const auto whole = isosurface<3>(h, 0.0, under(Exact{}, indicator)).surface;
            if (whole.simplices.empty()) return;
            {
                constexpr double distance = 0.08;
                const Nearness nearness{whole, distance};
                auto surface = begun(h, nearness, 0.0, indicator);
                const SurfaceReport drawn = surface_report(surface);
                const Collapsed result =
                    collapse(surface, erase(grid, field), 0.0, indicator, {.nearness = nearness});
                EXPECT_EQ(result.exceeding, 0U);
                EXPECT_EQ(result.missed, 0U);
                expect_closed(surface);
                const SurfaceReport left = surface_report(surface);
                EXPECT_EQ(left.euler, drawn.euler);
                EXPECT_EQ(left.components, drawn.components);
                EXPECT_EQ(left.triangles == drawn.triangles, result.collapses == 0);
                expect_borders_on_cube(surface);
                for (const Point& x : surface.vertices) {
                    for (const double at : x) EXPECT_LE(std::abs(at - 0.5), 0.5 + rounding);
                }
                expect_kept(surface, whole, distance);
                before += drawn.triangles;
                after += left.triangles;
            }
        });
        EXPECT_LT(4 * after, 3 * before);
    }
}

template <class Grid>
void expect_kept_on_lattice() {
    const Samples n{7, 7, 7};
    const Grid grid({.samples = n, .spacing = {1, 0.9, 1.1}});
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const auto h = erase(grid, field);
        const HierarchicalIndicator indicator(h);
        const auto whole = isosurface<3>(h, data.isovalue, under(Exact{}, indicator)).surface;
        for (const double distance : {0.3, 1.0}) {
            SCOPED_TRACE(distance);
            const Nearness nearness{whole, distance};
            auto surface = begun(h, nearness, data.isovalue, indicator);
            const std::size_t drawn = surface.simplices.size();
            const Collapsed result =
                collapse(surface, h, data.isovalue, indicator, {.nearness = nearness});
            EXPECT_EQ(result.exceeding + result.missed, 0U);
            EXPECT_LT(surface.simplices.size(), drawn);
            expect_closed(surface);
            expect_kept(surface, whole, distance);
        }
    }
}

TEST(CollapseWithinDistances, AreKeptInLatticesOfTetrahedra) {
    expect_kept_on_lattice<LatticeBisection<3>>();
}
TEST(CollapseWithinDistances, AreKeptInLatticesOfHexahedra) {
    expect_kept_on_lattice<LatticeOctree<3>>();
}

/// A lattice of samples with its surface of all data.
struct Drawn {
    explicit Drawn(const SampledField& sampled, const Samples& n)
        : data{sampled},
          grid({.samples = n}),
          field(grid, std::span<const float>(data.values)),
          indicator(grid, field),
          whole{isosurface(grid, field, data.isovalue, under(Exact{}, indicator)).surface} {}

    Collapsed collapse(Surface<3>& surface, const CollapseOptions& options,
                       const Executor& executor = SequentialExecutor{}) const {
        return nestgrid::collapse(surface, erase(grid, field), data.isovalue, indicator, options,
                                  executor);
    }

    SampledField data;
    LatticeBisection<3> grid;
    LatticeField<LatticeBisection<3>, float> field;
    HierarchicalIndicator indicator;
    Surface<3> whole;
};

TEST(CollapseWithinDistances, LeavesFewTriangles) {
    const Drawn drawn(sampled_fields({33, 33, 33})[0], {33, 33, 33});
    Surface<3> surface = drawn.whole;
    drawn.collapse(surface, {.nearness = Nearness{drawn.whole, 0.5}});
    EXPECT_LE(surface.simplices.size(), drawn.whole.simplices.size() / 60);
}

TEST(CollapseWithinDistances, AreKeptBesideAnError) {
    const Drawn drawn(sampled_fields({13, 13, 13})[1], {13, 13, 13});
    const Nearness nearness{drawn.whole, 0.3};
    Surface<3> by_error = drawn.whole;
    Surface<3> by_distance = drawn.whole;
    Surface<3> by_both = drawn.whole;
    drawn.collapse(by_error, {.error = 0.2});
    drawn.collapse(by_distance, {.nearness = nearness});
    const Collapsed both = drawn.collapse(by_both, {.error = 0.2, .nearness = nearness});
    EXPECT_GT(greatest_distance(by_error, drawn.whole, 0.1), 0.3);
    expect_kept(by_both, drawn.whole, 0.3);
    EXPECT_LE(both.error, 0.2);
    EXPECT_GT(both.error, 0);
    EXPECT_GT(by_both.simplices.size(), by_distance.simplices.size());
    EXPECT_GT(both.refused_by_distance, 0U);
}

/// What is too far from the beginning stays so, and is told.
TEST(CollapseWithinDistances, TellWhatWasTooFarFromTheBeginning) {
    const Drawn drawn(sampled_fields({17, 17, 17})[0], {17, 17, 17});
    const Surface<3> other =
        isosurface(drawn.grid, drawn.field, 0.3, under(Exact{}, drawn.indicator)).surface;
    Surface<3> surface = other;
    const Collapsed result = drawn.collapse(surface, {.nearness = Nearness{drawn.whole, 0.2}});
    EXPECT_EQ(result.exceeding, other.simplices.size());
    EXPECT_EQ(result.missed, drawn.whole.simplices.size());
    EXPECT_EQ(surface.simplices, other.simplices);
    Surface<3> nothing;
    EXPECT_EQ(drawn.collapse(nothing, {.nearness = Nearness{drawn.whole, 0.2}}).missed,
              drawn.whole.simplices.size());
}

TEST(CollapseWithinDistances, AreTheSameWithAnyNumberOfThreads) {
    const Drawn drawn(sampled_fields({25, 25, 25})[3], {25, 25, 25});  // more than one block
    const CollapseOptions options{.nearness = Nearness{drawn.whole, 0.5}};
    Surface<3> one = drawn.whole;
    drawn.collapse(one, options);
    EXPECT_LT(one.simplices.size(), drawn.whole.simplices.size() / 2);
    for (const std::size_t threads : {2U, 5U}) {
        Surface<3> many = drawn.whole;
        drawn.collapse(many, options, ThreadExecutor(threads));
        expect_same_bits(many.vertices, one.vertices, "vertices");
        expect_same_bits(many.simplices, one.simplices, "simplices");
    }
}

TEST(CollapseWithinDistances, AreRefusedOutOfRange) {
    const Drawn drawn(sampled_fields({5, 5, 5})[0], {5, 5, 5});
    Surface<3> surface = drawn.whole;
    for (const double distance : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        expect_refused(
            [&] {
                drawn.collapse(surface, {.nearness = Nearness{drawn.whole, distance}});
            },
            "not a positive number");
    }
    Surface<3> wrong;
    wrong.simplices = {{0, 1, 2}};
    expect_refused(
        [&] {
            drawn.collapse(surface, {.nearness = Nearness{wrong, 1}});
        },
        "names a vertex that does not exist");
}

}  // namespace collapse_distance_test
