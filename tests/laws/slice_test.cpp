// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices: closed, planar, each point once, coloured by the data, on every family, in general and in
// degenerate positions.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>

#include "bent_grid.hpp"
#include "closedness.hpp"
#include "cut_cube.hpp"
#include "families.hpp"
#include "is_affine.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace slice_test {

struct PlaneAt {
    const char* name;
    Point through;
    Point normal;
};

/// In general position, and through nodes, edges and faces, of elements and of the domain.
const std::vector<PlaneAt> planes{
    {"oblique", {0.4, 0.5, 0.49}, {0.3, 0.5, 0.81}},
    {"z = 0.37", {0, 0, 0.37}, {0, 0, 1}},
    {"x = 1/2", {0.5, 0, 0}, {1, 0, 0}},
    {"-x = -1/4", {0.25, 0, 0}, {-2, 0, 0}},
    {"x + y = 1", {0.5, 0.5, 0.5}, {1, 1, 0}},
    {"y = z + 1/4", {0, 0.25, 0}, {0, 1, -1}},
    {"x + y + z = 1", {1, 0, 0}, {1, 1, 1}},
    {"z = 0", {0, 0, 0}, {0, 0, 1}},
    {"-z = 0", {0, 0, 0}, {0, 0, -1}},
    {"y = 1", {0, 1, 0}, {0, 1, 0}},
};

template <class Family>
class Slices : public testing::Test {};
TYPED_TEST_SUITE(Slices, Families);

double height_of(const Point& a, const Point& b, const Point& c) {
    const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    return norm(cross(b - a, c - a)) / longest;
}

/// Whether both points lie on one side of the unit cube.
bool on_one_side(const Point& a, const Point& b) {
    for (std::size_t d = 0; d < 3; ++d) {
        for (const double side : {0.0, 1.0}) {
            if (std::abs(a[d] - side) < 1e-12 && std::abs(b[d] - side) < 1e-12) return true;
        }
    }
    return false;
}

/// Expects the plane's part in the unit cube, once where faces of elements are plane: on others the
/// sides of polygons are chords, and polygons may fold.
void expect_plane(const Surface<3>& surface, const PlaneAt& plane, bool affine) {
    expect_closed(surface);
    const Point n = (1 / norm(plane.normal)) * plane.normal;
    for (const Point& x : surface.vertices) EXPECT_NEAR(dot(n, x - plane.through), 0, 1e-12);
    for (const auto& [a, b] : surface.boundary) {
        EXPECT_TRUE(on_one_side(surface.vertices[a], surface.vertices[b]));
    }
    for (const auto& [a, b, c] : surface.simplices) {
        const Point& x = surface.vertices[a];
        const Point twice = cross(surface.vertices[b] - x, surface.vertices[c] - x);
        EXPECT_TRUE(!affine || dot(twice, n) < 0) << "a triangle is turned over";
        EXPECT_GT(height_of(x, surface.vertices[b], surface.vertices[c]), 1e-9 / 64);
    }
    EXPECT_NEAR(surface_report(surface).area, area_in_cube(plane.through, n),
                affine ? 1e-12 : 0.01);
}

TYPED_TEST(Slices, TakeEachPointOfThePlaneOnce) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(2, 7, [](const auto& grid, const auto& samples) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : six_thresholds) {
                const Threshold criterion(&indicator, threshold);
                for (const PlaneAt& plane : planes) {
                    SCOPED_TRACE(std::string(plane.name) + " at threshold " +
                                 std::to_string(threshold));
                    const Plane at(plane.through, plane.normal);
                    const Slice slice =
                        nestgrid::slice(grid, field, at, under(criterion, indicator));
                    expect_plane(slice.surface, plane, is_affine(grid));
                }
            }
        });
    }
}

