// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Collapsed surfaces do not cross themselves, in the opinion of CGAL.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "closedness.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace collapse_crossing_test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

std::size_t crossing_pairs(const Surface<3>& surface) {
    Mesh mesh;
    for (const Point& p : surface.vertices) mesh.add_vertex({p[0], p[1], p[2]});
    for (const auto& t : surface.simplices) {
        mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
    }
    std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
    CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
    return pairs.size();
}

/// Noise is the field in which parts of a surface are near each other.
SampledField noise(const Samples& n, unsigned seed) {
    std::mt19937 random(seed);
    return {"noise", sample(n, [&](double, double, double) { return uniform(random); }), 0.3, 1};
}

template <class Grid>
void expect_no_new_crossing() {
    const Samples n{13, 13, 13};
    const Grid grid({.samples = n});
    auto fields = sampled_fields(n);
    fields.push_back(noise(n, 3));
    for (const SampledField& data : fields) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const HierarchicalIndicator indicator(grid, field);
        const auto drawn = isosurface(grid, field, data.isovalue, under(indicator, 0)).surface;
        if (crossing_pairs(drawn) > 0) continue;
        for (const double part : {0.1, 0.3, 0.6}) {
            SCOPED_TRACE(part);
            Surface<3> surface = drawn;
            collapse(surface, erase(grid, field), data.isovalue, indicator,
                     {.error = part * data.range});
            EXPECT_LT(surface.simplices.size(), drawn.simplices.size());
            EXPECT_EQ(crossing_pairs(surface), 0U);
        }
        Surface<3> surface = drawn;
        collapse(surface, erase(grid, field), data.isovalue, indicator,
                 {.nearness = Nearness{drawn, 0.7}});
        EXPECT_LT(surface.simplices.size(), drawn.simplices.size());
        EXPECT_EQ(crossing_pairs(surface), 0U);
    }
}

/// Two spheres around each other, nearer than the distance.
class Shell final : public LevelFunction {
public:
    double value(const Point& x) const override {
        return std::abs(norm(x - Point{8, 8, 8}) - 6) - 0.6;
    }
};

template <class Grid>
void expect_no_crossing_of_shells() {
    const Samples n{17, 17, 17};
    const Grid grid({.samples = n});
    const SampledField data = sampled_fields(n)[0];
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    const auto whole = slice(grid, field, Shell()).surface;
    ASSERT_EQ(crossing_pairs(whole), 0U);
    Surface<3> surface = whole;
    const Collapsed result =
        collapse_colours(surface, erase(grid, field), indicator,
                         {.errors = {data.range}, .nearness = Nearness{whole, 2}});
    EXPECT_GT(result.refused_by_crossing, 0U);
    EXPECT_LT(10 * surface.simplices.size(), whole.simplices.size());
    EXPECT_EQ(crossing_pairs(surface), 0U);
}

TEST(CollapsedSlices, DoNotCrossThemselves) {
    expect_no_crossing_of_shells<LatticeBisection<3>>();
    expect_no_crossing_of_shells<LatticeOctree<3>>();
}

TEST(CollapsedSurfaces, DoNotCrossThemselvesInTetrahedra) {
    expect_no_new_crossing<LatticeBisection<3>>();
}
TEST(CollapsedSurfaces, DoNotCrossThemselvesInHexahedra) {
    expect_no_new_crossing<LatticeOctree<3>>();
}

}  // namespace collapse_crossing_test
