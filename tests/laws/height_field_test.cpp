// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangulations of adaptive two-dimensional grids: conforming, covering the domain, with the
// projected values, and within their error bound, on every family.
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/height_field.hpp>
#include <walk/project.hpp>

#include "families.hpp"
#include "same_surface.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace height_field_test {

constexpr std::array<double, 6> shading_thresholds{0, 0.05, 0.1, 0.3, 0.6, 1};

bool is_planar(const Surface<3>& s) {
    return std::ranges::all_of(s.vertices, [](const Point& x) { return x[2] == 0; });
}

std::vector<NodalSamples> smooth_noisy_and_rounded(const std::vector<Point>& nodes) {
    std::mt19937 random(3);
    std::vector<NodalSamples> fields(3);
    fields[0].name = "smooth";
    fields[1].name = "noise";
    fields[2].name = "plateaus of 8 bits";
    for (const Point& x : nodes) {
        const double wave = std::sin(5 * x[0] + 1) * std::cos(4 * x[1]) + x[2];
        fields[0].values.push_back(wave);
        fields[1].values.push_back(uniform(random) - 0.5);
        fields[2].values.push_back(std::floor(std::max(0.0, wave) * 255 / 32) / 8);
    }
    return fields;
}

/// Calls test(grid) for the two-dimensional grids of a family, refined at a circle and at random.
template <class Family, class Test>
void for_each_refined(Test&& test) {
    if constexpr (Family::Grid::dimension == 2) {
        for (auto& grid : Family::grids()) {
            SCOPED_TRACE("refined at a circle");
            refine_at_sphere(grid, 4 * Family::steps);
            test(grid);
        }
        std::mt19937 random(11);
        for (auto& grid : Family::grids()) {
            SCOPED_TRACE("refined at random");
            refine_at_random(grid, random, 7, 5 * Family::steps, 4, 500);
            test(grid);
        }
    }
}

/// How often each edge is used from its lesser to its greater vertex, and the other way.
using Uses = std::map<std::array<std::uint32_t, 2>, std::array<int, 2>>;

Uses uses_of_edges(const Surface<3>& s) {
    Uses uses;
    for (const auto& t : s.simplices) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [a, b] = std::pair(t[i], t[(i + 1) % 3]);
            ++uses[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
        }
    }
    return uses;
}

/// \param oriented whether the coarse elements are turned the same way
void expect_conforming(const Surface<3>& s, bool oriented) {
    Uses uses = uses_of_edges(s);
    for (const auto& [a, b] : s.boundary) {
        auto& [up, down] = uses[{std::min(a, b), std::max(a, b)}];
        EXPECT_EQ(up + down, 1);
        EXPECT_EQ(a < b ? up : down, 1);
        ++(a < b ? down : up);
    }
    std::size_t wrong = 0;
    for (const auto& [edge, use] : uses) {
        wrong += use[0] + use[1] != 2 || (oriented && use[0] != 1) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0U);
}

/// No vertex lies strictly inside an edge.
void expect_no_vertex_on_edges(const Surface<3>& s) {
    std::size_t inside = 0;
    for (const auto& [edge, use] : uses_of_edges(s)) {
        const Point& a = s.vertices[edge[0]];
        const Point along = s.vertices[edge[1]] - a;
        const double length = dot(along, along);
        for (const Point& x : s.vertices) {
            const double t = dot(x - a, along);
            if (!(t > 1e-9 * length && t < (1 - 1e-9) * length)) continue;
            inside += norm(x - a - (t / length) * along) < 1e-9 * std::sqrt(length) ? 1 : 0;
        }
    }
    EXPECT_EQ(inside, 0U);
}

Point area_vector(const Surface<3>& s, const Surface<3>::Simplex& t) {
    const Point& x = s.vertices[t[0]];
    return 0.5 * cross(s.vertices[t[1]] - x, s.vertices[t[2]] - x);
}

