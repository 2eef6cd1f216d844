// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isolines on surfaces and on two-dimensional grids: no open end inside the domain, and the same
// segments as triangle by triangle, on every family.
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "families.hpp"
#include "plane_slice.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace isolines_test {

constexpr std::array thresholds{0.0, 0.1, 1.0};
const Point oblique{0.3, 0.5, 0.81};

/// Two numbers at each node.
template <class Grid>
class PairField {
public:
    using value_type = double;
    static constexpr int components = 2;

    PairField(const Grid& grid, const std::vector<double>& a, const std::vector<double>& b)
        : grid_{&grid}, a_{&a}, b_{&b} {}
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        put(grid_->coarse_grid().element(i), out);
        return 0;
    }
    NodeMask new_values(const typename Grid::Element& e, NodeMask, std::span<double> out,
                        typename Grid::Context& context) const {
        put(grid_->new_nodes(e, context), out);
        return 0;
    }

private:
    void put(std::span<const std::uint32_t> nodes, std::span<double> out) const {
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            out[2 * k] = (*a_)[nodes[k]];
            out[2 * k + 1] = (*b_)[nodes[k]];
        }
    }
    const Grid* grid_;
    const std::vector<double>*a_, *b_;
};

using PointPair = std::array<Point, 2>;

/// What isolines() must find, triangle by triangle.
struct TriangleByTriangle {
    std::vector<PointPair> segments;  ///< of positive length
    std::vector<PointPair> boundary;  ///< edges of one triangle only on which the values differ
};

/// An attribute of a surface, and a value of it.
struct Isovalue {
    const Surface<3>* surface;
    std::size_t attribute;
    double value;

    double at(std::uint32_t v) const {
        return surface
            ->attributes[v * surface->attributes.size() / surface->vertices.size() + attribute];
    }
    bool inside(std::uint32_t v) const { return at(v) >= value; }
    Point cut(std::uint32_t a, std::uint32_t b) const {
        if (at(a) > at(b)) return cut(b, a);
        const double s = (value - at(a)) / (at(b) - at(a));
        return (1 - s) * surface->vertices[a] + s * surface->vertices[b];
    }
};

/// Seen from where the normal points to, the higher values lie on the left of a segment.
void expect_higher_on_the_left(const Isovalue& of, const std::array<std::uint32_t, 3>& triangle,
                               const PointPair& segment) {
    const auto& x = of.surface->vertices;
    const auto [a, b, c] = triangle;
    const Point normal = cross(x[b] - x[a], x[c] - x[a]);
    const Point left = cross(normal, segment[1] - segment[0]);
    double sum = 0;
    double size = 0;  // so many roundings of positions are in the sum
    for (const std::uint32_t v : triangle) {
        const Point across = x[v] - segment[0];
        sum += (of.at(v) - of.value) * dot(left, across);
        size += std::abs(of.at(v) - of.value) * (norm(left) + norm(normal) * norm(across));
    }
    EXPECT_GE(sum, -4e-15 * size);
}

TriangleByTriangle triangle_by_triangle(const Isovalue& of) {
    TriangleByTriangle result;
    std::vector<std::array<std::uint32_t, 2>> sides;
    for (const auto& t : of.surface->simplices) {
        PointPair segment;
        bool cut = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i];
            const std::uint32_t b = t[(i + 1) % 3];
            if (of.inside(a) == of.inside(b)) continue;
            cut = true;
            segment[of.inside(a) ? 0 : 1] = of.cut(a, b);
            sides.push_back({std::min(a, b), std::max(a, b)});
        }
        if (!cut || segment[0] == segment[1]) continue;
        expect_higher_on_the_left(of, t, segment);
        result.segments.push_back(segment);
    }
    std::ranges::sort(sides);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const bool twice = (i > 0 && sides[i - 1] == sides[i]) ||
                           (i + 1 < sides.size() && sides[i + 1] == sides[i]);
        if (twice) continue;
        const Point x = of.cut(sides[i][0], sides[i][1]);
        result.boundary.push_back({x, x});
    }
    std::ranges::sort(result.segments);
    return result;
}

std::vector<PointPair> segments_of(const Polylines& lines) {
    std::vector<PointPair> segments;
    for (std::size_t i = 0; i < lines.count(); ++i) {
        const auto line = lines.line(i);
        for (std::size_t k = 1; k < line.size(); ++k) {
            segments.push_back({lines.vertices[line[k - 1]], lines.vertices[line[k]]});
            EXPECT_NE(segments.back()[0], segments.back()[1]);
        }
    }
    std::ranges::sort(segments);
    return segments;
}

std::size_t count_open(const Polylines& lines) {
    std::size_t open = 0;
    for (std::size_t i = 0; i < lines.count(); ++i) open += lines.closed(i) ? 0 : 1;
    return open;
}

