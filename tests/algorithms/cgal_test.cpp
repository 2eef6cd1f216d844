// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// CGAL's opinion of our surfaces.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "closedness.hpp"
#include "sample_fields.hpp"
#include "sample_grids.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace cgal_test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace processing = CGAL::Polygon_mesh_processing;

template <class Surface>
Mesh to_cgal(const Surface& surface) {
    Mesh mesh;
    for (const Point& p : surface.vertices) mesh.add_vertex({p[0], p[1], p[2]});
    for (const auto& t : surface.simplices) {
        // add_face refuses what would make the mesh non-manifold.
        EXPECT_NE(mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]),
                                Mesh::Vertex_index(t[2])),
                  Mesh::null_face());
    }
    return mesh;
}

TEST(Cgal, FindsEverySurfaceInsideTheDomainClosed) {
    const Samples n{33, 33, 33};
    const LatticeBisection<3> grid({.samples = n});
    for (const SampledField& data : sampled_fields(n)) {
        const LatticeField field(grid, std::span<const float>(data.values));
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : thresholds) {
            SCOPED_TRACE(data.name + " at " + std::to_string(threshold));
            const auto result = isosurface(grid, field, data.isovalue,
                                           under(indicator, threshold * data.range), {.cap = true});
            const Mesh mesh = to_cgal(result.surface);
            EXPECT_TRUE(CGAL::is_closed(mesh));
            EXPECT_TRUE(CGAL::is_valid_polygon_mesh(mesh));
        }
    }
}

template <class Grid>
void expect_closed_for_cgal(Grid grid, int levels) {
    refine_at_sphere(grid, levels);
    for (const NodalSamples& samples : catching_fields(grid.node_positions(), 1)) {
        const NodeField<Grid, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : {0.0, 0.1, 1.0}) {
            SCOPED_TRACE(samples.name + " at " + std::to_string(threshold));
            const auto result =
                isosurface(grid, field, 0.0, under(indicator, threshold), {.cap = true});
            const Mesh mesh = to_cgal(result.surface);
            EXPECT_TRUE(CGAL::is_closed(mesh));
            EXPECT_TRUE(CGAL::is_valid_polygon_mesh(mesh));
        }
    }
}

TEST(Cgal, FindsSurfacesClosedAcrossHangingNodesAndShapes) {
    expect_closed_for_cgal(OctreeGrid<3>(shaken(hexahedra(2), 1, 0.1), {.balanced = false}), 3);
    expect_closed_for_cgal(RedGreenGrid<3>(hexahedra(2)), 2);
    expect_closed_for_cgal(RedGreenSimplices<3>(shaken(tetrahedra(2), 2, 0.1)), 3);
    expect_closed_for_cgal(PrismGrid(extrude(triangles(2), std::vector{0.5, 0.5})), 3);
}

TEST(Cgal, FindsNoSelfIntersectionOfTheSphere) {
    const Samples n{33, 33, 33};
    const LatticeBisection<3> grid({.samples = n});
    SampledField data = sampled_fields(n)[0];
    for (float& v : data.values) v = -v;
    const LatticeField field(grid, std::span<const float>(data.values));
    for (const double threshold : thresholds) {
        const auto result =
            isosurface(grid, field, -data.isovalue, {.threshold = threshold * data.range});
        const Mesh mesh = to_cgal(result.surface);
        EXPECT_TRUE(CGAL::is_closed(mesh));
        EXPECT_FALSE(processing::does_self_intersect(mesh));
        EXPECT_TRUE(processing::is_outward_oriented(mesh));
        EXPECT_NEAR(processing::volume(mesh), surface_report(result.surface).volume, 1e-6);
    }
}

}  // namespace cgal_test