/// The triangles cover the unit square, or the octahedron, and none has a height of 0.
void expect_covering(const Surface<3>& s) {
    const bool planar = is_planar(s);
    double sum = 0;
    std::size_t flat = 0;
    for (const auto& t : s.simplices) {
        const Point area = area_vector(s, t);
        sum += planar ? area[2] : norm(area);
        double longest = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            longest = std::max(longest, norm(s.vertices[t[i]] - s.vertices[t[(i + 1) % 3]]));
        }
        flat += norm(area) < 1e-6 * longest * longest ? 1 : 0;
    }
    EXPECT_EQ(flat, 0U);
    EXPECT_NEAR(sum, planar ? 1 : 4 * std::sqrt(3.0), 1e-12);
    double boundary = 0;
    for (const auto& [a, b] : s.boundary) {
        const Point& x = s.vertices[a];
        const Point& y = s.vertices[b];
        boundary += norm(x - y);
        const bool on_side = (x[0] == y[0] && (x[0] == 0 || x[0] == 1)) ||
                             (x[1] == y[1] && (x[1] == 0 || x[1] == 1));
        EXPECT_TRUE(on_side);
    }
    EXPECT_NEAR(boundary, planar ? 4 : 0, 1e-12);
}

/// Vertices are the corners of extracted elements, with the projected values, to the last bit.
template <class Grid, class Field>
void expect_projected(const Grid& grid, const Field& field, const Criterion& criterion,
                      const HierarchicalIndicator& indicator, const Surface<3>& s) {
    std::map<Point, std::vector<double>> at;
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.positions = true}, indicator.hanging());
    std::size_t differ = 0;
    engine::project(walk, criterion, [&](const engine::ElementView<double>& view) {
        std::array<Point, max_corners> x;
        walk.corners(view, nullptr, x.data());
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            const double* const from = view.value + k * walk.components();
            const std::vector<double> values(from, from + walk.components());
            differ += at.emplace(x[k], values).first->second != values ? 1 : 0;
        }
    });
    EXPECT_EQ(at.size(), s.vertices.size());
    for (std::size_t v = 0; v < s.vertices.size(); ++v) {
        const auto found = at.find(s.vertices[v]);
        if (found == at.end() || found->second[0] != s.attributes[v * walk.components()]) ++differ;
    }
    EXPECT_EQ(differ, 0U);
}

template <class Family>
class HeightField : public testing::Test {};
TYPED_TEST_SUITE(HeightField, Families);

TYPED_TEST(HeightField, ConformsAndCoversTheDomainAtEveryThreshold) {
    for_each_refined<TypeParam>([](const auto& grid) {
        for (const NodalSamples& samples : smooth_noisy_and_rounded(grid.node_positions())) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : shading_thresholds) {
                SCOPED_TRACE(samples.name + " at threshold " + std::to_string(threshold));
                const Threshold criterion(&indicator, threshold);
                const Surface<3> s = shading(grid, field, under(criterion, indicator)).surface;
                expect_conforming(s, is_planar(s));
                expect_no_vertex_on_edges(s);
                expect_covering(s);
                expect_projected(grid, field, criterion, indicator, s);
                ASSERT_EQ(s.element_of.size(), s.simplices.size());
                ASSERT_EQ(s.elements.size(), s.level_of.size());
                ASSERT_EQ(s.elements.size(), s.shape_of.size());
                EXPECT_EQ(s.element_of.back() + 1, s.elements.size());
                const ShadingOptions flat{.flatness = 0.01};
                const Surface<3> centred =
                    shading(grid, field, under(indicator, threshold), flat).surface;
                expect_conforming(centred, is_planar(s));
                expect_covering(centred);
            }
        }
    });
}

/// The graph conforms like the plane, and lies above it: the shadow of each triangle is no less
/// than the triangle of the plane, whose diagonals may be others.
TYPED_TEST(HeightField, LiftsTheSameVertices) {
    for_each_refined<TypeParam>([](const auto& grid) {
        const auto samples = smooth_noisy_and_rounded(grid.node_positions())[0];
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        const auto plane = shading(grid, field, under(indicator, 0.1));
        auto graph = height_field(grid, field, 2.5, under(indicator, 0.1));
        expect_conforming(graph.surface, is_planar(plane.surface));
        expect_same_bits(graph.surface.attributes, plane.surface.attributes, "attributes");
        ASSERT_EQ(graph.surface.vertices.size(), plane.surface.vertices.size());
        std::size_t differ = 0;
        for (std::size_t v = 0; v < plane.surface.vertices.size(); ++v) {
            Point x = plane.surface.vertices[v];
            x[2] += 2.5 * plane.surface.attributes[v];
            differ += x != graph.surface.vertices[v] ? 1 : 0;
            graph.surface.vertices[v] = plane.surface.vertices[v];
        }
        EXPECT_EQ(differ, 0U);
        expect_covering(graph.surface);
    });
}

