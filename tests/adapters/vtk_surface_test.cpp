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

}  // namespace
