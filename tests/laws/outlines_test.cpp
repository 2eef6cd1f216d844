// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Outlines on slices and isosurfaces: the sides on which faces of the elements meet the surface,
// and no others, on every family.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include <nestgrid/algorithms/outlines.hpp>

#include "families.hpp"
#include "plane_slice.hpp"

using namespace nestgrid_test;

namespace outlines_test {

using PointPair = std::array<Point, 2>;

PointPair ascending(const Point& a, const Point& b) {
    return a < b ? PointPair{a, b} : PointPair{b, a};
}

double length_of(const Surface<2>& lines) {
    double sum = 0;
    for (const auto& [a, b] : lines.simplices) sum += norm(lines.vertices[a] - lines.vertices[b]);
    return sum;
}

/// The sides that are in triangles of two elements, or in one triangle only.
std::vector<PointPair> sides_between_elements(const Surface<3>& surface) {
    struct Uses {
        std::set<std::uint32_t> elements;
        int triangles = 0;
    };
    std::map<std::array<std::uint32_t, 2>, Uses> uses;
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [a, b] =
                std::minmax({surface.simplices[t][i], surface.simplices[t][(i + 1) % 3]});
            Uses& of = uses[{a, b}];
            of.elements.insert(surface.element_of[t]);
            ++of.triangles;
        }
    }
    std::vector<PointPair> result;
    for (const auto& [side, of] : uses) {
        if (of.elements.size() == 1 && of.triangles > 1) continue;
        result.push_back(ascending(surface.vertices[side[0]], surface.vertices[side[1]]));
    }
    std::ranges::sort(result);
    return result;
}

std::vector<PointPair> segments_of(const Surface<2>& lines) {
    std::vector<PointPair> result;
    for (const auto& [a, b] : lines.simplices) {
        result.push_back(ascending(lines.vertices[a], lines.vertices[b]));
    }
    std::ranges::sort(result);
    return result;
}

void expect_outlines(const Surface<3>& surface) {
    const Surface<2> lines = outlines(surface);
    EXPECT_EQ(segments_of(lines), sides_between_elements(surface));
    EXPECT_LE(lines.vertices.size(), surface.vertices.size());
    EXPECT_EQ(lines.normals.size(), surface.normals.empty() ? 0 : lines.vertices.size());
    const std::map<Point, std::size_t> number = [&] {
        std::map<Point, std::size_t> by_position;
        for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
            by_position[surface.vertices[v]] = v;
        }
        return by_position;
    }();
    ASSERT_EQ(lines.attributes.size() * surface.vertices.size(),
              surface.attributes.size() * lines.vertices.size());
    if (lines.attributes.size() != lines.vertices.size()) return;
    for (std::size_t v = 0; v < lines.vertices.size(); ++v) {
        EXPECT_EQ(lines.attributes[v], surface.attributes[number.at(lines.vertices[v])]);
    }
}

/// The numbers of the faces of a reference element in whose planes a point lies, as bits.
unsigned faces_at(Shape shape, const Point& x) {
    const Topology& of = topology(shape);
    unsigned faces = 0;
    for (std::size_t f = 0; f < of.faces; ++f) {
        const auto& corner = of.face[f].corner;
        const Point a = of.reference[corner[0]];
        const Point n = cross(of.reference[corner[1]] - a, of.reference[corner[2]] - a);
        if (std::abs(dot(n, x - a)) < 1e-9) faces |= 1U << f;
    }
    return faces;
}

/// Each segment lies in one face of each element that has it. Returns the number of sides of
/// triangles that lie in none.
std::size_t expect_in_faces(const Surface<3>& surface) {
    std::set<PointPair> lines;
    for (const PointPair& segment : segments_of(outlines(surface))) lines.insert(segment);
    std::size_t within = 0;
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const Shape shape = surface.shape_of[surface.element_of[t]];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const Point& a = surface.reference[3 * t + i];
            const Point& b = surface.reference[3 * t + j];
            if (std::isnan(a[0]) || std::isnan(b[0])) continue;
            const bool in_face = (faces_at(shape, a) & faces_at(shape, b)) != 0;
            const auto& corners = surface.simplices[t];
            const bool drawn = lines.count(ascending(surface.vertices[corners[i]],
                                                     surface.vertices[corners[j]])) > 0;
            EXPECT_TRUE(in_face || !drawn);
            within += in_face ? 0 : 1;
        }
    }
    return within;
}