TYPED_TEST(HeightField, DrawsALinearFunctionExactly) {
    for_each_refined<TypeParam>([](const auto& grid) {
        const auto f = [](const Point& x) { return 2 * x[0] - 3 * x[1] + x[2] + 0.125; };
        const std::vector<double> values = sample_nodes(grid, f);
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : {-1.0, 1e-9, 0.3}) {
            const Threshold criterion(&indicator, threshold);
            const auto plane = shading(grid, field, under(criterion, indicator));
            const auto graph = height_field(grid, field, 4, under(criterion, indicator));
            EXPECT_LT(plane.error_bound, 1e-12);
            for (std::size_t v = 0; v < plane.surface.vertices.size(); ++v) {
                const Point& x = plane.surface.vertices[v];
                EXPECT_NEAR(plane.surface.attributes[v], f(x), 1e-12);
                EXPECT_NEAR(graph.surface.vertices[v][2], x[2] + 4 * f(x), 1e-12);
            }
        }
    });
}

/// The value of a plane triangulation at a point.
double value_at(const Surface<3>& s, const Point& x) {
    double best = -1;
    double value = 0;
    for (const auto& t : s.simplices) {
        const double whole = area_vector(s, t)[2];
        std::array<double, 3> weight;
        for (std::size_t i = 0; i < 3; ++i) {
            const Point& a = s.vertices[t[(i + 1) % 3]];
            weight[i] = 0.5 * cross(a - x, s.vertices[t[(i + 2) % 3]] - x)[2] / whole;
        }
        const double least = std::ranges::min(weight);
        if (least <= best) continue;
        best = least;
        value = 0;
        for (std::size_t i = 0; i < 3; ++i) value += weight[i] * s.attributes[t[i]];
    }
    return value;
}

/// Points of the leaves with the data there, interpolated on the finest grid.
template <class Grid, class Field>
std::vector<std::pair<Point, double>> points_of_leaves(const Grid& grid, const Field& field,
                                                       const HierarchicalIndicator& indicator) {
    std::vector<std::pair<Point, double>> points;
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.positions = true}, indicator.hanging());
    engine::project(walk, Exact{}, [&](const engine::ElementView<double>& view) {
        std::array<Point, max_corners> x;
        walk.corners(view, nullptr, x.data());
        for (const auto& [a, b] : {std::array{0.5, 0.5}, {0.25, 0.25}, {0.7, 0.2}, {0.1, 0.9}}) {
            std::array<double, 4> weight{(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b};
            if (view.shape == Shape::triangle) weight = {1 - a / 2 - b / 2, a / 2, b / 2, 0};
            std::pair<Point, double> point{{0, 0, 0}, 0};
            for (std::size_t k = 0; k < view.corner_count(); ++k) {
                point.first = point.first + weight[k] * x[k];
                point.second += weight[k] * view.value[k];
            }
            points.push_back(point);
        }
    });
    return points;
}

TYPED_TEST(HeightField, StaysWithinItsErrorBound) {
    for_each_refined<TypeParam>([](const auto& grid) {
        for (const NodalSamples& samples : smooth_noisy_and_rounded(grid.node_positions())) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            const auto points = points_of_leaves(grid, field, indicator);
            for (const double threshold : {0.0, 0.1, 0.3}) {
                for (const double flatness : {std::numeric_limits<double>::infinity(), 0.01}) {
                    const auto plane =
                        shading(grid, field, under(indicator, threshold), {.flatness = flatness});
                    if (!is_planar(plane.surface)) return;
                    double greatest = 0;
                    for (const auto& [x, u] : points) {
                        greatest = std::max(greatest, std::abs(value_at(plane.surface, x) - u));
                    }
                    EXPECT_LE(greatest, plane.error_bound + 1e-12) << samples.name;
                }
            }
        }
    });
}

void expect_same(const Shading& a, const Shading& b) {
    nestgrid_test::expect_same(a.surface, b.surface);
    nestgrid_test::expect_same(a.counts, b.counts);
    EXPECT_EQ(a.error_bound, b.error_bound);
    EXPECT_EQ(a.edge_nodes, b.edge_nodes);
}

