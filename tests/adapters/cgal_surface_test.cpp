// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/boost/graph/helpers.h>

#include <gtest/gtest.h>

#include <nestgrid/adapters/cgal_surface.hpp>

#include "sphere_in_octree.hpp"

using namespace nestgrid_test;

namespace {

TEST(SurfaceMeshSink, IsFilledWhileExtracting) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
    Mesh mesh;
    const auto expected = pour_sphere(SurfaceMeshSink<Kernel::Point_3>(mesh)).surface;
    EXPECT_EQ(mesh.number_of_vertices(), expected.vertices.size());
    EXPECT_EQ(mesh.number_of_faces(), expected.simplices.size());
    EXPECT_TRUE(CGAL::is_closed(mesh));
    EXPECT_TRUE(CGAL::is_valid_polygon_mesh(mesh));
    const auto normals = mesh.property_map<Mesh::Vertex_index, Kernel::Vector_3>("v:normal");
    ASSERT_TRUE(normals.second);
    for (std::uint32_t v = 0; v < expected.vertices.size(); ++v) {
        const auto& p = mesh.point(Mesh::Vertex_index(v));
        EXPECT_EQ((Point{p.x(), p.y(), p.z()}), expected.vertices[v]);
        EXPECT_EQ(normals.first[Mesh::Vertex_index(v)].z(), expected.normals[v][2]);
    }
}

}  // namespace
