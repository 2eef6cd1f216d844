// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The union of two hierarchies over one coarse grid, and times between frames on two grids.
#include <gtest/gtest.h>

#include <nestgrid/adapters/union.hpp>
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/check_grid.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace {

using FamiliesWithOneRule =
    testing::Types<BisectionTriangles, BisectionTetrahedra, BalancedQuadtree, UnbalancedQuadtree,
                   BalancedOctree, UnbalancedOctree, Prisms>;

template <class Family>
class Unions : public testing::Test {};
TYPED_TEST_SUITE(Unions, FamiliesWithOneRule);

/// Refines the leaves that a ball of radius 0.3 around a point cuts.
template <class Grid>
void refine_at_ball(Grid& grid, const Point& centre, int levels) {
    for (int level = 0; level < levels; ++level) {
        grid.adapt([&](const Leaf& leaf) {
            double size = 0;
            for (const Point& x : leaf.corners) size = std::max(size, norm(x - leaf.centre()));
            const bool cuts = std::abs(norm(leaf.centre() - centre) - 0.3) < size;
            return leaf.level < levels && cuts ? Mark::refine : Mark::keep;
        });
    }
}

/// Two grids of a family, refined at two balls, with fields on them.
template <class Grid, class Real>
struct TwoFrames {
    using Field = NodeField<Grid, Real>;

    TwoFrames(const Grid& coarse, int levels, std::size_t number)
        : first{refined(coarse, {0.35, 0.4, 0.4}, levels)},
          second{refined(coarse, {0.65, 0.55, 0.6}, levels)},
          first_values{values(first, number, 1)},
          second_values{values(second, number, 2)} {}
    TwoFrames(const TwoFrames&) = delete;
    TwoFrames& operator=(const TwoFrames&) = delete;

    static Grid refined(Grid grid, Point centre, int levels) {
        if (Grid::dimension == 2) centre[2] = 0;
        refine_at_ball(grid, centre, levels);
        return grid;
    }
    static std::vector<Real> values(const Grid& grid, std::size_t number, unsigned seed) {
        const auto samples = catching_fields(grid.node_positions(), seed)[number].values;
        return {samples.begin(), samples.end()};
    }

    Grid first;
    Grid second;
    std::vector<Real> first_values;
    std::vector<Real> second_values;
    Field first_field{first, first_values};
    Field second_field{second, second_values};
    Union<Grid, Field> both{first, first_field, second, second_field};
    UnionFrame<Grid, Field> first_frame = both.frame(0);
    UnionFrame<Grid, Field> second_frame = both.frame(1);
};

constexpr std::size_t field_count = 10;

/// Calls test(frames) for the grids of a family and every third of the catching fields, each grid
/// with others.
template <class Family, class Real, class Test>
void for_each_two_frames(int levels, Test&& test) {
    std::size_t first = 0;
    for (const auto& coarse : Family::grids()) {
        for (std::size_t number = first++; number < field_count; number += 3) {
            SCOPED_TRACE("field " + std::to_string(number));
            const TwoFrames<typename Family::Grid, Real> frames(coarse, levels * Family::steps,
                                                                number);
            test(frames);
        }
    }
}

TYPED_TEST(Unions, KeepTheContract) {
    const auto check = [](const auto& frames) {
        for (const auto* frame : {&frames.first_frame, &frames.second_frame}) {
            const auto violation = check_grid(frames.both, *frame);
            EXPECT_FALSE(violation) << violation->sentence;
        }
    };
    for_each_two_frames<TypeParam, double>(2, check);
    for_each_two_frames<TypeParam, float>(2, check);
}

/// Each frame is the function that it is on its own grid.
TYPED_TEST(Unions, LeaveTheirFramesAsTheyAre) {
    std::mt19937 random(3);
    for_each_two_frames<TypeParam, double>(3, [&](const auto& frames) {
        std::vector<Point> points;
        for (int i = 0; i < 400; ++i) {
            points.push_back({uniform(random), uniform(random), uniform(random)});
            if (TypeParam::Grid::dimension == 2) points.back()[2] = 0;
        }
        const auto expect_same_values = [&](const ProbeResult& a, const ProbeResult& b) {
            std::size_t found = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                EXPECT_EQ(a.found(i), b.found(i));
                if (!a.found(i) || !b.found(i)) continue;
                EXPECT_NEAR(a.values[i], b.values[i], 1e-12);
                ++found;
            }
            return found;
        };
        const std::size_t found =
            expect_same_values(probe(frames.both, frames.first_frame, points),
                               probe(frames.first, frames.first_field, points)) +
            expect_same_values(probe(frames.both, frames.second_frame, points),
                               probe(frames.second, frames.second_field, points));
        EXPECT_TRUE(found > 500 || frames.first.coarse_count() == 8);  // the octahedron is hollow
    });
}