TYPED_TEST(HeightField, HasTheSameBitsFromAnyNumberOfThreads) {
    for_each_refined<TypeParam>([](const auto& grid) {
        const auto samples = smooth_noisy_and_rounded(grid.node_positions())[1];
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
        for (const double threshold : {0.0, 0.3}) {
            const ShadingOptions options{.flatness = 0.1};
            const auto alone = height_field(grid, field, 0.5, {.threshold = threshold}, options);
            for (const std::size_t threads : {2U, 3U}) {
                expect_same(alone, height_field(grid, field, 0.5, {.threshold = threshold}, options,
                                                {ThreadExecutor(threads)}));
            }
        }
    });
}

/// Triangles as what they show: corners with their values, beginning with the least one.
std::vector<std::array<std::array<double, 4>, 3>> shown(const Surface<3>& s) {
    std::vector<std::array<std::array<double, 4>, 3>> all;
    for (const auto& t : s.simplices) {
        auto& corners = all.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            const Point& x = s.vertices[t[i]];
            corners[i] = {x[0], x[1], x[2], s.attributes[t[i]]};
        }
        std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    }
    std::ranges::sort(all);
    return all;
}

/// Turns quadrilaterals by quarters, each by another one.
CoarseGrid turned(CoarseGrid coarse) {
    for (std::size_t e = 0; e < coarse.element_count(); ++e) {
        const auto of = coarse.element(e);
        for (std::size_t quarter = e % 4; of.size() == 4 && quarter > 0; --quarter) {
            const std::array<std::uint32_t, 4> before{of[0], of[1], of[2], of[3]};
            for (std::size_t k = 0; k < 4; ++k) of[k] = before[std::array{1, 3, 0, 2}[k]];
        }
    }
    return coarse;
}

template <class Grid>
void expect_same_when_renumbered(const CoarseGrid& coarse) {
    const auto draw = [](Grid&& grid) {
        refine_at_sphere(grid, 4);
        // Positions by node number differ in the last bits; rounded values do not.
        const auto f = [](const Point& x) {
            return std::round(0x1p20 * std::sin(5 * x[0] + 1) * std::cos(4 * x[1])) * 0x1p-20;
        };
        const std::vector<double> values = sample_nodes(grid, f);
        const NodeField<Grid, double> field(grid, values);
        return shown(height_field(grid, field, 0.5, {.threshold = 0.1}).surface);
    };
    const auto expected = draw(Grid(coarse));
    for (const unsigned seed : {1U, 2U, 3U}) {
        EXPECT_TRUE(draw(Grid(turned(shaken(coarse, seed, 0)))) == expected);
    }
}

TEST(HeightFields, DependOnNoNumbers) {
    expect_same_when_renumbered<RedGreenSimplices<2>>(shaken(triangles(3), 9, 0.05));
    expect_same_when_renumbered<RedGreenGrid<2>>(triangles(3, true));
    expect_same_when_renumbered<OctreeGrid<2>>(quadrilaterals(3));
    expect_same_when_renumbered<OctreeGrid<2>>(shaken(quadrilaterals(3), 9, 0.05));
}

/// A parallelogram whose shorter diagonal in the plane is the longer one of the graph.
TEST(HeightFields, ChooseDiagonalsAfterLifting) {
    CoarseGrid coarse;
    coarse.dimension = 2;
    coarse.nodes = Coordinates({{0, 0, 0}, {1, 0, 0}, {-0.2, 1, 0}, {0.8, 1, 0}});
    coarse.add(Shape::quadrilateral, {0, 1, 2, 3});
    const OctreeGrid<2> grid(coarse);
    const std::vector<double> values{0, 1, 1, 2};
    const NodeField<OctreeGrid<2>, double> field(grid, values);
    const auto is_cut = [](const Surface<3>& s, double from, double to) {
        for (const auto& [edge, use] : uses_of_edges(s)) {
            const auto [low, high] = std::minmax(s.attributes[edge[0]], s.attributes[edge[1]]);
            if (low == from && high == to) return true;
        }
        return false;
    };
    EXPECT_TRUE(is_cut(shading(grid, field).surface, 0, 2));
    EXPECT_TRUE(is_cut(height_field(grid, field, 1).surface, 1, 1));
    EXPECT_FALSE(is_cut(height_field(grid, field, 1).surface, 0, 2));
}

