// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What people need from a surface: measures with their order, attributes, reference coordinates,
// normals, budgets, regions of interest, several isovalues, streams.
#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/derived_field.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/detail/shape_functions.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "five_at_nodes.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "table_in_c.hpp"

using namespace nestgrid_test;

namespace surface_uses_test {

constexpr double pi = 3.14159265358979323846;
const Point centre{0.5, 0.5, 0.5};

/// A scalar and what is to be carried onto its surface: 0.36 - r, then the position, then x y.
template <class Grid>
FiveAtNodes<Grid> scalar_and_more(const Grid& grid) {
    std::vector<std::array<double, 5>> values;
    for (const Point& p : grid.node_positions()) {
        values.push_back({0.36 - norm(p - centre), p[0], p[1], p[2], p[0] * p[1]});
    }
    return {grid, std::move(values)};
}

template <class Grid>
void uniform(Grid& grid, int times) {
    for (int i = 0; i < times; ++i) grid.adapt([](const Leaf&) { return Mark::refine; });
}

template <class Grid>
std::vector<Point> corners_of(const Grid& grid, const typename Grid::Element& e, Shape shape) {
    static const void* of = nullptr;
    static std::vector<Point> nodes;
    if (of != &grid || nodes.size() != grid.node_count()) nodes = grid.node_positions();
    of = &grid;
    std::array<NodeKey, max_corners> keys;
    const std::size_t n = topology(shape).corners;
    grid.corner_keys(e, std::span(keys).first(n));
    std::vector<Point> x;
    for (std::size_t i = 0; i < n; ++i) x.push_back(nodes[static_cast<std::size_t>(keys[i])]);
    return x;
}

template <class Family>
class Uses : public testing::Test {};
using SolidFamilies = testing::Types<BisectionTetrahedra, RedGreenTetrahedra, RedGreenMixed3,
                                     BalancedOctree, UnbalancedOctree, Prisms>;
TYPED_TEST_SUITE(Uses, SolidFamilies);

TYPED_TEST(Uses, MeasuresConvergeWithOrderTwo) {
    std::array<double, 4> last{};
    for (int level = 2; level <= 4; ++level) {
        auto grid = TypeParam::grids()[0];
        uniform(grid, level * TypeParam::steps);
        const auto field = scalar_and_more(grid);
        const auto result = isosurface(grid, field, 0.0);
        expect_closed(result.surface);
        const SurfaceMeasurement m = measure_surface(result.surface);
        ASSERT_EQ(m.components.size(), 1U);
        EXPECT_TRUE(m.total.closed);
        const double r = 0.36;
        const double area = 4 * pi * r * r;
        const double volume = area * r / 3;
        // The flux of the position is three times the volume; x integrates to its mean, 1/2.
        const std::array<double, 4> error{
            std::abs(m.total.area - area) / area, std::abs(m.total.volume - volume) / volume,
            std::abs(flux(result.surface, m)[0] / 3 - volume) / volume,
            std::abs(m.total.integrals[0] - area / 2) / area};
        for (std::size_t i = 0; i < 4; ++i) {
            if (level == 4) {
                EXPECT_LT(error[i], 0.02) << i;
                EXPECT_LT(error[i], last[i] / 2.8) << i;
            }
            last[i] = error[i];
        }
        EXPECT_NEAR(norm(m.total.area_vector), 0, 1e-12);
    }
}

/// The order of triangles, and the corner that each begins with, change no bit.
TYPED_TEST(Uses, MeasuresDoNotDependOnTheOrderOfTriangles) {
    auto grid = TypeParam::grids()[0];
    uniform(grid, 3 * TypeParam::steps);
    const auto field = scalar_and_more(grid);
    Surface<3> surface = isosurface(grid, field, 0.0).surface;
    const SurfaceMeasurement drawn = measure_surface(surface);
    const double through = flux(surface, drawn)[0];
    std::mt19937 random(1);
    std::shuffle(surface.simplices.begin(), surface.simplices.end(), random);
    for (auto& t : surface.simplices) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    const SurfaceMeasurement turned = measure_surface(surface);
    EXPECT_EQ(turned.total.area, drawn.total.area);
    EXPECT_EQ(turned.total.area_vector, drawn.total.area_vector);
    EXPECT_EQ(turned.total.volume, drawn.total.volume);
    EXPECT_EQ(turned.total.integrals, drawn.total.integrals);
    EXPECT_EQ(flux(surface, turned)[0], through);
}

TYPED_TEST(Uses, AttributesAndReferenceCoordinatesSayWhereTheTrianglesAre) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        const auto field = scalar_and_more(grid);
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : {0.0, 0.05}) {
            const auto result = isosurface(grid, field, 0.0, under(indicator, threshold),
                                           {.normals = true, .reference = true});
            const auto& s = result.surface;
            const auto elements = s.elements.template as<typename TypeParam::Grid::Element>();
            ASSERT_GT(s.simplices.size(), 20U);
            ASSERT_EQ(s.reference.size(), 3 * s.simplices.size());
            ASSERT_EQ(s.attributes.size(), 4 * s.vertices.size());
            ASSERT_EQ(s.normals.size(), s.vertices.size());
            const auto outwards = [](const Point& x) {
                return (1 / norm(x - centre)) * (x - centre);
            };
            // By vertex, the least cosine of the direction outwards with a triangle around.
            std::vector<double> least_outwards(s.vertices.size(), 1);
            for (const auto& t : s.simplices) {
                const Point& x = s.vertices[t[0]];
                const Point n = cross(s.vertices[t[1]] - x, s.vertices[t[2]] - x);
                for (const std::uint32_t v : t) {
                    const double cosine = dot(n, outwards(s.vertices[v])) / norm(n);
                    least_outwards[v] = std::min(least_outwards[v], cosine);
                }
            }
            // The attributes are projected with the same S, so the position as an attribute is the
            // position, wherever elements are not curved by it.
            for (std::size_t v = 0; v < s.vertices.size(); ++v) {
                for (std::size_t d = 0; d < 3; ++d) {
                    EXPECT_NEAR(s.attributes[4 * v + d], s.vertices[v][d], 1e-12);
                }
                const Point out = outwards(s.vertices[v]);
                EXPECT_NEAR(norm(s.normals[v]), 1, 1e-12);
                // Beside slivers that face elsewhere, normals agree with these.
                const double usual = threshold == 0 ? 0.8 : 0.5;
                EXPECT_GT(dot(s.normals[v], out), least_outwards[v] > 0.75 ? usual : 0.2);
            }
            for (std::size_t c = 0; c < s.reference.size(); ++c) {
                const std::size_t e = s.element_of[c / 3];
                const Shape shape = s.shape_of[e];
                const std::vector<Point> x = corners_of(grid, elements[e], shape);
                const auto w = shape_functions(shape, s.reference[c]);
                Point there{0, 0, 0};
                for (std::size_t i = 0; i < topology(shape).corners; ++i) {
                    EXPECT_GE(w[i], -1e-9);
                    there = there + w[i] * x[i];
                }
                const Point& v = s.vertices[s.simplices[c / 3][c % 3]];
                EXPECT_NEAR(norm(there - v), 0, 1e-6);
            }
        }
    }
}