/// \param generic no vertex has the value
void expect_isolines(const Isovalue& of, bool generic) {
    const TriangleByTriangle expected = triangle_by_triangle(of);
    const Polylines lines = isolines(*of.surface, of.attribute, std::array{of.value});
    EXPECT_EQ(segments_of(lines), expected.segments);
    const auto on_boundary = [&](std::uint32_t v) {
        const Point& x = lines.vertices[v];
        return std::ranges::count(expected.boundary, PointPair{x, x}) > 0;
    };
    for (std::size_t i = 0; i < lines.count(); ++i) {
        EXPECT_EQ(lines.value[i], of.value);
        EXPECT_GT(lines.length(i), 0);
        if (lines.closed(i)) continue;
        EXPECT_TRUE(on_boundary(lines.line(i).front()));
        EXPECT_TRUE(on_boundary(lines.line(i).back()));
    }
    EXPECT_LE(2 * count_open(lines), expected.boundary.size());
    EXPECT_TRUE(!generic || 2 * count_open(lines) == expected.boundary.size());
    ASSERT_EQ(lines.attributes.size(), lines.vertices.size() * lines.attribute_count);
    for (std::size_t v = 0; v < lines.vertices.size(); ++v) {
        EXPECT_EQ(lines.attributes[v * lines.attribute_count + of.attribute], of.value);
    }
}

void expect_equal(const Polylines& a, const Polylines& b) {
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.attributes, b.attributes);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.first, b.first);
    EXPECT_EQ(a.value, b.value);
}

/// Several values in one pass give what they give one by one.
void expect_in_one_pass(const Surface<3>& surface, std::span<const double> values) {
    std::size_t count = 0;
    const Polylines together = isolines(surface, 0, values);
    std::vector<PointPair> segments;
    for (const double value : values) {
        const Polylines one = isolines(surface, 0, std::span(&value, 1));
        const auto some = segments_of(one);
        segments.insert(segments.end(), some.begin(), some.end());
        for (const double v : one.value) {
            ASSERT_LT(count, together.count());
            EXPECT_EQ(together.value[count++], v);
        }
    }
    EXPECT_EQ(count, together.count());
    std::ranges::sort(segments);
    EXPECT_EQ(segments_of(together), segments);
}

/// Isolines between the vertices, through vertices, and along plateaus. Returns how many segments.
std::size_t expect_isolines_of_attribute(Surface<3> surface) {
    if (surface.vertices.empty()) return 0;
    const std::vector<double> attributes = surface.attributes;
    const auto [low, high] = std::ranges::minmax(attributes);
    const std::array values{0.4321 * low + 0.5679 * high, attributes[attributes.size() / 2], low,
                            high, attributes.front()};
    for (const double value : values) {
        SCOPED_TRACE(value);
        expect_isolines({&surface, 0, value}, std::ranges::count(attributes, value) == 0);
    }
    expect_in_one_pass(surface, values);
    const std::size_t segments =
        segments_of(isolines(surface, 0, std::span(values).first(1))).size();
    for (double& a : surface.attributes) a = std::round(4 * a / (high - low + 1e-9));
    for (const double value : {-1.0, 0.0, 1.0, 2.0}) expect_isolines({&surface, 0, value}, false);
    return segments;
}

template <class Family>
class IsolinesOn : public testing::Test {};
TYPED_TEST_SUITE(IsolinesOn, Families);

TYPED_TEST(IsolinesOn, SlicesEndOnTheBoundaryOnly) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        std::size_t segments = 0;
        for_each_field_at_sphere<TypeParam>(2, 3, [&](const auto& grid, const auto& samples) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : thresholds) {
                segments += expect_isolines_of_attribute(plane_slice(
                    grid, field, oblique, 0.7713, Threshold(&indicator, threshold), indicator));
            }
        });
        EXPECT_GT(segments, 1000U);
    }
}

TYPED_TEST(IsolinesOn, IsosurfacesEndOnTheBoundaryOnly) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        std::size_t segments = 0;
        for_each_field_at_sphere<TypeParam>(2, 5, [&](const auto& grid, const auto& samples) {
            const auto sphere = sample_nodes(grid, [](const Point& x) {
                return 0.47 - norm(x - Point{0.4, 0.5, 0.6});
            });
            const PairField pair(grid, sphere, samples.values);
            const PairField swapped(grid, samples.values, sphere);
            for (const double threshold : thresholds) {
                for (const auto& field : {pair, swapped}) {
                    segments += expect_isolines_of_attribute(
                        isosurface(grid, field, 0.0, {.threshold = threshold}).surface);
                }
            }
        });
        EXPECT_GT(segments, 1000U);
    }
}

