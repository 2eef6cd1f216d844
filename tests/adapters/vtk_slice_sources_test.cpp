// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <vtkFeatureEdges.h>
#include <vtkSphere.h>

#include <nestgrid/adapters/vtk_boundary_source.hpp>
#include <nestgrid/adapters/vtk_height_field_source.hpp>
#include <nestgrid/adapters/vtk_isoband_source.hpp>
#include <nestgrid/adapters/vtk_isolines_source.hpp>
#include <nestgrid/adapters/vtk_slice_source.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>

#include "cut_cube.hpp"
#include "vtk_cube.hpp"

using namespace nestgrid_test;

namespace {

template <class Grid>
class TwoComponents {
public:
    using value_type = double;
    static constexpr int components = 2;

    TwoComponents(const NodeField<Grid, double>& first, const NodeField<Grid, double>& second)
        : parts_{&first, &second} {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return interleave(out, [&](const auto& part, std::span<double> values) {
            return part.coarse_values(i, values);
        });
    }
    NodeMask new_values(const typename Grid::Element& e, NodeMask wanted, std::span<double> out,
                        typename Grid::Context& context) const {
        return interleave(out, [&](const auto& part, std::span<double> values) {
            return part.new_values(e, wanted, values, context);
        });
    }

private:
    template <class Get>
    NodeMask interleave(std::span<double> out, const Get& get) const {
        std::array<double, max_new_nodes> values;
        NodeMask missing = 0;
        const std::size_t n = out.size() / 2;
        for (std::size_t c = 0; c < 2; ++c) {
            missing |= get(*parts_[c], std::span(values).first(n));
            for (std::size_t k = 0; k < n; ++k) out[2 * k + c] = values[k];
        }
        return missing;
    }

    std::array<const NodeField<Grid, double>*, 2> parts_;
};

double area_of(vtkPolyData* data) {
    double area = 0;
    for (vtkIdType t = 0; t < data->GetNumberOfCells(); ++t) {
        vtkIdType count = 0;
        const vtkIdType* corner = nullptr;
        data->GetCellPoints(t, count, corner);
        std::array<Point, 3> x;
        for (std::size_t i = 0; i < 3; ++i) data->GetPoint(corner[i], x[i].data());
        area += norm(cross(x[1] - x[0], x[2] - x[0])) / 2;
    }
    return area;
}

/// What a filter of VTK counts behind a source.
vtkIdType count_boundary_edges(vtkAlgorithm* source) {
    const vtkNew<vtkFeatureEdges> edges;
    edges->SetInputConnection(source->GetOutputPort());
    edges->BoundaryEdgesOn();
    edges->FeatureEdgesOff();
    edges->NonManifoldEdgesOn();
    edges->Update();
    return edges->GetOutput()->GetNumberOfLines();
}

/// Filters behind the source see the slice, with every component under its own name.
TEST(SliceSource, FeedsAPipeline) {
    const Cube cube;
    const NodeField first(cube.grid, cube.first);
    const NodeField second(cube.grid, cube.second);
    const TwoComponents<OctreeGrid<3>> field(first, second);
    const vtkNew<SliceSource> source;
    source->SetGrid(cube.grid, field, {"height", "bent"});
    source->SetOrigin(0.5, 0.5, 0.4);
    source->SetNormal(1, 2, 3);
    source->Update();
    vtkPolyData* const slice = source->GetOutput();
    EXPECT_NEAR(area_of(slice), area_in_cube({0.5, 0.5, 0.4}, {1, 2, 3}), 1e-12);
    const Surface<3> expected =
        nestgrid::slice(cube.grid, field, Plane({0.5, 0.5, 0.4}, {1, 2, 3})).surface;
    EXPECT_EQ(count_boundary_edges(source), static_cast<vtkIdType>(expected.boundary.size()));
    ASSERT_EQ(slice->GetPointData()->GetNumberOfArrays(), 2);
    ASSERT_EQ(slice->GetNumberOfPoints(), static_cast<vtkIdType>(expected.vertices.size()));
    for (std::size_t v = 0; v < expected.vertices.size(); ++v) {
        const auto at = static_cast<vtkIdType>(v);
        EXPECT_NEAR(slice->GetPointData()->GetArray("height")->GetTuple1(at),
                    height(expected.vertices[v]), 1e-12);
        EXPECT_EQ(slice->GetPointData()->GetArray("bent")->GetTuple1(at),
                  expected.attributes[2 * v + 1]);
    }
    for (std::size_t t = 0; t < expected.simplices.size(); ++t) {
        const auto at = static_cast<vtkIdType>(t);
        const std::uint32_t e = expected.element_of[t];
        EXPECT_EQ(slice->GetCellData()->GetArray("element")->GetTuple1(at), e);
        EXPECT_EQ(slice->GetCellData()->GetArray("level")->GetTuple1(at), expected.level_of[e]);
    }
}

/// The slice follows its parameters, and what a user changes in a function of VTK.
TEST(SliceSource, FollowsItsParametersAndFunctions) {
    const Cube cube;
    const NodeField field(cube.grid, cube.second);
    const vtkNew<SliceSource> source;
    source->SetGrid(cube.grid, field, {"bent"});
    source->SetOrigin(0, 0, 0.5);
    source->Update();
    const vtkIdType finest = source->GetOutput()->GetNumberOfPolys();
    const vtkMTimeType drawn = source->GetOutput()->GetMTime();
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetMTime(), drawn);