/// A linear function has no offsets but rounding: a slice is that of the coarse grid at any
/// threshold above it, and of the leaves without a criterion. Both have the colours of the
/// function.
TYPED_TEST(Slices, CarryALinearFunctionExactly) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const auto f = [](const Point& x) { return 2 * x[0] - 3 * x[1] + x[2] + 0.125; };
        for (auto& grid : TypeParam::grids()) {
            refine_at_sphere(grid, 2 * TypeParam::steps);
            const std::vector<double> values = sample_nodes(grid, f);
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
            for (const double threshold : {0.0, 1e-9}) {
                for (const PlaneAt& plane : planes) {
                    const Plane at(plane.through, plane.normal);
                    const Slice s = nestgrid::slice(grid, field, at, {.threshold = threshold});
                    expect_colours(s.surface, f);
                }
            }
        }
    }
}

/// Changes its sign within elements, so that contours of all kinds arise, with vertices inside
/// elements.
class Waves final : public LevelFunction {
public:
    double value(const Point& x) const override {
        return std::sin(97 * x[0] + 61 * x[1] * x[1] + 43 * x[2] + 29 * x[0] * x[2]);
    }
};

TYPED_TEST(Slices, CarryALinearFunctionInsideElements) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const auto f = [](const Point& x) { return 2 * x[0] - 3 * x[1] + x[2] + 0.125; };
        for (auto& grid : TypeParam::grids()) {
            if (!is_affine(grid)) continue;  // on others the map of an element bends chords
            refine_at_sphere(grid, 2 * TypeParam::steps);
            const std::vector<double> values = sample_nodes(grid, f);
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
            for (const double threshold : {0.0, 1e-9}) {
                const Slice s = slice(grid, field, Waves{}, {.threshold = threshold});
                EXPECT_FALSE(s.surface.simplices.empty());
                expect_colours(s.surface, f);
            }
        }
    }
}

TYPED_TEST(Slices, AreClosedOnCurvedFunctions) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const Sphere round({0.5, 0.5, 0.5}, 0.25);
        const Sphere large({0.4, 0.5, 0.6}, 0.7);
        const Cylinder upright({0.5, 0.5, 0.5}, {0, 0, 1}, 0.3);
        for_each_field_at_sphere<TypeParam>(2, 7, [&](const auto& grid, const auto& samples) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : {0.0, 0.1, 1.0}) {
                const Threshold criterion(&indicator, threshold);
                for (const LevelFunction* f : {static_cast<const LevelFunction*>(&round),
                                               static_cast<const LevelFunction*>(&large),
                                               static_cast<const LevelFunction*>(&upright)}) {
                    expect_closed(
                        nestgrid::slice(grid, field, *f, under(criterion, indicator)).surface);
                }
            }
        });
    }
}

void expect_same_triangles(const Slice& a, const Slice& b) {
    expect_same_bits(a.surface.vertices, b.surface.vertices, "vertices");
    expect_same_bits(a.surface.attributes, b.surface.attributes, "attributes");
    expect_same_bits(a.surface.simplices, b.surface.simplices, "simplices");
}

/// One walk draws what several do, and threads change no bit.
TYPED_TEST(Slices, AreTheSameTogetherAndByThreads) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const Plane first(planes[2].through, planes[2].normal);
        const Sphere second({0.5, 0.5, 0.5}, 0.4);
        for (auto& grid : TypeParam::grids()) {
            refine_at_sphere(grid, 2 * TypeParam::steps);
            const auto samples = catching_fields(grid.node_positions(), 3)[1];
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            const Threshold criterion(&indicator, 0.1);
            const auto together =
                slices({grid, field}, {{&first, &second}, {0.0}}, under(criterion, indicator));
            const auto threaded = slices({grid, field}, {{&first, &second}, {0.0}},
                                         under(criterion, indicator), {}, {ThreadExecutor(3)});
            ASSERT_EQ(together.size(), 3U);
            for (std::size_t i = 0; i < 3; ++i) expect_same(together[i], threaded[i]);
            expect_same_triangles(together[0],
                                  slice(grid, field, first, under(criterion, indicator)));
            expect_same_triangles(together[1],
                                  slice(grid, field, second, under(criterion, indicator)));
        }
    }
}

