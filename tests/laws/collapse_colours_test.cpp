// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices, boundaries, shadings and height fields whose colours are collapsed keep them within the
// error on all of their triangles, and keep every point, outline and crease. Judged by dense
// samples and at all points where edges of leaves meet the surface.
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/height_field.hpp>

#include "closedness.hpp"
#include "colour_misses.hpp"
#include "families.hpp"
#include "five_at_nodes.hpp"
#include "is_affine.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace collapse_colours_test {

constexpr double rounding = 1e-9;

/// \param flat what is drawn, without a lift
/// \param drawn the same before the collapse
/// \param finest the same of all data
template <class Real>
void expect_colours_kept(const Surface<3>& flat, const Surface<3>& drawn, const Surface<3>& finest,
                         const Hierarchy<Real>& h, const std::vector<double>& errors,
                         const Collapsed& result) {
    Misses misses(flat, errors);
    misses.look_all_over(h);
    std::size_t missed = 0;
    for (std::size_t v = 0; v < finest.vertices.size(); ++v) {
        const Point& p = finest.vertices[v];
        std::size_t found = 0;
        for (std::size_t t = 0; t < flat.simplices.size(); ++t) {
            const auto x = corners_of(flat, t);
            const Point w = weights_of(x, p);
            if (!(std::min({w[0], w[1], w[2]}) >= -1e-9)) continue;
            if (norm(w[0] * x[0] + w[1] * x[1] + w[2] * x[2] - p) > rounding) continue;
            ++found;
            misses.add(t, w, &finest.attributes[v * errors.size()]);
        }
        missed += found == 0 ? 1 : 0;
    }
    EXPECT_EQ(missed, 0U) << "nodes that the surface has lost";
    EXPECT_EQ(misses.exceeding_beside(drawn), 0U);
    EXPECT_LE(result.error, errors[0] * (1 + rounding));
}

double distance_from_segment(const Point& p, const Point& a, const Point& b) {
    const double length = dot(b - a, b - a);
    const double t = length > 0 ? std::clamp(dot(p - a, b - a) / length, 0.0, 1.0) : 0;
    return norm(p - a - t * (b - a));
}

/// Every end of an edge on the boundary of one surface lies on one of the other.
void expect_outline_on(const Surface<3>& s, const Surface<3>& other) {
    for (const auto& edge : s.boundary) {
        for (const std::uint32_t v : edge) {
            double least = HUGE_VAL;
            for (const auto& [a, b] : other.boundary) {
                least = std::min(least, distance_from_segment(s.vertices[v], other.vertices[a],
                                                              other.vertices[b]));
            }
            EXPECT_LE(least, rounding);
        }
    }
}

/// The area by plane, with the side that triangles show: where these stay, none is turned over and
/// none leaves its face.
std::map<std::array<long, 4>, double> areas_by_plane(const Surface<3>& s) {
    std::map<std::array<long, 4>, double> areas;
    for (std::size_t t = 0; t < s.simplices.size(); ++t) {
        const auto [a, b, c] = corners_of(s, t);
        const Point twice = cross(b - a, c - a);
        const double area = norm(twice);
        if (area < 1e-12) continue;
        const Point n = (1 / area) * twice;
        const auto round = [](double x) { return std::lround(1e4 * x + 0.123); };
        areas[{round(n[0]), round(n[1]), round(n[2]), round(dot(n, a))}] += area / 2;
    }
    return areas;
}

void expect_same_support(const Surface<3>& flat, const Surface<3>& drawn) {
    const auto now = areas_by_plane(flat);
    const auto before = areas_by_plane(drawn);
    ASSERT_EQ(now.size(), before.size());
    auto old = before.begin();
    for (const auto& [plane, area] : now) {
        EXPECT_EQ(plane, old->first);
        EXPECT_NEAR(area, old->second, 1e-9);
        ++old;
    }
    expect_outline_on(flat, drawn);
    expect_outline_on(drawn, flat);
    const auto length = [](const Surface<3>& s) {
        return std::accumulate(s.boundary.begin(), s.boundary.end(), 0.0,
                               [&](double sum, const auto& edge) {
                                   return sum + norm(s.vertices[edge[1]] - s.vertices[edge[0]]);
                               });
    };
    EXPECT_NEAR(length(flat), length(drawn), 1e-9);
    const SurfaceReport is = surface_report(flat);
    const SurfaceReport was = surface_report(drawn);
    EXPECT_EQ(is.euler, was.euler);
    EXPECT_EQ(is.components, was.components);
    EXPECT_EQ(is.open_edges, was.open_edges);
}

/// How many triangles there were, and how many are left.
struct Counts {
    std::size_t before = 0;
    std::size_t after = 0;
};

template <class Real>
void expect_laws(const Surface<3>& drawn, const Surface<3>& finest, const Hierarchy<Real>& h,
                 const Bounds& bounds, double error, Counts& counts) {
    Surface<3> surface = drawn;
    const Collapsed result = collapse_colours(surface, h, bounds, {.errors = {error}});
    const auto components = static_cast<std::size_t>(h.facts().components);
    expect_same_support(surface, drawn);
    expect_colours_kept(surface, drawn, finest, h, std::vector<double>(components, error), result);
    EXPECT_EQ(surface.simplices.size() == drawn.simplices.size(), result.collapses == 0);
    counts.before += drawn.simplices.size();
    counts.after += surface.simplices.size();
}

