// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Curved slices whose edges are collapsed within a distance keep it there and back, keep the errors
// of their colours, and stay manifolds in the domain. Judged by brute force over points.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "closedness.hpp"
#include "colour_misses.hpp"
#include "families.hpp"
#include "five_at_nodes.hpp"
#include "hiding_forest.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "surface_distance.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace collapse_slice_test {

/// Inside the unit cube, nearer to its boundary than the distance; and through the boundary.
const Sphere near_boundary({0.5, 0.45, 0.33}, 0.32);
const Cylinder across({0.45, 0.55, 0}, {0.2, 0.1, 1}, 0.3);

/// The greatest difference between the least and the greatest value of each component, times a
/// part.
template <class Real>
std::vector<double> errors_of(const Hierarchy<Real>& h, const HierarchicalIndicator& indicator,
                              double part) {
    const double error = part * (indicator.greatest() - indicator.least()) + 1e-9;
    return std::vector<double>(static_cast<std::size_t>(h.facts().components), error);
}

struct Counts {
    std::size_t before = 0;
    std::size_t after = 0;
};

/// Collapses a slice of all data, and judges what is left of it.
/// \return that
template <class Real>
Surface<3> expect_laws(const Hierarchy<Real>& h, const LevelFunction& function,
                       const HierarchicalIndicator& indicator, const std::vector<double>& errors,
                       double distance, Counts& counts) {
    const Surface<3> whole = slice(h, function).surface;
    Surface<3> surface = whole;
    const Collapsed result = collapse_colours(
        surface, h, indicator, {.errors = errors, .nearness = Nearness{whole, distance}});
    EXPECT_EQ(result.missed, 0U);
    EXPECT_LE(result.error, errors[0] * (1 + 1e-9));
    const SurfaceReport is = surface_report(surface);
    const SurfaceReport was = surface_report(whole);
    if (was.open_edges == 0) expect_closed(surface);  // it is open towards what is hidden
    EXPECT_EQ(is.open_edges, was.open_edges);
    EXPECT_EQ(is.nonmanifold_vertices, was.nonmanifold_vertices);
    EXPECT_EQ(is.euler, was.euler);
    EXPECT_EQ(is.components, was.components);
    EXPECT_EQ(is.triangles == was.triangles, result.collapses == 0);
    expect_kept(surface, whole, distance);
    Misses misses(surface, errors);
    misses.look_all_over(h);
    EXPECT_EQ(misses.exceeding_beside(whole), 0U);
    EXPECT_EQ(misses.outside(), 0U);
    counts.before += whole.simplices.size();
    counts.after += surface.simplices.size();
    return surface;
}

void expect_in_unit_cube(const Surface<3>& s) {
    for (const Point& x : s.vertices) {
        for (const double at : x) EXPECT_LE(std::abs(at - 0.5), 0.5 + 1e-9);
    }
}

template <class Family>
class CollapsedSlices : public testing::Test {};
TYPED_TEST_SUITE(CollapsedSlices, Families);

TYPED_TEST(CollapsedSlices, KeepTheDistanceTheColoursAndTheDomain) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        Counts counts;
        for_each_field_at_sphere<TypeParam>(2, 8, [&](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h);
            const auto errors = errors_of(h, indicator, 0.1);
            for (const LevelFunction* f : {static_cast<const LevelFunction*>(&near_boundary),
                                           static_cast<const LevelFunction*>(&across)}) {
                expect_in_unit_cube(expect_laws(h, *f, indicator, errors, 0.1, counts));
            }
        });
        EXPECT_LT(10 * counts.after, 9 * counts.before);
    }
}

/// Borders move on the faces of the domain that they lie on.
TEST(CollapsedSlicesOfLattices, KeepBordersOnTheBoundary) {
    const LatticeBisection<3> grid({.samples = {9, 9, 9}, .spacing = {0.125, 0.125, 0.125}});
    const auto values = sample({9, 9, 9}, [](double x, double y, double z) { return x + y * z; });
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    const Surface<3> whole = slice(grid, field, across).surface;
    Surface<3> surface = whole;
    collapse_colours(surface, erase(grid, field), indicator,
                     {.errors = {0.1}, .nearness = Nearness{whole, 0.05}});
    EXPECT_LT(surface.boundary.size(), whole.boundary.size() / 2);
    EXPECT_LT(8 * surface.simplices.size(), whole.simplices.size());
    expect_borders_on_cube(surface);
    expect_kept(surface, whole, 0.05);
}

/// Each component keeps an error of its own, and the distance decides where colours are constant.
TEST(CollapsedSlicesOfLattices, KeepAnErrorForEachComponent) {
    auto grid = BisectionTetrahedra::grids()[0];
    refine_at_sphere(grid, 2 * BisectionTetrahedra::steps);
    std::vector<std::array<double, 5>> values;
    for (const Point& x : grid.node_positions()) {
        values.push_back({x[0], std::sin(7 * x[1]), 1000 * x[1] * x[2], 1, norm(x)});
    }
    const FiveAtNodes field(grid, std::move(values));
    const auto h = erase(grid, field);
    const HierarchicalIndicator indicator(h);
    Counts counts;
    expect_laws(h, near_boundary, indicator, {0.1, 0.2, 80, 0.01, 0.03}, 0.04, counts);
    EXPECT_LT(2 * counts.after, counts.before);
    Counts finer;
    expect_laws(h, near_boundary, indicator, {1e9, 1e9, 1e9, 1, 1e9}, 0.01, finer);
    Counts coarser;
    expect_laws(h, near_boundary, indicator, {1e9, 1e9, 1e9, 1, 1e9}, 0.04, coarser);
    EXPECT_LT(coarser.after, finer.after);
    EXPECT_LT(coarser.after, counts.after);
}

