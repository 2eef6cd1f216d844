// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <vtkSphere.h>

#include <nestgrid/adapters/vtk_discontinuous_source.hpp>
#include <nestgrid/adapters/vtk_isosurface_source.hpp>

#include "refusal.hpp"
#include "vtk_cube.hpp"

using namespace nestgrid_test;

namespace {

/// A number for each leaf, which jumps from each to the next.
template <int dim>
auto jumping(const OctreeGrid<dim>& grid) {
    return
        [&grid, positions = grid.node_positions()](const typename OctreeGrid<dim>::Element& leaf) {
            std::array<NodeKey, std::size_t{1} << dim> keys;
            grid.corner_keys(leaf, keys);
            return static_cast<double>(keys[0] % 5) / 16 + 0.25;
        };
}

template <int dim>
void expect_same(vtkPolyData* drawn, const Surface<dim>& direct) {
    ASSERT_GT(direct.simplices.size(), 0U);
    ASSERT_EQ(drawn->GetNumberOfCells(), static_cast<vtkIdType>(direct.simplices.size()));
    ASSERT_EQ(drawn->GetNumberOfPoints(), static_cast<vtkIdType>(direct.vertices.size()));
    vtkDataArray* const values = drawn->GetPointData()->GetArray("density");
    for (vtkIdType v = 0; v < drawn->GetNumberOfPoints(); ++v) {
        Point x;
        drawn->GetPoint(v, x.data());
        ASSERT_EQ(x, direct.vertices[static_cast<std::size_t>(v)]);
        ASSERT_EQ(values->GetTuple1(v), direct.attributes[static_cast<std::size_t>(v)]);
    }
}

/// What jumps in the data jumps in the output: it is what the library draws, and follows the grid.
TEST(DiscontinuousSource, DrawsSlicesAndHeights) {
    OctreeGrid<3> grid(hexahedra(2));
    refine_at_sphere(grid, 2);
    const auto values = jumping(grid);
    const vtkNew<DiscontinuousSource> source;
    source->SetGrid(grid, values, {"density"});
    source->SetOrigin(0.3, 0.4, 0.55);
    source->SetNormal(1, 2, 3);
    const Plane plane({0.3, 0.4, 0.55}, {1, 2, 3});
    for (const double threshold : {0.0, 0.15, 0.3}) {
        source->SetThreshold(threshold);
        source->Update();
        const auto direct = slice(DiscontinuousData(grid, values), plane, {.threshold = threshold});
        expect_same(source->GetOutput(), direct.surface);
        EXPECT_EQ(source->GetErrorBounds().error_bound, direct.error_bound);
    }
    const vtkNew<vtkSphere> sphere;
    sphere->SetCenter(0.5, 0.5, 0.5);
    sphere->SetRadius(0.3);
    source->SetCutFunction(sphere);
    source->SetThreshold(0.15);
    source->Update();
    expect_same(source->GetOutput(), slice(DiscontinuousData(grid, values),
                                           ImplicitLevelFunction(*sphere), {.threshold = 0.15})
                                         .surface);
    source->SetCutFunction(nullptr);
    grid.refine_uniformly();
    source->Update();
    expect_same(source->GetOutput(),
                slice(DiscontinuousData(grid, values), plane, {.threshold = 0.15}).surface);

    OctreeGrid<2> flat(quadrilaterals(2));
    flat.refine_uniformly();
    const auto in_plane = jumping(flat);
    source->SetGrid(flat, in_plane, {"density"});
    source->SetThreshold(0);
    source->SetScale(2);
    source->SetMaxTriangles(20);
    source->Update();
    expect_same(
        source->GetOutput(),
        height_field(DiscontinuousData(flat, in_plane), 2.0, {.max_triangles = 20}).surface);
    source->SetMaxTriangles(0);
    source->SetBlend(2);
    expect_refused([&] { update_source(source); }, "within a threshold or a number of triangles");
}

/// Triangles tell where in their elements their corners lie, of several surfaces, too.
TEST(IsosurfaceSource, TellsPlacesInElements) {
    const Cube cube;
    const NodeField field(cube.grid, cube.second);
    const vtkNew<IsosurfaceSource> source;
    source->SetGrid(cube.grid, field);
    source->SetIsovalue(2.5);
    source->SetReference(true);
    const auto expect_places = [&](const std::vector<double>& isovalues) {
        source->Update();
        vtkDataArray* const told = source->GetOutput()->GetCellData()->GetArray("reference");
        ASSERT_NE(told, nullptr);
        ASSERT_EQ(told->GetNumberOfComponents(), 9);
        vtkIdType triangle = 0;
        for (const double isovalue : isovalues) {
            const auto direct =
                isosurface(cube.grid, field, isovalue, {}, {.reference = true}).surface;
            for (std::size_t t = 0; t < direct.simplices.size(); ++t, ++triangle) {
                for (std::size_t i = 0; i < 9; ++i) {
                    ASSERT_EQ(told->GetComponent(triangle, static_cast<int>(i)),
                              direct.reference[3 * t + i / 3][i % 3]);
                }
            }
        }
        EXPECT_EQ(triangle, source->GetOutput()->GetNumberOfCells());
    };
    expect_places({2.5});
    source->SetMoreIsovalues({2.25});
    expect_places({2.5, 2.25});
    source->SetReference(false);
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetCellData()->GetArray("reference"), nullptr);
}

/// What is measured of a surface is told with it, of each isovalue.
TEST(IsosurfaceSource, MeasuresErrors) {
    const Cube cube;
    const NodeField field(cube.grid, cube.second);
    const Prerolls prerolls(FieldOnGrid(cube.grid, field));
    const vtkNew<IsosurfaceSource> source;
    source->SetGrid(cube.grid, field);
    source->SetIsovalue(2.5);
    source->SetMoreIsovalues({2.25});
    source->SetThreshold(0.05);
    source->SetMeasurePoints(1000);
    source->Update();
    ASSERT_EQ(source->GetMeasuredErrors().size(), 2U);
    vtkFieldData* const told = source->GetOutput()->GetFieldData();
    for (const std::size_t i : {0U, 1U}) {
        const double isovalue = i == 0 ? 2.5 : 2.25;
        const auto drawn = isosurface(cube.grid, field, isovalue, {.threshold = 0.05});
        const MeasuredError direct = measure_error(prerolls, drawn.surface, isovalue, 1000);
        EXPECT_GT(direct.distance.greatest, 0);
        const auto expect_told = [&](const char* name, const Measured& measured) {
            vtkDataArray* const array = told->GetArray(name);
            ASSERT_NE(array, nullptr) << name;
            const auto row = static_cast<vtkIdType>(i);
            EXPECT_EQ(array->GetComponent(row, 0), measured.greatest);
            EXPECT_EQ(array->GetComponent(row, 1), measured.mean);
            EXPECT_EQ(array->GetComponent(row, 2), measured.rms);
        };
        expect_told("error", direct.value);
        expect_told("distance", direct.distance);
        expect_told("distance back", direct.back);
    }
    source->SetMeasurePoints(0);
    source->Update();
    EXPECT_TRUE(source->GetMeasuredErrors().empty());
    EXPECT_EQ(source->GetOutput()->GetFieldData()->GetArray("error"), nullptr);
}

}  // namespace