template <class Family>
class CollapsedColours : public testing::Test {};
TYPED_TEST_SUITE(CollapsedColours, Families);

const std::vector<Plane> planes{
    {{0.4, 0.5, 0.49}, {0.3, 0.5, 0.81}}, {{0, 0, 0.37}, {0, 0, 1}}, {{0.5, 0, 0}, {1, 0, 0}}};

TYPED_TEST(CollapsedColours, KeepErrorsAndPlaceOnSlicesAndBoundaries) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        Counts counts;
        for_each_field_at_sphere<TypeParam>(2, 8, [&](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h, NodeError::deviation);
            const double error = 0.1 * (indicator.greatest() - indicator.least()) + 1e-9;
            for (const Plane& plane : planes) {
                const Surface<3> drawn = slice(h, plane, under(indicator, error / 2)).surface;
                const Surface<3> finest = slice(h, plane).surface;
                expect_laws(drawn, finest, h, indicator, error, counts);
            }
            const Threshold half(&indicator, error / 2);
            const Surface<3> drawn = boundary_surface(h, under(half, indicator)).surface;
            expect_laws(drawn, boundary_surface(h).surface, h, indicator, error, counts);
        });
        EXPECT_LT(10 * counts.after, 9 * counts.before);
    }
}

TYPED_TEST(CollapsedColours, KeepErrorsAndPlaceOnShadings) {
    if constexpr (TypeParam::Grid::dimension == 2) {
        Counts counts;
        for_each_field_at_sphere<TypeParam>(4, 8, [&](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h, NodeError::deviation);
            const double error = 0.1 * (indicator.greatest() - indicator.least()) + 1e-9;
            const Surface<3> drawn = shading(h, under(indicator, error / 2)).surface;
            const Surface<3> finest = shading(h).surface;
            expect_laws(drawn, finest, h, indicator, error, counts);
        });
        EXPECT_LT(10 * counts.after, 9 * counts.before);
    }
}

TYPED_TEST(CollapsedColours, LeaveAGraphOfTheSameHeights) {
    if constexpr (TypeParam::Grid::dimension == 2) {
        for_each_field_at_sphere<TypeParam>(4, 8, [&](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h, NodeError::deviation);
            const double error = 0.1 * (indicator.greatest() - indicator.least()) + 1e-9;
            constexpr double scale = 2.5;
            const Surface<3> drawn = height_field(h, scale, under(indicator, error / 2)).surface;
            const auto flattened = [&](Surface<3> s) {
                for (std::size_t v = 0; v < s.vertices.size(); ++v) {
                    s.vertices[v][2] -= scale * s.attributes[v];
                }
                return s;
            };
            Surface<3> surface = drawn;
            const Collapsed result =
                collapse_colours(surface, h, indicator, {.errors = {error}, .scale = scale});
            expect_same_support(flattened(surface), flattened(drawn));
            expect_colours_kept(flattened(surface), flattened(drawn), shading(h).surface, h,
                                {error}, result);
            EXPECT_EQ(surface.simplices.size() == drawn.simplices.size(), result.collapses == 0);
        });
    }
}

/// A field that is linear needs no triangles but those of the outline and the creases.
TYPED_TEST(CollapsedColours, OfLinearDataNeedFewTriangles) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        const auto values =
            sample_nodes(grid, [](const Point& x) { return 2 * x[0] - 3 * x[1] + x[2] + 0.125; });
        const NodeField<typename TypeParam::Grid, double> field(grid, values);
        const auto h = erase(grid, field);
        const HierarchicalIndicator indicator(h);
        const auto left = [&](Surface<3> s) {
            const Surface<3> drawn = s;
            const Collapsed result = collapse_colours(s, h, indicator, {.errors = {1e-6}});
            EXPECT_LE(result.error, 1e-6);
            expect_same_support(s, drawn);
            return s.simplices.size();
        };
        if constexpr (TypeParam::Grid::dimension == 3) {
            const std::size_t of_slice = left(slice(h, planes[1]).surface);
            const std::size_t of_boundary = left(boundary_surface(h).surface);
            if (!is_affine(grid)) continue;
            EXPECT_LE(of_slice, 8U);
            EXPECT_LE(of_boundary, 24U);
        } else {
            EXPECT_LE(left(shading(h).surface), 40U);
        }
    }
}