/// Position bounds tell which elements of a bent grid a slice may pass through, and change no bit.
/// Some of the planes touch no corner of a coarse element, but bulges of finer elements.
TYPED_TEST(Slices, VisitFewerElementsWithPositionBounds) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const Sphere round({0.5, 0.5, 0.5}, 0.3);
        std::vector<nestgrid::Plane> flat{{{0.4, 0.5, 0.49}, {0.3, 0.5, 0.81}}};
        for (double x = -0.03; x < 1.04; x += 0.01)
            flat.emplace_back(Point{x, 0, 0}, Point{1, 0, 0});
        std::vector<const LevelFunction*> functions{&round};
        for (const nestgrid::Plane& at : flat) functions.push_back(&at);
        for (auto& straight : TypeParam::grids()) {
            refine_at_sphere(straight, 3 * TypeParam::steps);
            const Bent<typename TypeParam::Grid> grid(straight);
            const auto samples = catching_fields(straight.node_positions(), 3)[1];
            const NodeField<typename TypeParam::Grid, double> field(straight, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h);
            const SweptIndicator bounds = position_bounds(h);
            const IsosurfaceOptions bounded{.position_bounds = &bounds};
            for (const double threshold : {0.0, 0.1}) {
                const Threshold criterion(&indicator, threshold);
                std::size_t drawn = 0;
                for (const LevelFunction* at : functions) {
                    const Slice all = slice(h, *at, under(criterion, indicator));
                    const Slice few = slice(h, *at, under(criterion, indicator), bounded);
                    expect_same_triangles(all, few);
                    EXPECT_LE(few.counts.calls, all.counts.calls);
                    drawn += few.surface.simplices.empty() ? 0 : 1;
                }
                EXPECT_GT(drawn, 90U);
                EXPECT_LT(
                    slice(h, *functions[1], under(criterion, indicator), bounded).counts.calls,
                    slice(h, *functions[1], under(criterion, indicator)).counts.calls);
            }
        }
    }
}

/// Planes through faces of cells of an octree take two triangles from each.
TEST(SlicesOfBoxes, TakeTwoTrianglesOfEachFace) {
    for (auto& grid : BalancedOctree::grids()) {
        if (!is_affine(grid)) continue;
        const std::size_t coarse = grid.coarse_count();
        const auto cells = static_cast<std::size_t>(std::llround(std::cbrt(coarse)));
        const std::vector<double> values(grid.node_count(), 1.0);
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
        for (std::size_t k = 0; k <= cells; ++k) {
            const double z = static_cast<double>(k) / static_cast<double>(cells);
            const Slice s = slice(grid, field, Plane({0, 0, z}, {0, 0, 1}));
            EXPECT_EQ(s.surface.simplices.size(), 2 * cells * cells);
            EXPECT_EQ(s.surface.vertices.size(), (cells + 1) * (cells + 1));
        }
    }
}

TEST(SlicesOfBoxes, RefuseWrongInput) {
    expect_refused([] { Plane({0, 0, 0}, {0, 0, 0}); }, "the normal of the plane is 0");
    expect_refused([] { Plane({0, NAN, 0}, {0, 0, 1}); }, "the point on the plane has a coord");
    expect_refused([] { Sphere({0, 0, 0}, -1); }, "the radius of the sphere is not a positive");
    expect_refused([] { Cylinder({0, 0, 0}, {0, 0, 0}, 1); }, "the axis of the cylinder is 0");
    for (auto& grid : BalancedQuadtree::grids()) {
        const std::vector<double> values(grid.node_count(), 1.0);
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
        expect_refused(
            [&] {
                slice(grid, field, Plane({0, 0, 0}, {0, 0, 1}));
            },
            "the hierarchy has dimension 2, not 3");
    }
}

}  // namespace slice_test