/// A pyramid whose tip would lie outside the unit cube, and is cut off beside its boundary.
class CutPyramid final : public LevelFunction {
public:
    double value(const Point& x) const override {
        const double aside = std::max(std::abs(x[0] - 0.5), std::abs(x[1] - 0.45));
        return std::max(aside - x[2] - 0.07, 0.02 - x[2]);
    }
};

/// A slice nearer to the boundary than its distance does not pass through that.
TEST(CollapsedSlicesOfLattices, StayInTheDomain) {
    const double spacing = 1.0 / 24;
    const LatticeOctree<3> grid({.samples = {25, 25, 25}, .spacing = {spacing, spacing, spacing}});
    const std::vector<float> values(25 * 25 * 25, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    const auto h = erase(grid, field);
    const HierarchicalIndicator indicator(h);
    Counts counts;
    expect_in_unit_cube(expect_laws(h, CutPyramid(), indicator, {1}, 0.1, counts));
    EXPECT_LT(8 * counts.after, counts.before);
}

/// No triangle enters what is hidden.
TEST(CollapsedSlicesOfForests, KeepOutOfWhatIsHidden) {
    std::mt19937 random(5);
    Counts counts;
    for (const Forest<3>& shown : {kuhn<3>(3), boxes<3>(random, 2)}) {
        Forest<3> forest = shown;
        refine_randomly(forest, random, 1000);
        for (const unsigned hidden_of_20 : {1U, 4U}) {
            const HidingForest<3> grid(forest,
                                       [&](std::size_t) { return random() % 20 < hidden_of_20; });
            const ForestField<3> field(grid, [](const Point& x) { return x[0]; });
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h);
            expect_laws(h, near_boundary, indicator, {0.5}, 0.15, counts);
            expect_laws(h, across, indicator, {0.5}, 0.15, counts);
        }
    }
    EXPECT_LT(counts.after, counts.before);
}

TEST(CollapsedSlicesOfLattices, AreTheSameWithAnyNumberOfThreads) {
    const Samples n{57, 57, 57};  // more than one block
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[0];
    const LatticeField field(grid, std::span<const float>(data.values));
    const auto h = erase(grid, field);
    const HierarchicalIndicator indicator(h);
    const Surface<3> whole = slice(h, Sphere({28, 27, 29}, 24)).surface;
    EXPECT_GT(whole.vertices.size(), 1U << 14U);
    const ColourCollapseOptions options{.errors = {0.2 * data.range},
                                        .nearness = Nearness{whole, 0.5}};
    Surface<3> one = whole;
    collapse_colours(one, h, indicator, options);
    EXPECT_LT(one.simplices.size(), whole.simplices.size() / 8);
    for (const std::size_t threads : {3U}) {
        Surface<3> many = whole;
        collapse_colours(many, h, indicator, options, ThreadExecutor(threads));
        expect_same_bits(many.vertices, one.vertices, "vertices");
        expect_same_bits(many.attributes, one.attributes, "attributes");
        expect_same_bits(many.simplices, one.simplices, "simplices");
    }
}

/// What is too far from the beginning stays so, and is told.
TEST(CollapsedSlicesOfLattices, TellWhatWasTooFarFromTheBeginning) {
    const LatticeBisection<3> grid({.samples = {17, 17, 17}});
    const std::vector<float> values(17 * 17 * 17, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    const Surface<3> whole = slice(grid, field, Sphere({8, 8, 8}, 6)).surface;
    const Surface<3> other = slice(grid, field, Sphere({8, 8, 8}, 5)).surface;
    Surface<3> surface = other;
    const ColourCollapseOptions options{.errors = {1}, .nearness = Nearness{whole, 0.2}};
    const Collapsed result = collapse_colours(surface, erase(grid, field), indicator, options);
    EXPECT_EQ(result.exceeding, other.simplices.size());
    EXPECT_EQ(result.missed, whole.simplices.size());
    EXPECT_EQ(surface.simplices, other.simplices);
    Surface<3> nothing;
    EXPECT_EQ(collapse_colours(nothing, erase(grid, field), indicator, options).missed,
              whole.simplices.size());
}

TEST(CollapsedSlicesOfLattices, RefuseOptionsOutOfRange) {
    const LatticeBisection<3> grid({.samples = {5, 5, 5}});
    const std::vector<float> values(125, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    const Surface<3> whole = slice(grid, field, Sphere({2, 2, 2}, 1.5)).surface;
    const auto refuse = [&](const ColourCollapseOptions& options, const char* why) {
        Surface<3> s = whole;
        expect_refused([&] { collapse_colours(s, erase(grid, field), indicator, options); }, why);
    };
    refuse({.errors = {1}, .nearness = Nearness{whole, 0}}, "not a positive number");
    refuse({.errors = {1}, .scale = 1, .nearness = Nearness{whole, 1}}, "exclude each other");
    refuse({.errors = {1}, .nearness = Nearness{whole, 1}, .turn = 90}, "greatest turn");
    refuse({.nearness = Nearness{whole, 1}}, "no error to keep");
    const LatticeBisection<2> plane({.samples = {2, 2}});
    const LatticeField flat(plane, std::span<const float>(values).first(4));
    const HierarchicalIndicator in_plane(plane, flat);
    Surface<3> s = whole;
    expect_refused(
        [&] {
            collapse_colours(s, erase(plane, flat), in_plane,
                             {.errors = {1}, .nearness = Nearness{whole, 1}});
        },
        "dimension");
}

}  // namespace collapse_slice_test