TYPED_TEST(Uses, SeveralIsovaluesInOneTraversalAreThoseOfSeveral) {
    auto grid = TypeParam::grids()[0];
    refine_at_sphere(grid, 2 * TypeParam::steps);
    for (const NodalSamples& samples : catching_fields(grid.node_positions(), 1)) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        const Threshold criterion{&indicator, 0.01};
        const std::array<double, 3> isovalues{-0.1, 0, 0.05};
        const auto together = isosurfaces(grid, field, std::span<const double>(isovalues),
                                          under(criterion, indicator), {.cap = true});
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            const auto alone =
                isosurface(grid, field, isovalues[i], under(criterion, indicator), {.cap = true});
            EXPECT_EQ(together[i].surface.vertices, alone.surface.vertices);
            EXPECT_EQ(together[i].surface.simplices, alone.surface.simplices);
            EXPECT_EQ(together[i].error_bound, alone.error_bound);
            expect_closed(together[i].surface, true);
        }
    }
}

TYPED_TEST(Uses, StreamsHandOutTheSameTriangles) {
    auto grid = TypeParam::grids()[0];
    refine_at_sphere(grid, 2 * TypeParam::steps);
    for (const NodalSamples& samples : catching_fields(grid.node_positions(), 1)) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        const Threshold criterion{&indicator, 0.01};
        const double isovalue = 0;
        std::vector<std::array<Point, 3>> triangles;
        const auto keep = [&](const std::array<Point, 3>& x) { triangles.push_back(x); };
        extract_isosurfaces(grid, field, std::span<const double>(&isovalue, 1),
                            std::vector{SimplexStream<3>(keep)}, under(criterion, indicator),
                            {.cap = true});
        const auto result =
            isosurface(grid, field, isovalue, under(criterion, indicator), {.cap = true});
        const auto& s = result.surface;
        ASSERT_EQ(triangles.size(), s.simplices.size());
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_EQ(triangles[t][i], s.vertices[s.simplices[t][i]]);
            }
        }
    }
}

