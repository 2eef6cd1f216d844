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

#include "sample_fields.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

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
            const auto result = isosurface(grid, field, data.isovalue, indicator,
                                           {.threshold = threshold * data.range, .cap = true});
            const Mesh mesh = to_cgal(result.surface);
            EXPECT_TRUE(CGAL::is_closed(mesh));
            EXPECT_TRUE(CGAL::is_valid_polygon_mesh(mesh));
        }
    }
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

}  // namespace