/// Each component keeps an error of its own.
TEST(CollapsedColours, KeepAnErrorForEachComponent) {
    auto grid = BisectionTetrahedra::grids()[0];
    refine_at_sphere(grid, 2 * BisectionTetrahedra::steps);
    const auto centre = [](const Point& x) { return norm(x - Point{0.4, 0.5, 0.6}); };
    std::vector<std::array<double, 5>> values;
    for (const Point& x : grid.node_positions()) {
        values.push_back({x[0], std::sin(7 * x[1]), 1000 * x[1] * x[2], 1, centre(x)});
    }
    const FiveAtNodes field(grid, std::move(values));
    const auto h = erase(grid, field);
    const HierarchicalIndicator indicator(h);
    const Surface<3> drawn = slice(h, planes[0]).surface;
    const std::vector<double> errors{0.1, 0.2, 80, 0.01, 0.03};
    Surface<3> surface = drawn;
    const Collapsed result = collapse_colours(surface, h, indicator, {.errors = errors});
    EXPECT_EQ(result.exceeding, 0U);
    EXPECT_LT(3 * surface.simplices.size(), drawn.simplices.size());
    expect_same_support(surface, drawn);
    expect_colours_kept(surface, drawn, drawn, h, errors, result);
}

/// Two sheets in one plane, back to back along their rim, keep it.
TEST(CollapsedColours, KeepTheRimOfAFlatPillow) {
    const LatticeBisection<3> grid({.samples = {5, 5, 5}});
    const std::vector<float> values(125, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    Surface<3> pillow;
    std::array<std::array<std::array<std::uint32_t, 5>, 5>, 2> vertex{};
    for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t i = 0; i < 5; ++i) {
            for (std::size_t j = 0; j < 5; ++j) {
                const bool on_rim = i % 4 == 0 || j % 4 == 0;
                vertex[side][i][j] = side == 1 && on_rim
                                         ? vertex[0][i][j]
                                         : static_cast<std::uint32_t>(pillow.vertices.size());
                if (side == 1 && on_rim) continue;
                pillow.vertices.push_back({static_cast<double>(i), static_cast<double>(j), 1.5});
            }
        }
    }
    for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                const auto& v = vertex[side];
                std::array<Surface<3>::Simplex, 2> both{{{v[i][j], v[i + 1][j], v[i + 1][j + 1]},
                                                         {v[i][j], v[i + 1][j + 1], v[i][j + 1]}}};
                for (auto& t : both) {
                    if (side == 1) std::swap(t[1], t[2]);
                    pillow.simplices.push_back(t);
                }
            }
        }
    }
    pillow.attributes.assign(pillow.vertices.size(), 1);
    const Surface<3> drawn = pillow;
    collapse_colours(pillow, erase(grid, field), indicator, {.errors = {0.1}});
    EXPECT_LE(pillow.simplices.size(), 16U);
    expect_same_support(pillow, drawn);
}

TEST(CollapsedColours, AreTheSameWithAnyNumberOfThreads) {
    const Samples n{129, 129, 3};  // more than one block
    const LatticeOctree<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[1];
    const LatticeField field(grid, std::span<const float>(data.values));
    const auto h = erase(grid, field);
    const HierarchicalIndicator indicator(h, NodeError::deviation);
    const Surface<3> drawn = slice(h, Plane({0, 0, 1}, {0, 0, 1}), under(indicator, 0)).surface;
    EXPECT_GT(drawn.vertices.size(), 1U << 14U);
    const ColourCollapseOptions options{.errors = {0.02 * data.range}};
    Surface<3> one = drawn;
    collapse_colours(one, h, indicator, options);
    EXPECT_LT(one.simplices.size(), drawn.simplices.size() / 2);
    for (const std::size_t threads : {2U, 3U}) {
        Surface<3> many = drawn;
        collapse_colours(many, h, indicator, options, ThreadExecutor(threads));
        expect_same_bits(many.vertices, one.vertices, "vertices");
        expect_same_bits(many.attributes, one.attributes, "attributes");
        expect_same_bits(many.simplices, one.simplices, "simplices");
    }
}

TEST(CollapsedColours, RefuseOptionsOutOfRange) {
    const LatticeBisection<3> grid({.samples = {3, 3, 3}});
    const std::vector<float> values(27, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    const Surface<3> drawn = boundary_surface(grid, field).surface;
    const auto refuse = [&](Surface<3> s, const ColourCollapseOptions& options, const char* why) {
        expect_refused([&] { collapse_colours(s, erase(grid, field), indicator, options); }, why);
    };
    refuse(drawn, {}, "no error to keep");
    refuse(drawn, {.errors = {0}}, "not a positive number");
    refuse(drawn, {.errors = {HUGE_VAL}}, "not a positive number");
    refuse(drawn, {.errors = {1, 1}}, "errors are given for 2");
    refuse(drawn, {.errors = {1}, .scale = HUGE_VAL}, "the scale");
    refuse(drawn, {.errors = {1}, .shape = 1}, "quality");
    Surface<3> plain = drawn;
    plain.attributes.clear();
    refuse(plain, {.errors = {1}}, "no attributes");
    Surface<3> richer = drawn;
    richer.attributes.insert(richer.attributes.end(), drawn.attributes.begin(),
                             drawn.attributes.end());
    refuse(richer, {.errors = {1}}, "the field only 1 component");
    Surface<3> nothing;
    EXPECT_EQ(collapse_colours(nothing, erase(grid, field), indicator, {.errors = {1}}).collapses,
              0U);
}

}  // namespace collapse_colours_test