/// The part of the cube below a plane, and between two.
TYPED_TEST(Uses, VolumesBetweenIsovaluesAreExactForLinearFunctions) {
    auto grid = TypeParam::grids()[0];
    refine_at_sphere(grid, 2 * TypeParam::steps);
    const auto values = sample_nodes(grid, [](const Point& x) { return x[0] + x[1] + x[2]; });
    const NodeField<typename TypeParam::Grid, double> field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    // Cuts are kept 2^-20 of an edge away from its ends.
    EXPECT_NEAR(volume_between({grid, field}, 2.4, 9.0, under(indicator, 0)), 0.6 * 0.6 * 0.6 / 6,
                1e-5);
    EXPECT_NEAR(volume_between({grid, field}, 0.6, 2.4, under(indicator, 0)),
                1 - 0.6 * 0.6 * 0.6 / 3, 1e-5);
    EXPECT_NEAR(volume_between({grid, field}, -1, 4, under(indicator, 0)), 1, 1e-12);
    EXPECT_THROW(volume_between({grid, field}, 1, 0, under(indicator, 0)), InvalidInput);
}

/// Derived, then projected: the same surface as that of the derived values themselves.
TYPED_TEST(Uses, DerivedScalarsAreProjectedAfterwards) {
    auto grid = TypeParam::grids()[0];
    refine_at_sphere(grid, 2 * TypeParam::steps);
    const auto field = scalar_and_more(grid);
    const auto derive = [](std::span<const double> u) {
        return std::hypot(u[1] - 0.5, u[2] - 0.5, u[3] - 0.5);
    };
    const auto direct = sample_nodes(grid, [&](const Point& x) {
        return derive(std::array<double, 4>{0, x[0], x[1], x[2]});
    });
    const NodeField<typename TypeParam::Grid, double> directly(grid, direct);
    const DerivedField<FiveAtNodes<typename TypeParam::Grid>, decltype(derive), 2> derived(field,
                                                                                           derive);
    for (const double threshold : {0.0, 0.02}) {
        const auto a = isosurface(grid, directly, 0.33, {.threshold = threshold}).surface;
        const auto b = isosurface(grid, derived, 0.33, {.threshold = threshold}).surface;
        expect_same_simplices(a, b);
        ASSERT_EQ(b.attributes.size(), 2 * b.vertices.size());
        for (std::size_t v = 0; v < b.vertices.size(); ++v) {  // the first two of the field
            EXPECT_NEAR(b.attributes[2 * v + 1], b.vertices[v][0], 1e-9);
        }
    }
    const DerivedField<FiveAtNodes<typename TypeParam::Grid>, Component> first(field, Component{0});
    expect_same_simplices(isosurface(grid, first, 0.0).surface,
                          isosurface(grid, field, 0.0).surface);
    const std::array<double, 3> v{2, 3, 6};
    EXPECT_EQ(Magnitude{}(std::span<const double>(v)), 7);
}

/// A shell: its level sets run into opposite directions, and every corner stays in its element.
TYPED_TEST(Uses, BandsAreClosedAroundTheirVolume) {
    auto grid = TypeParam::grids()[0];
    refine_at_sphere(grid, 2 * TypeParam::steps);
    const auto field = scalar_and_more(grid);
    const HierarchicalIndicator indicator(grid, field);
    for (const double threshold : {0.0, 0.02}) {
        const Threshold criterion{&indicator, threshold};
        const auto band = isoband(grid, field, -0.05, 0.1, under(criterion, indicator),
                                  {.normals = true, .reference = true});
        const auto& s = band.surface;
        const auto elements = s.elements.template as<typename TypeParam::Grid::Element>();
        expect_closed(s);
        const SurfaceMeasurement measured = measure_surface(s);
        const double volume =
            volume_between({grid, field}, -0.05, 0.1, under(indicator, threshold));
        EXPECT_GT(volume, 0);
        EXPECT_TRUE(measured.total.closed);
        EXPECT_NEAR(measured.total.volume, volume, 1e-12);
        EXPECT_EQ(measured.components.size(), 2U);
        ASSERT_EQ(s.normals.size(), s.vertices.size());
        ASSERT_EQ(s.attributes.size(), 4 * s.vertices.size());
        for (std::size_t v = 0; v < s.vertices.size(); ++v) {
            const Point out = s.vertices[v] - centre;
            EXPECT_GT(dot(s.normals[v], out) * (norm(out) - 0.335), 0);
        }
        for (std::size_t c = 0; c < s.reference.size(); ++c) {
            const std::size_t e = s.element_of[c / 3];
            const std::vector<Point> x = corners_of(grid, elements[e], s.shape_of[e]);
            const auto w = shape_functions(s.shape_of[e], s.reference[c]);
            Point there{0, 0, 0};
            for (std::size_t i = 0; i < x.size(); ++i) there = there + w[i] * x[i];
            EXPECT_NEAR(norm(there - s.vertices[s.simplices[c / 3][c % 3]]), 0, 1e-6);
        }
        EXPECT_THROW(isoband(grid, field, 0.1, 0.1, under(criterion, indicator)), InvalidInput);
        EXPECT_THROW(isoband(grid, field, 0, 0.1, under(criterion, indicator), {.cap = true}),
                     InvalidInput);
    }
}

