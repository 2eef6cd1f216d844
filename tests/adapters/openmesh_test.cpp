// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces from OpenMesh: nothing copied, nothing lost.
#include <cstring>

#include <nestgrid/adapters/openmesh.hpp>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "coarse_samples.hpp"
#include "refusal_rows.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
};
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<>;

template <class Mesh>
Mesh to_openmesh(const CoarseGrid& grid) {
    Mesh mesh;
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
        const Point x = grid.nodes[i];
        using Scalar = typename Mesh::Scalar;
        mesh.add_vertex(
            {static_cast<Scalar>(x[0]), static_cast<Scalar>(x[1]), static_cast<Scalar>(x[2])});
    }
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        std::vector<OpenMesh::VertexHandle> loop;
        for (const auto n : grid.element(e)) {
            loop.push_back(mesh.vertex_handle(static_cast<unsigned>(n)));
        }
        if (loop.size() == 4) std::swap(loop[2], loop[3]);
        EXPECT_TRUE(mesh.add_face(loop).is_valid());
    }
    return mesh;
}

/// The same elements, each with the same loop, begun anywhere.
void expect_same_elements(const CoarseGrid& a, const CoarseGrid& b) {
    ASSERT_EQ(a.element_count(), b.element_count());
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t e = 0; e < a.element_count(); ++e) {
        ASSERT_EQ(a.shapes[e], b.shapes[e]);
        const auto loop = [e](const CoarseGrid& grid) {
            std::vector<std::uint32_t> l(grid.element(e).begin(), grid.element(e).end());
            if (l.size() == 4) std::swap(l[2], l[3]);
            std::rotate(l.begin(), std::min_element(l.begin(), l.end()), l.end());
            return l;
        };
        EXPECT_EQ(loop(a), loop(b));
    }
}

TEST(OpenMesh, LendsItsDoubles) {
    const CoarseGrid sample = torus(24, 12, true);
    const auto mesh = to_openmesh<PolyMesh>(sample);
    CoarseGrid grid = coarse_from_openmesh(mesh);
    EXPECT_TRUE(grid.nodes.borrowed());
    expect_same_elements(grid, sample);
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) EXPECT_EQ(grid.nodes[i], sample.nodes[i]);
    EXPECT_DOUBLE_EQ(total_measure(grid), total_measure(sample));
    check_and_orient(grid);
    expect_same_elements(grid, sample);
}

TEST(OpenMesh, LendsItsFloats) {
    const CoarseGrid sample = torus(24, 12, false);
    auto mesh = to_openmesh<TriMesh>(sample);
    CoarseGrid grid = coarse_from_openmesh(mesh);
    EXPECT_TRUE(grid.nodes.borrowed());
    expect_same_elements(grid, sample);
    EXPECT_NEAR(total_measure(grid), total_measure(sample), 1e-5);
    mesh.set_point(OpenMesh::VertexHandle(3), {7, 8, 9});
    EXPECT_EQ(grid.nodes[3], (Point{7, 8, 9}));
    check_and_orient(grid);
}

TEST(OpenMesh, RefusesDeletedElementsAndPentagons) {
    auto mesh = to_openmesh<PolyMesh>(torus(8, 6, true));
    mesh.delete_face(OpenMesh::FaceHandle(5), true);
    expect_sentence<InvalidInput>([&] { coarse_from_openmesh(mesh); },
                                  {"deleted", "garbage_collection()"});
    mesh.garbage_collection();
    EXPECT_EQ(coarse_from_openmesh(mesh).element_count(), 47U);

    std::vector<OpenMesh::VertexHandle> loop;
    PolyMesh pentagon;
    for (int i = 0; i < 5; ++i) {
        loop.push_back(pentagon.add_vertex({std::cos(1.2566 * i), std::sin(1.2566 * i), 0}));
    }
    pentagon.add_face(loop);
    expect_sentence<InvalidInput>([&] { coarse_from_openmesh(pentagon); }, {"face 0", "5 corners"});
    EXPECT_EQ(coarse_from_openmesh(PolyMesh()).element_count(), 0U);
}

TEST(Refusals, OfOpenMesh) {
    RefusalRows rows("OpenMesh");
    auto mesh = to_openmesh<PolyMesh>(torus(8, 6, true));
    mesh.delete_face(OpenMesh::FaceHandle(5), true);
    rows.add("deleted elements that are still there", [&] { coarse_from_openmesh(mesh); });
    rows.add("a polygon of five corners", [] {
        PolyMesh pentagon;
        std::vector<OpenMesh::VertexHandle> loop;
        for (int i = 0; i < 5; ++i) {
            loop.push_back(pentagon.add_vertex({std::cos(1.2566 * i), std::sin(1.2566 * i), 0}));
        }
        pentagon.add_face(loop);
        coarse_from_openmesh(pentagon);
    });
}

}  // namespace