TYPED_TEST(Unions, OfAGridWithItselfAreThatGrid) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        using Grid = typename TypeParam::Grid;
        for (const NodalSamples& samples : catching_fields(grid.node_positions(), 4)) {
            SCOPED_TRACE(samples.name);
            const NodeField<Grid, double> field(grid, samples.values);
            const HierarchicalIndicator own(grid, field);
            const Union both(grid, field, grid, field);
            const auto frame = both.frame(0);
            const HierarchicalIndicator indicator(both, frame);
            EXPECT_EQ(indicator.node_count(), grid.used_node_count());
            for (const double threshold : {0.0, 0.05}) {
                const auto expected = isosurface(grid, field, 0.0, under(own, threshold));
                const auto drawn = isosurface(both, frame, 0.0, under(indicator, threshold));
                EXPECT_EQ(drawn.counts.visited, expected.counts.visited);
                EXPECT_EQ(drawn.counts.extracted, expected.counts.extracted);
                EXPECT_EQ(drawn.error_bound, expected.error_bound);
                if (samples.generic) {
                    EXPECT_EQ(drawn.surface.vertices, expected.surface.vertices);
                    EXPECT_EQ(drawn.surface.simplices, expected.surface.simplices);
                }
            }
        }
    }
}

/// Surfaces and slices at five times between frames of two adaptive grids.
TYPED_TEST(Unions, DrawClosedFilms) {
    for_each_two_frames<TypeParam, double>(3, [](const auto& frames) {
        const HierarchicalIndicator first(frames.both, frames.first_frame);
        const HierarchicalIndicator second(frames.both, frames.second_frame);
        EXPECT_TRUE(!frames.first.family().conforming || first.hanging() == nullptr);
        for (const double t : {0.0, 0.21, 0.5, 0.84, 1.0}) {
            const auto weights = linear_weights(std::array{0.0, 1.0}, t);
            const KeyFrames indicator({&first, &second}, weights);
            const Between field({&frames.first_frame, &frames.second_frame}, weights);
            for (const double threshold : {0.0, 0.1}) {
                SCOPED_TRACE(testing::Message() << "t " << t << ", threshold " << threshold);
                const Threshold s(&indicator, threshold);
                const auto drawn = isosurface(frames.both, field, 0.0, under(s, indicator));
                expect_closed(drawn.surface);
                const auto probed = probe(frames.both, field, drawn.surface.vertices);
                for (std::size_t v = 0; v < probed.values.size(); ++v) {
                    if (!probed.found(v)) continue;
                    EXPECT_LE(std::abs(probed.values[v]), drawn.error_bound + 1e-5);
                }
                if constexpr (TypeParam::Grid::dimension == 3) {
                    const Plane plane({0.4, 0.5, 0.49}, {0.3, 0.5, 0.81});
                    expect_closed(slice(frames.both, field, plane, under(s, indicator)).surface);
                }
                expect_same(isosurface(frames.both, field, 0.0, under(s, indicator), {},
                                       {ThreadExecutor(3)})
                                .surface,
                            drawn.surface);
            }
        }
    });
}

template <class Grid>
std::string refusal_of_union(const Grid& first, const Grid& second) {
    const std::vector<double> first_values(first.node_count(), 0.0);
    const std::vector<double> second_values(second.node_count(), 0.0);
    const NodeField<Grid, double> a(first, first_values);
    const NodeField<Grid, double> b(second, second_values);
    return refusal<GridError>([&] { Union(first, a, second, b); });
}

TEST(Unions, AreRefusedWhereRulesDiffer) {
    RedGreenSimplices<2> first(triangles(2));
    RedGreenSimplices<2> second(triangles(2));
    first.adapt([](const Leaf& leaf) { return leaf.coarse == 0 ? Mark::refine : Mark::keep; });
    second.adapt([](const Leaf& leaf) { return leaf.coarse == 1 ? Mark::refine : Mark::keep; });
    EXPECT_EQ(refusal_of_union(first, first), "");
    EXPECT_NE(refusal_of_union(first, second).find("differently, by the rules"), std::string::npos);
}

TEST(Unions, AreRefusedWhereCoarseGridsDiffer) {
    const OctreeGrid<3> grid(hexahedra(2));
    EXPECT_NE(refusal_of_union(grid, OctreeGrid<3>(hexahedra(1))).find("coarse elements"),
              std::string::npos);
    EXPECT_NE(refusal_of_union(grid, OctreeGrid<3>(shaken(hexahedra(2), 1, 0.05)))
                  .find("has other corners"),
              std::string::npos);
}

}  // namespace