template <class Grid, class Field>
void expect_best_threshold(const Grid& grid, const Field& field, double isovalue) {
    const HierarchicalIndicator indicator(grid, field);
    const auto triangles = [&](double threshold) {
        return isosurface(grid, field, isovalue, under(indicator, threshold))
            .surface.simplices.size();
    };
    const std::size_t finest = triangles(0);
    for (const std::size_t budget : {finest / 40, finest / 7, finest / 2, finest, 2 * finest}) {
        SCOPED_TRACE(budget);
        const TriangleBudget best =
            isosurface<3>(erase(grid, field), isovalue, under(indicator, {.max_triangles = budget}))
                .search;
        EXPECT_LE(best.triangles, budget);
        EXPECT_EQ(triangles(best.threshold), best.triangles);
        EXPECT_LE(best.extracted, 20 * budget);
        if (best.threshold > 0) {
            // Stopping numbers are bfloat16: nothing changes between this one and the one below.
            const std::uint16_t code = detail::bfloat16_above(static_cast<float>(best.threshold));
            EXPECT_EQ(detail::bfloat16_value(code), best.threshold);
            EXPECT_GT(triangles(detail::bfloat16_value(static_cast<std::uint16_t>(code - 1))),
                      budget);
        } else {
            EXPECT_GE(budget, finest);
        }
        const auto result = isosurface(grid, field, isovalue, {.max_triangles = budget});
        EXPECT_EQ(result.surface.simplices.size(), best.triangles);
    }
    EXPECT_THROW(isosurface<3>(erase(grid, field), indicator.least() - 1,
                               under(indicator, {.max_triangles = 1}), {.cap = true})
                     .search,
                 InvalidInput);
}

TEST(TriangleBudgets, AreKeptByTheLeastThreshold) {
    const Samples n{33, 33, 33};
    const SampledField data = sampled_fields(n)[1];
    const LatticeBisection<3> tetrahedra({.samples = n});
    const LatticeOctree<3> hexahedra({.samples = n});
    expect_best_threshold(tetrahedra, LatticeField(tetrahedra, std::span<const float>(data.values)),
                          data.isovalue);
    expect_best_threshold(hexahedra, LatticeField(hexahedra, std::span<const float>(data.values)),
                          data.isovalue);
}

/// By stars and by sweeps.
TEST(Regions, AreTheSameHoweverTheyAreFound) {
    const LatticeBisection<3> grid({.samples = {17, 12, 20}});
    const auto inside = [](const Point& x) { return norm(x - Point{5, 5, 6}) < 4; };
    const Region by_stars(grid, inside);
    const TableInC in_c(grid);  // without stars
    const Region by_sweeps(*open_table(in_c.table), inside);
    std::size_t count = 0;
    for (std::size_t i = 0; i < grid.node_count(); ++i) {
        const auto node = static_cast<NodeKey>(i);
        ASSERT_EQ(by_stars.contains(node), by_sweeps.contains(node));
        ASSERT_LE(inside(grid.node_position(node)), by_stars.contains(node));
        count += by_stars.contains(node) ? 1 : 0;
    }
    EXPECT_GT(count, 260U);
    EXPECT_LT(count, grid.node_count() / 2);
}