    source->SetThreshold(10);
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(), 8);
    source->SetThreshold(0);
    source->SetMaxTriangles(20);
    source->Update();
    EXPECT_LE(source->GetOutput()->GetNumberOfPolys(), 20);
    source->SetMaxTriangles(0);
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(), finest);

    source->SetCap(true);
    EXPECT_EQ(count_boundary_edges(source), 0);
    EXPECT_NEAR(area_of(source->GetOutput()), 4, 1e-12);
    source->SetCap(false);

    const vtkNew<vtkPlane> plane;
    plane->SetOrigin(0.25, 0, 0);
    plane->SetNormal(1, 1, 0);
    source->SetCutFunction(plane);
    source->Update();
    EXPECT_NEAR(area_of(source->GetOutput()), std::sqrt(2) / 4, 1e-12);
    plane->SetOrigin(0.5, 0, 0);
    source->Update();
    EXPECT_NEAR(area_of(source->GetOutput()), std::sqrt(2) / 2, 1e-12);
    const vtkNew<vtkSphere> sphere;
    sphere->SetCenter(0.5, 0.5, 0.5);
    sphere->SetRadius(0.3);
    source->SetCutFunction(sphere);
    EXPECT_EQ(count_boundary_edges(source), 0);
    EXPECT_NEAR(area_of(source->GetOutput()), 4 * M_PI * 0.09, 0.1);
}

TEST(SliceSource, ReportsWhatGoesWrong) {
    vtkObject::GlobalWarningDisplayOff();
    const Cube cube;
    const NodeField field(cube.grid, cube.first);
    const vtkNew<SliceSource> source;
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(), 0);
    source->SetGrid(cube.grid, field);
    source->SetNormal(0, 0, 0);
    source->Update();
    EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(), 0);
    source->SetNormal(0, 0, 1);
    source->Update();
    EXPECT_GT(source->GetOutput()->GetNumberOfPolys(), 0);
    vtkObject::GlobalWarningDisplayOn();
}

TEST(HeightFieldSource, IsTheGraph) {
    OctreeGrid<2> grid(quadrilaterals(2));
    refine_at_sphere(grid, 3);
    const std::vector<double> values = sample_nodes(grid, height);
    const NodeField field(grid, values);
    const vtkNew<HeightFieldSource> source;
    source->SetGrid(grid, field, {"height"});
    source->SetScale(0);
    source->Update();
    EXPECT_NEAR(area_of(source->GetOutput()), 1, 1e-12);
    source->SetScale(3);
    source->SetThreshold(1);
    EXPECT_EQ(count_boundary_edges(source), 8);
    for (vtkIdType v = 0; v < source->GetOutput()->GetNumberOfPoints(); ++v) {
        Point x;
        source->GetOutput()->GetPoint(v, x.data());
        EXPECT_NEAR(x[2], 3 * height({x[0], x[1], 0}), 1e-12);
        EXPECT_NEAR(source->GetOutput()->GetPointData()->GetArray("height")->GetTuple1(v),
                    height({x[0], x[1], 0}), 1e-12);
    }
}

TEST(IsobandSource, IsTheBand) {
    const Cube cube;
    const NodeField field(cube.grid, cube.first);
    const vtkNew<IsobandSource> source;
    source->SetGrid(cube.grid, field);
    source->SetLow(0.5);
    source->SetHigh(1);
    source->Update();
    Prerolls prerolls(FieldOnGrid(cube.grid, field));
    const auto direct = isoband<3>(prerolls, 0.5, 1, {});
    EXPECT_NEAR(area_of(source->GetOutput()), measure_surface(direct.surface).total.area, 1e-9);
}

TEST(BoundarySource, IsClosedAroundTheDomain) {
    const Cube cube;
    const NodeField field(cube.grid, cube.first);
    const vtkNew<BoundarySource> source;
    source->SetGrid(cube.grid, field, {"height"});
    EXPECT_EQ(count_boundary_edges(source), 0);
    EXPECT_NEAR(area_of(source->GetOutput()), 6, 1e-12);
    EXPECT_NE(source->GetOutput()->GetPointData()->GetArray("height"), nullptr);
}

TEST(IsolinesSource, HaveTheirValues) {
    OctreeGrid<2> grid(quadrilaterals(2));
    refine_at_sphere(grid, 3);
    const std::vector<double> values = sample_nodes(grid, height);
    const NodeField field(grid, values);
    const vtkNew<IsolinesSource> source;
    source->SetGrid(grid, field);
    source->SetValues({0.5, 1.5});
    source->Update();
    vtkPolyData* const lines = source->GetOutput();
    ASSERT_EQ(lines->GetNumberOfLines(), 2);
    for (vtkIdType line = 0; line < 2; ++line) {
        vtkIdType count = 0;
        const vtkIdType* points = nullptr;
        lines->GetCellPoints(line, count, points);
        const double value = lines->GetCellData()->GetArray("value")->GetTuple1(line);
        for (vtkIdType i = 0; i < count; ++i) {
            Point x;
            lines->GetPoint(points[i], x.data());
            EXPECT_NEAR(height(x), value, 1e-5);  // cuts keep away from the ends of edges
        }
    }
}

}  // namespace
