// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where bisections are known at compile time, behind tables too, slices by a plane are those of the
// plain traversal.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "table_in_c.hpp"
#include "thread_executor.hpp"
#include "walked_in_patches.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace slice_bisections_test {

using Unknown = UnknownGrid<LatticeBisection<3>>;

/// The plain traversal may look at more: at elements with a face in the plane and another one on
/// the boundary.
void expect_same_slice(const Slice& a, const Slice& b) {
    expect_same(a.surface, b.surface);
    EXPECT_EQ(a.error_bound, b.error_bound);
    EXPECT_EQ(a.counts.extracted, b.counts.extracted);
    EXPECT_LE(a.counts.visited, b.counts.visited);
}

/// Through the middle and, where the samples allow it, through nodes; in general position; along
/// the boundary, beside it, and nearly along it.
std::vector<Plane> planes_of(const Point& low, const Point& high) {
    const Point middle = 0.5 * (low + high);
    const Point size = high - low;
    return {Plane(middle, {0, 0, 1}),
            Plane(low + 0.43 * size, {0.3, 0.5, 0.81}),
            Plane(middle, {1, 1, 1}),
            Plane(middle, {1, -1, 0}),
            Plane(low, {0, 0, 1}),
            Plane(high, {0, 1, 0}),
            Plane(low + 1e-4 * size, {0, 0, 1}),
            Plane(low + 1e-9 * size, {1e-7, 0, 1}),
            Plane(low - 0.1 * size, {0, 0, 1})};
}

template <class Sample>
void expect_same_slices(const LatticeGeometry<3>& geometry, const std::vector<Sample>& samples,
                        double range) {
    const LatticeBisection<3> known(geometry);
    const Unknown unknown(geometry);
    const LatticeField known_field(known, std::span<const Sample>(samples));
    const LatticeField unknown_field(unknown, std::span<const Sample>(samples));
    const BehindTables tables(known, known_field);
    ASSERT_TRUE(erase(known, known_field).facts().bisects_means);
    ASSERT_EQ(tables.hierarchy->facts().bisects_means, tables.hierarchy->facts().knows_patches);
    ASSERT_FALSE(erase(unknown, unknown_field).facts().bisects_means);
    const HierarchicalIndicator indicator(known, known_field);
    const Point low = known.node_position(0);
    const Point high = known.node_position(known.node_count() - 1);
    std::size_t triangles = 0;
    int number = 0;
    for (const Plane& plane : planes_of(low, high)) {
        SCOPED_TRACE("plane " + std::to_string(number++));
        const Slice whole = slice(known, known_field, plane);
        expect_same_slice(whole, slice(unknown, unknown_field, plane));
        triangles += whole.surface.simplices.size();
        for (const double threshold : {0.0, 0.01, 0.1, 10.0}) {
            SCOPED_TRACE("threshold " + std::to_string(threshold));
            const Threshold by_offset{&indicator, threshold * range};
            const IsosurfaceOptions options{.elements = true};
            const Slice plain =
                slice(unknown, unknown_field, plane, under(by_offset, indicator), options);
            expect_same_slice(
                slice(known, known_field, plane, under(by_offset, indicator), options), plain);
            expect_same_slice(slice(*tables.hierarchy, plane, under(by_offset, indicator), options),
                              plain);
        }
    }
    EXPECT_GT(triangles, 1000U);
}

TEST(KnownBisections, AreSlicedAsThePlainTraversalSlices) {
    for (const Samples& n : {Samples{17, 17, 17}, Samples{20, 9, 13}}) {
        const std::array<Point, 3> turned{{{0, -1, 0}, {1, 0, 0.25}, {0, 0, -1}}};
        for (const SampledField& data : sampled_fields(n)) {
            SCOPED_TRACE(data.name);
            const std::vector<double> doubles(data.values.begin(), data.values.end());
            expect_same_slices<float>({.samples = n}, data.values, data.range);
            expect_same_slices<double>(
                {.samples = n, .spacing = {0.5, 2, 0.3}, .direction = turned}, doubles, data.range);
        }
    }
}