template <class Family>
class OutlinesOn : public testing::Test {};
TYPED_TEST_SUITE(OutlinesOn, Families);

TYPED_TEST(OutlinesOn, IsosurfacesLieInFacesOfElements) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        std::size_t within = 0;
        for_each_field_at_sphere<TypeParam>(2, 7, [&](const auto& grid, const auto& samples) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            for (const double threshold : {0.0, 0.1, 1.0}) {
                for (const bool cap : {false, true}) {
                    const IsosurfaceOptions options{.normals = true, .cap = cap, .reference = true};
                    const auto surface =
                        isosurface(grid, field, 0.0, {.threshold = threshold}, options).surface;
                    expect_outlines(surface);
                    within += expect_in_faces(surface);
                }
            }
        });
        EXPECT_GT(within, 1000U);
    }
}

/// Length of the boundary of the convex hull of points in a plane.
double hull_perimeter(std::vector<Point> x, const Point& normal) {
    std::ranges::sort(x);
    std::vector<Point> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t first = hull.size();
        for (const Point& p : x) {
            while (hull.size() >= first + 2 &&
                   dot(normal, cross(hull.back() - hull[hull.size() - 2], p - hull.back())) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        }
        hull.pop_back();
        std::ranges::reverse(x);
    }
    double sum = 0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        sum += norm(hull[(i + 1) % hull.size()] - hull[i]);
    }
    return sum;
}

/// A plane meets elements with flat faces in convex polygons that cover its part of the domain. So
/// their perimeters count each outline twice, but for those on the boundary.
void expect_perimeters(const Surface<3>& surface, const Point& normal) {
    std::vector<std::vector<Point>> polygon(surface.shape_of.size());
    std::vector<Point> all;
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        for (const std::uint32_t v : surface.simplices[t]) {
            polygon[surface.element_of[t]].push_back(surface.vertices[v]);
            all.push_back(surface.vertices[v]);
        }
    }
    double sum = hull_perimeter(std::move(all), normal);
    for (auto& x : polygon) sum += hull_perimeter(std::move(x), normal);
    EXPECT_NEAR(2 * length_of(outlines(surface)), sum, 1e-12 * sum);
}

TYPED_TEST(OutlinesOn, SlicesAreAsLongAsThePolygonsOfTheirElements) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        const Point normal{0.3, 0.5, 0.81};
        bool regular = true;
        const auto grids = TypeParam::grids();
        for (auto grid : grids) {
            refine_at_sphere(grid, 2 * TypeParam::steps);
            for (const NodalSamples& samples : catching_fields(grid.node_positions(), 7)) {
                const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
                const HierarchicalIndicator indicator(grid, field);
                for (const double threshold : {0.0, 0.1, 1.0}) {
                    SCOPED_TRACE(samples.name + " at threshold " + std::to_string(threshold));
                    const auto surface = plane_slice(grid, field, normal, 0.7713,
                                                     Threshold(&indicator, threshold), indicator);
                    expect_outlines(surface);
                    if (regular) expect_perimeters(surface, normal);
                }
            }
            regular = false;
        }
    }
}

TEST(Outlines, OfAUniformOctreeIsALattice) {
    for (int levels = 0; levels < 4; ++levels) {
        OctreeGrid<3> grid(hexahedra(3));
        for (int i = 0; i < levels; ++i) grid.adapt([](const Leaf&) { return Mark::refine; });
        const auto values = sample_nodes(grid, [](const Point& x) { return x[0] * x[1] - x[2]; });
        const NodeField<OctreeGrid<3>, double> field(grid, values);
        const HierarchicalIndicator indicator(grid, field);
        const auto surface =
            plane_slice(grid, field, {0, 0, 1}, 0.371, Threshold(&indicator, -1), indicator);
        const double cells = 3 << levels;
        EXPECT_NEAR(length_of(outlines(surface)), 2 * (cells + 1), 1e-12 * cells);
    }
}

TEST(Outlines, RefusesSurfacesWithoutElements) {
    Surface<3> triangle;
    EXPECT_TRUE(outlines(triangle).simplices.empty());
    triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.simplices = {{0, 1, 2}};
    EXPECT_THROW(outlines(triangle), InvalidInput);
    triangle.element_of = {0};
    EXPECT_EQ(outlines(triangle).simplices.size(), 3U);
    triangle.simplices[0][1] = 3;
    EXPECT_THROW(outlines(triangle), InvalidInput);
}

}  // namespace outlines_test