/// "200,000 triangles, fine inside this box."
TEST(Regions, LeaveTheRestOfABudgetToTheOutside) {
    const Samples n{33, 33, 33};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[1];
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    const Region region(grid, [](const Point& x) { return x[0] < 10; });
    const auto criterion_at = [&](double threshold) {
        return fine_inside(region, indicator, threshold, 0);
    };
    const auto fine = isosurface(grid, field, data.isovalue, under(indicator, 0));
    const std::size_t budget = fine.surface.simplices.size() * 2 / 3;
    const TriangleBudget best =
        isosurface<3>(erase(grid, field), data.isovalue,
                      under(criterion_at, indicator, {.max_triangles = budget}))
            .search;
    const auto mixed =
        isosurface(grid, field, data.isovalue, under(criterion_at(best.threshold), indicator));
    EXPECT_EQ(mixed.surface.simplices.size(), best.triangles);
    EXPECT_LE(best.triangles, budget);
    expect_closed(mixed.surface);
    const auto inside = [](const Point& x) { return x[0] < 9; };  // elements end in the region
    EXPECT_EQ(std::count_if(mixed.surface.vertices.begin(), mixed.surface.vertices.end(), inside),
              std::count_if(fine.surface.vertices.begin(), fine.surface.vertices.end(), inside));
}

/// Fine in a box, coarse elsewhere, closed everywhere.
TYPED_TEST(Uses, RegionsHaveTheirOwnThreshold) {
    auto grid = TypeParam::grids()[0];
    uniform(grid, 3 * TypeParam::steps);
    // One element more than where the surface is compared: those across the border are mixed.
    const Region region(grid, [](const Point& x) { return x[0] > 0.3 && x[1] > 0.3; });
    const auto inside = [](const Point& x) { return x[0] > 0.56 && x[1] > 0.56; };
    for (const NodalSamples& samples : catching_fields(grid.node_positions(), 1)) {
        SCOPED_TRACE(samples.name);
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        const auto criterion = fine_inside(region, indicator, 0.5, 0.0);
        ASSERT_TRUE(criterion.saturated());
        const auto mixed =
            isosurface(grid, field, 0.0, under(criterion, indicator), {.verify = true});
        const auto fine = isosurface(grid, field, 0.0, under(indicator, 0));
        const auto coarse = isosurface(grid, field, 0.0, under(indicator, 0.5));
        expect_closed(mixed.surface);
        // In the region every vertex of the fine surface is there.
        std::set<Point> vertices(mixed.surface.vertices.begin(), mixed.surface.vertices.end());
        std::size_t within = 0;
        for (const auto& t : fine.surface.simplices) {
            const auto& v = fine.surface.vertices;
            if (!inside(v[t[0]]) || !inside(v[t[1]]) || !inside(v[t[2]])) continue;
            ++within;
            for (const std::uint32_t i : t) EXPECT_EQ(vertices.count(v[i]), 1U);
        }
        if (samples.name == "sphere" || samples.name == "noise") {
            EXPECT_GT(within, 10U);
            EXPECT_LT(mixed.surface.simplices.size(), fine.surface.simplices.size());
            EXPECT_GT(mixed.surface.simplices.size(), coarse.surface.simplices.size());
        }
    }
}

/// Corners on a line and at one place, as rounding leaves them, wherever the surface is; thin
/// triangles are none of these.
TEST(Report, CountsTrianglesOnALine) {
    std::mt19937 random(5);
    for (const double distance : {0.0, 1.0, 1e6}) {
        for (const double size : {1.0, 1e-3}) {
            std::size_t sound = 0;
            std::size_t on_a_line = 0;
            std::size_t at_one_place = 0;
            for (int i = 0; i < 1000; ++i) {
                const auto anywhere = [&] {
                    return Point{nestgrid_test::uniform(random), nestgrid_test::uniform(random),
                                 nestgrid_test::uniform(random)};
                };
                const Point a = distance * Point{0.3, 0.7, 0.1} + anywhere();
                const Point along = size * (anywhere() - Point{0.5, 0.5, 0.5});
                const double s = nestgrid_test::uniform(random);
                const double height = 1e-15 * std::max(distance, 1.0) * 20;
                Point across = cross(along, anywhere());
                across = (height / norm(across)) * across;
                const auto count = [&](const Point& c) {
                    Surface<3> surface;
                    surface.vertices = {a, a + along, c};
                    surface.simplices = {{0, 1, 2}};
                    return surface_report(surface).degenerate_triangles;
                };
                on_a_line += count(a + s * along);
                at_one_place += count(a);
                sound += count(a + s * along + across);
            }
            EXPECT_EQ(on_a_line, 1000U) << distance << ' ' << size;
            EXPECT_EQ(at_one_place, 1000U) << distance << ' ' << size;
            EXPECT_EQ(sound, 0U) << distance << ' ' << size;
        }
    }
}

}  // namespace surface_uses_test