/// The part of the line {x: dot(a, x) = s, dot(b, x) = t} in the unit cube.
double chord(const Point& a, double s, const Point& b, double t) {
    const Point along = (1 / norm(cross(a, b))) * cross(a, b);
    const Point at = (1 / dot(cross(a, b), cross(a, b))) *
                     (s * cross(b, cross(a, b)) - t * cross(a, cross(a, b)));
    double first = -10;
    double last = 10;
    for (std::size_t d = 0; d < 3; ++d) {
        if (along[d] == 0) continue;
        const double from = -at[d] / along[d];
        const double to = (1 - at[d]) / along[d];
        first = std::max(first, std::min(from, to));
        last = std::min(last, std::max(from, to));
    }
    return last - first;
}

TYPED_TEST(IsolinesOn, SlicesOfALinearFunctionAreStraight) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const Point gradient{2, -3, 1};
        const Point other{1, 1, -2};
        for (auto& grid : TypeParam::grids()) {
            refine_at_sphere(grid, 2 * TypeParam::steps);
            const auto values =
                sample_nodes(grid, [&](const Point& x) { return dot(gradient, x); });
            const auto others = sample_nodes(grid, [&](const Point& x) { return dot(other, x); });
            const PairField field(grid, others, values);
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : {-1.0, 1e-9}) {
                const auto s = plane_slice(grid, field, oblique, 0.7713,
                                           Threshold(&indicator, threshold), indicator);
                const Polylines lines = isolines(s, 1, std::array{0.1234, -0.777});
                ASSERT_EQ(lines.count(), 2U);
                ASSERT_EQ(lines.attribute_count, 2U);
                for (std::size_t i = 0; i < 2; ++i) {
                    EXPECT_FALSE(lines.closed(i));
                    EXPECT_NEAR(lines.length(i), chord(oblique, 0.7713, gradient, lines.value[i]),
                                1e-12);
                    for (const auto v : lines.line(i)) {
                        const Point& x = lines.vertices[v];
                        EXPECT_NEAR(dot(gradient, x), lines.value[i], 1e-12);
                        EXPECT_NEAR(lines.attributes[2 * v], dot(other, x), 1e-12);
                        EXPECT_EQ(lines.attributes[2 * v + 1], lines.value[i]);
                    }
                }
            }
        }
    }
}

template <class Grid>
bool is_flat(const Grid& grid) {
    return std::ranges::all_of(grid.node_positions(), [](const Point& x) { return x[2] == 0; });
}

bool on_unit_square(const Point& x) {
    const auto near = [](double a, double b) { return std::abs(a - b) < 1e-14; };
    return near(x[0], 0) || near(x[0], 1) || near(x[1], 0) || near(x[1], 1);
}

template <class Grid>
void expect_isolines_of_grid(const Grid& grid, const NodalSamples& samples, double threshold) {
    const NodeField<Grid, double> field(grid, samples.values);
    const std::array values{0.0, samples.values[samples.values.size() / 2], 0.0317};
    const IsosurfaceOptions options{.verify = true};
    const Isolines result = isolines(grid, field, values, {.threshold = threshold}, options);
    const Polylines& lines = result.lines;
    const bool flat = is_flat(grid);
    for (std::size_t i = 0; i < lines.count(); ++i) {
        if (lines.closed(i)) continue;
        EXPECT_TRUE(flat && on_unit_square(lines.vertices[lines.line(i).front()]));
        EXPECT_TRUE(flat && on_unit_square(lines.vertices[lines.line(i).back()]));
    }
    std::vector<PointPair> segments;
    std::size_t ends = 0;
    for (const double value : values) {
        const auto of = isosurface(grid, field, value, {.threshold = threshold}, options).surface;
        ends += of.boundary.size();
        for (const auto& [a, b] : of.simplices) {
            segments.push_back({of.vertices[a], of.vertices[b]});
        }
    }
    std::ranges::sort(segments);
    EXPECT_EQ(segments_of(lines), segments);
    EXPECT_EQ(2 * count_open(lines), ends);
    EXPECT_TRUE(std::ranges::is_sorted(lines.value, {}, [&](double value) {
        return std::ranges::find(values, value) - values.begin();
    }));
    const Isolines capped =
        isolines(grid, field, values, {.threshold = threshold}, {.cap = true, .verify = true});
    EXPECT_EQ(count_open(capped.lines), 0U);
    const Isolines threaded =
        isolines(grid, field, values, {.threshold = threshold}, options, {ThreadExecutor(3)});
    expect_equal(threaded.lines, lines);
    EXPECT_EQ(threaded.error_bound, result.error_bound);
}

