// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nestgrid/adapters/vtk_surface.hpp>

#include "sphere_in_octree.hpp"

using namespace nestgrid_test;

namespace {

void expect_same(vtkPolyData* a, vtkPolyData* b) {
    ASSERT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
    ASSERT_EQ(a->GetNumberOfPolys(), b->GetNumberOfPolys());
    for (vtkIdType p = 0; p < a->GetNumberOfPoints(); ++p) {
        for (int d = 0; d < 3; ++d) {
            EXPECT_EQ(a->GetPoint(p)[d], b->GetPoint(p)[d]);
            EXPECT_EQ(a->GetPointData()->GetNormals()->GetComponent(p, d),
                      b->GetPointData()->GetNormals()->GetComponent(p, d));
        }
    }
    for (const char* name : {"element", "level"}) {
        vtkDataArray* of_a = a->GetCellData()->GetArray(name);
        vtkDataArray* of_b = b->GetCellData()->GetArray(name);
        for (vtkIdType c = 0; c < a->GetNumberOfPolys(); ++c) {
            EXPECT_EQ(of_a->GetComponent(c, 0), of_b->GetComponent(c, 0));
        }
    }
}

TEST(PolyDataSink, IsFilledWhileExtracting) {
    const PolyDataSink<3> sink;
    const auto expected = pour_sphere(sink).surface;  // a sink refers to its data
    ASSERT_EQ(sink.data()->GetNumberOfPoints(), static_cast<vtkIdType>(expected.vertices.size()));
    for (std::uint32_t v = 0; v < expected.vertices.size(); ++v) {
        EXPECT_EQ(sink.position(v), expected.vertices[v]);
    }
    expect_same(sink.data(), make_poly_data(expected));
}

TEST(SharedPolyData, LiesInTheArraysOfTheSurface) {
    const PolyDataSink<3> sink;
    auto surface = pour_sphere(sink).surface;
    surface.attributes.assign(2 * surface.vertices.size(), 1.5);
    const vtkSmartPointer<vtkPolyData> shared = share_poly_data(surface);
    ASSERT_EQ(shared->GetNumberOfPoints(), static_cast<vtkIdType>(surface.vertices.size()));
    ASSERT_EQ(shared->GetNumberOfPolys(), static_cast<vtkIdType>(surface.simplices.size()));
    EXPECT_EQ(shared->GetPoints()->GetVoidPointer(0), surface.vertices.data());
    EXPECT_EQ(shared->GetPointData()->GetNormals()->GetVoidPointer(0), surface.normals.data());
    EXPECT_EQ(shared->GetPointData()->GetArray("attributes")->GetVoidPointer(0),
              surface.attributes.data());
    EXPECT_EQ(shared->GetPolys()->GetConnectivityArray()->GetVoidPointer(0),
              surface.simplices.data());
    vtkIdType corners = 0;
    const vtkIdType* corner = nullptr;
    for (vtkIdType t = 0; t < shared->GetNumberOfPolys(); ++t) {
        shared->GetCellPoints(t, corners, corner);
        ASSERT_EQ(corners, 3);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(corner[i], surface.simplices[static_cast<std::size_t>(t)][i]);
        }
    }
    Surface<3> empty;
    EXPECT_EQ(share_poly_data(empty)->GetNumberOfPolys(), 0);
}

}  // namespace
