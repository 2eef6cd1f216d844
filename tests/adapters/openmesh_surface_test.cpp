// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nestgrid/adapters/openmesh_surface.hpp>

#include "sphere_in_octree.hpp"

using namespace nestgrid_test;

namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};

TEST(OpenMeshSink, IsFilledWhileExtracting) {
    using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
    Mesh mesh;
    const auto expected = pour_sphere(OpenMeshSink<Mesh>(mesh)).surface;
    ASSERT_EQ(mesh.n_vertices(), expected.vertices.size());
    EXPECT_EQ(mesh.n_faces(), expected.simplices.size());
    for (const auto edge : mesh.edges()) EXPECT_FALSE(mesh.is_boundary(edge));
    for (std::uint32_t v = 0; v < expected.vertices.size(); ++v) {
        const OpenMesh::VertexHandle handle(static_cast<int>(v));
        for (unsigned d = 0; d < 3; ++d) {
            EXPECT_EQ(mesh.point(handle)[d], expected.vertices[v][d]);
            EXPECT_EQ(mesh.normal(handle)[d], expected.normals[v][d]);
        }
    }
}

}  // namespace