TYPED_TEST(IsolinesOn, GridsEndOnTheBoundaryOnly) {
    if constexpr (TypeParam::Grid::dimension == 2) {
        for_each_field_at_sphere<TypeParam>(3, 7, [](const auto& grid, const auto& samples) {
            for (const double threshold : thresholds) {
                expect_isolines_of_grid(grid, samples, threshold);
            }
        });
    }
}

TYPED_TEST(IsolinesOn, GridsRunWithHigherValuesOnTheLeft) {
    if constexpr (TypeParam::Grid::dimension == 2) {
        for (auto& grid : TypeParam::grids()) {
            if (!is_flat(grid)) continue;
            refine_at_sphere(grid, 3 * TypeParam::steps);
            const auto values = sample_nodes(grid, [](const Point& x) {
                return 0.36 - norm(x - Point{0.51, 0.49, 0});
            });
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
            const Polylines lines = isolines(grid, field, std::array{0.0}).lines;
            ASSERT_EQ(lines.count(), 1U);
            ASSERT_TRUE(lines.closed(0));
            double area = 0;
            const auto line = lines.line(0);
            for (std::size_t k = 1; k < line.size(); ++k) {
                area += cross(lines.vertices[line[k - 1]], lines.vertices[line[k]])[2] / 2;
            }
            EXPECT_NEAR(area, 3.14159 * 0.36 * 0.36, 0.02);
        }
    }
}

TYPED_TEST(IsolinesOn, GridsOfALinearFunctionAreStraight) {
    if constexpr (TypeParam::Grid::dimension == 2) {
        const Point gradient{2, -3, 0};
        for (auto& grid : TypeParam::grids()) {
            if (!is_flat(grid)) continue;
            refine_at_sphere(grid, 3 * TypeParam::steps);
            const auto values =
                sample_nodes(grid, [&](const Point& x) { return dot(gradient, x); });
            const PairField field(grid, values, values);
            for (const double threshold : {0.0, 1e-9}) {
                const Polylines lines =
                    isolines(grid, field, std::array{0.1234, -0.777}, {.threshold = threshold})
                        .lines;
                ASSERT_EQ(lines.count(), 2U);
                for (std::size_t i = 0; i < 2; ++i) {
                    EXPECT_NEAR(lines.length(i), chord({0, 0, 1}, 0, gradient, lines.value[i]),
                                1e-12);
                }
                for (std::size_t k = 0; k < lines.points.size(); ++k) {
                    const double value = lines.value[k < lines.first[1] ? 0 : 1];
                    EXPECT_NEAR(lines.attributes[lines.points[k]], value, 1e-12);
                }
            }
        }
    }
}

TEST(Isolines, RefusesWrongInput) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Surface<3> triangle;
    EXPECT_EQ(isolines(triangle, 0, std::array{0.0}).count(), 0U);
    triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.simplices = {{0, 1, 2}};
    EXPECT_THROW(isolines(triangle, 0, std::array{0.5}), InvalidInput);
    triangle.attributes = {0, 1, 1};
    EXPECT_EQ(isolines(triangle, 0, std::array{0.5}).count(), 1U);
    EXPECT_EQ(isolines(triangle, 0, {}).count(), 0U);
    EXPECT_THROW(isolines(triangle, 1, std::array{0.5}), InvalidInput);
    EXPECT_THROW(isolines(triangle, 0, std::array{0.5, nan}), InvalidInput);
    triangle.attributes[1] = nan;
    EXPECT_THROW(isolines(triangle, 0, std::array{0.5}), InvalidInput);
    triangle.attributes[1] = 1;
    triangle.simplices[0][2] = 3;
    EXPECT_THROW(isolines(triangle, 0, std::array{0.5}), InvalidInput);

    Surface<2> segment;
    segment.simplices = {{0, 1}};
    EXPECT_THROW(polylines(segment, 0), InvalidInput);
    segment.vertices = {{0, 0, 0}, {1, 0, 0}};
    segment.attributes = {0, 1};
    Polylines lines = polylines(segment, 0);
    segment.attributes.clear();
    EXPECT_THROW(detail::append_polylines(lines, segment, 0), InvalidInput);

    const OctreeGrid<2> plane(quadrilaterals(1));
    const OctreeGrid<3> space(hexahedra(1));
    const std::vector<double> four(plane.node_count(), 1.0);
    const std::vector<double> eight(space.node_count(), 1.0);
    const NodeField<OctreeGrid<2>, double> flat(plane, four);
    const NodeField<OctreeGrid<3>, double> solid(space, eight);
    EXPECT_THROW(isolines(plane, flat, std::array{nan}), InvalidInput);
    EXPECT_THROW(isolines(plane, flat, std::array{0.0}, {.threshold = -1}), InvalidInput);
    EXPECT_THROW(isolines(erase(space, solid), std::array{0.0}), InvalidInput);
}

}  // namespace isolines_test
