// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nestgrid/adapters/vtk_isosurface_source.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>

#include "sample_grids.hpp"
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

/// A pipeline pulls what the grid and the options are at the time, and nothing twice.
TEST(IsosurfaceSource, FollowsTheGridAndItsOptions) {
    OctreeGrid<3> grid(hexahedra(2));
    std::vector<double> values;
    const auto sample = [&] {
        values = sample_nodes(grid, [](const Point& x) {
            return 0.3 - norm(x - Point{0.51, 0.49, 0.5});
        });
    };
    refine_at_sphere(grid, 2);
    sample();
    const NodeField field(grid, values);
    const vtkNew<IsosurfaceSource> source;
    source->SetGrid(grid, field);
    source->SetNormals(true);
    source->Update();
    const vtkIdType first = source->GetOutput()->GetNumberOfPolys();
    EXPECT_EQ(first, static_cast<vtkIdType>(isosurface(grid, field, 0.0).surface.simplices.size()));
    EXPECT_NE(source->GetOutput()->GetPointData()->GetNormals(), nullptr);
    const vtkMTimeType drawn = source->GetOutput()->GetMTime();
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetMTime(), drawn);

    grid.refine_uniformly();
    sample();
    const NodeField finer(grid, values);
    source->SetGrid(grid, finer);
    source->Update();
    const vtkIdType second = source->GetOutput()->GetNumberOfPolys();
    EXPECT_GT(second, 2 * first);
    source->SetMaxTriangles(static_cast<std::uint64_t>(first));
    source->Update();
    EXPECT_LE(source->GetOutput()->GetNumberOfPolys(), first);
    EXPECT_GT(source->GetOutput()->GetNumberOfPolys(), 0);
    source->SetMaxTriangles(0);
    source->SetIsovalue(0.1);
    source->Update();
    EXPECT_LT(source->GetOutput()->GetNumberOfPolys(), second);
    EXPECT_GT(source->GetOutput()->GetNumberOfPolys(), 0);
}

/// What goes wrong is an error of the algorithm, not an exception through VTK.
TEST(IsosurfaceSource, ReportsWhatGoesWrong) {
    vtkObject::GlobalWarningDisplayOff();
    const vtkNew<IsosurfaceSource> source;
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(), 0);
    const OctreeGrid<3> grid(hexahedra(1));
    const std::vector<double> values(8, std::nan(""));
    const NodeField field(grid, values);
    source->SetGrid(grid, field);
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(), 0);
    vtkObject::GlobalWarningDisplayOn();
}

}  // namespace