/// A slice on a lattice, in one way or the other.
struct SlicedLattice {
    Samples n{33, 33, 33};
    SampledField data = sampled_fields(n)[0];
    LatticeBisection<3> known{{.samples = n}};
    Unknown unknown{{.samples = n}};
    LatticeField<LatticeBisection<3>, float> known_field{known,
                                                         std::span<const float>(data.values)};
    LatticeField<Unknown, float> unknown_field{unknown, std::span<const float>(data.values)};
    HierarchicalIndicator indicator{known, known_field};
    std::vector<Plane> planes{Plane({16, 16, 16}, {0.3, 0.5, 0.81}), Plane({16, 16, 16}, {0, 0, 1}),
                              Plane({15.5, 16, 16}, {1, 0, 0})};
    std::array<double, 2> thresholds{0.0, 0.02 * data.range};
};

TEST(KnownBisections, AreSlicedByAnyNumberOfThreads) {
    const SlicedLattice c;
    for (const Plane& plane : c.planes) {
        for (const double threshold : c.thresholds) {
            const Threshold criterion{&c.indicator, threshold};
            const Slice one =
                slice(c.unknown, c.unknown_field, plane, under(criterion, c.indicator));
            EXPECT_GT(one.surface.simplices.size(), 50U);
            for (const unsigned threads : {1U, 2U, 5U}) {
                const ThreadExecutor executor(threads);
                expect_same(one.surface, slice(c.known, c.known_field, plane,
                                               under(criterion, c.indicator), {}, {executor})
                                             .surface);
            }
        }
    }
}

/// Triangles without area, around nodes on the slice, are among those of a stream.
TEST(KnownBisections, StreamTheTrianglesOfASlice) {
    const SlicedLattice c;
    for (const Plane& plane : c.planes) {
        for (const double threshold : c.thresholds) {
            const Threshold criterion{&c.indicator, threshold};
            const auto stream = [&](const auto& grid, const auto& field) {
                std::vector<std::array<Point, 3>> triangles;
                std::vector<SimplexStream<3>> sinks;
                sinks.emplace_back([&](const std::array<Point, 3>& x) { triangles.push_back(x); });
                extract_slices({grid, field}, {{&plane}}, std::move(sinks),
                               under(criterion, c.indicator));
                return triangles;
            };
            const auto triangles = stream(c.known, c.known_field);
            EXPECT_GT(triangles.size(), 100U);
            expect_same_bits(triangles, stream(c.unknown, c.unknown_field), "triangles");
        }
    }
}

/// Criteria that are not the threshold of the bounds are asked for one node at a time.
TEST(KnownBisections, AreSlicedUnderOtherCriteria) {
    const SlicedLattice c;
    const HierarchicalIndicator another(c.known, c.known_field);
    const SweptIndicator wavelets = wavelet_indicator({c.known, c.known_field});
    const auto expect_same_under = [&](const Plane& plane, const Criterion& criterion) {
        const Slice a = slice(c.known, c.known_field, plane, under(criterion, c.indicator));
        EXPECT_GT(a.surface.simplices.size(), 50U);
        expect_same_slice(a,
                          slice(c.unknown, c.unknown_field, plane, under(criterion, c.indicator)));
    };
    for (const Plane& plane : c.planes) {
        for (const double threshold : c.thresholds) {
            const Threshold s(&another, threshold);
            expect_same_under(plane, s);
            expect_same_under(plane, s && Threshold(&wavelets, 2 * threshold));
            expect_same_under(plane, Exact{});
        }
    }
}

/// A budget is found by counting the same triangles.
TEST(KnownBisections, KeepTheBudgetOfASlice) {
    const SlicedLattice c;
    for (const Plane& plane : c.planes) {
        const Projection budget{.max_triangles = 700};
        const Slice a = slice(c.known, c.known_field, plane, budget);
        EXPECT_GT(a.surface.simplices.size(), 100U);
        expect_same_slice(a, slice(c.unknown, c.unknown_field, plane, budget));
    }
}

}  // namespace slice_bisections_test