/// An octahedron whose triangles are all turned outwards stays closed and oriented, when it is
/// deformed, too.
TEST(HeightFields, KeepAShellClosed) {
    CoarseGrid shell = octahedron();
    for (std::size_t e = 0; e < shell.element_count(); ++e) {
        const auto of = shell.element(e);
        const Point x = shell.nodes[of[0]];
        const Point n = cross(shell.nodes[of[1]] - x, shell.nodes[of[2]] - x);
        if (dot(n, x) < 0) std::swap(of[0], of[1]);
    }
    RedGreenSimplices<2> grid(shell);
    std::mt19937 random(5);
    refine_at_random(grid, random, 6, 6, 3, 800);
    for (const NodalSamples& samples : smooth_noisy_and_rounded(grid.node_positions())) {
        const NodeField<RedGreenSimplices<2>, double> field(grid, samples.values);
        for (const double threshold : shading_thresholds) {
            const auto s = shading(grid, field, {.threshold = threshold}).surface;
            expect_conforming(s, true);
            expect_covering(s);
            EXPECT_TRUE(s.boundary.empty());
        }
    }
}

/// Two components of one field.
template <class Grid>
class TwoFields {
public:
    using value_type = float;
    static constexpr int components = 2;
    TwoFields(const NodeField<Grid, float>& a, const NodeField<Grid, float>& b) : field_{&a, &b} {}

    NodeMask coarse_values(std::size_t i, std::span<float> out) const {
        return put(out, [&](auto& field, auto to) { field.coarse_values(i, to); });
    }
    NodeMask new_values(const ElementOf<Grid>& e, NodeMask which, std::span<float> out,
                        Context<Grid>& context) const {
        return put(out, [&](auto& field, auto to) { field.new_values(e, which, to, context); });
    }

private:
    template <class Fill>
    NodeMask put(std::span<float> out, Fill&& fill) const {
        std::vector<float> values(out.size() / 2);
        for (std::size_t c = 0; c < 2; ++c) {
            fill(*field_[c], std::span(values));
            for (std::size_t n = 0; n < values.size(); ++n) out[2 * n + c] = values[n];
        }
        return 0;
    }
    std::array<const NodeField<Grid, float>*, 2> field_;
};

TEST(HeightFields, CarryAllComponents) {
    OctreeGrid<2> grid(quadrilaterals(2), {.balanced = false});
    refine_at_sphere(grid, 4);
    std::vector<float> x, y;
    for (const Point& at : grid.node_positions()) {
        x.push_back(static_cast<float>(at[0] * at[0]));
        y.push_back(static_cast<float>(at[1]));
    }
    const NodeField<OctreeGrid<2>, float> of_x(grid, x), of_y(grid, y);
    const auto result =
        height_field(grid, TwoFields<OctreeGrid<2>>(of_x, of_y), 1.0, {.threshold = 0.02});
    const Surface<3>& s = result.surface;
    ASSERT_EQ(s.attributes.size(), 2 * s.vertices.size());
    for (std::size_t v = 0; v < s.vertices.size(); ++v) {
        EXPECT_EQ(s.vertices[v][2], s.attributes[2 * v]);
        EXPECT_NEAR(s.attributes[2 * v], s.vertices[v][0] * s.vertices[v][0], result.error_bound);
        EXPECT_NEAR(s.attributes[2 * v + 1], s.vertices[v][1], 1e-6);
    }
    EXPECT_GT(result.edge_nodes, 0U);
}

TEST(HeightFields, RefuseWrongInput) {
    OctreeGrid<2> grid(quadrilaterals(2));
    const std::vector<double> values(9, 0.0);
    const NodeField<OctreeGrid<2>, double> field(grid, values);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(shading(grid, field, {.threshold = -1}), InvalidInput);
    EXPECT_THROW(shading(grid, field, {.threshold = nan}), InvalidInput);
    EXPECT_THROW(shading(grid, field, {}, {.flatness = -1}), InvalidInput);
    EXPECT_THROW(height_field(grid, field, nan), InvalidInput);
    OctreeGrid<3> volume(hexahedra(1));
    const NodeField<OctreeGrid<3>, double> in_volume(volume, std::span(values).first(8));
    EXPECT_THROW(shading(volume, in_volume), InvalidInput);
    const HierarchicalIndicator indicator(grid, field);
    const Unsaturated criterion(Exact{});
    const Shading insisted = shading(grid, field, under(criterion, indicator));
    EXPECT_EQ(insisted.error_bound, insisted.range_bound);
    grid.adapt([](const Leaf&) { return Mark::refine; });
    EXPECT_THROW(shading(grid, field, under(indicator, 0)), GridError);
}

}  // namespace height_field_test
