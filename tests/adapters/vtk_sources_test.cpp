// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nestgrid/adapters/vtk_isolines_source.hpp>
#include <nestgrid/adapters/vtk_isosurface_source.hpp>

#include "refusal_rows.hpp"
#include "vtk_cube.hpp"

using namespace nestgrid_test;

namespace {

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

TEST(Refusals, OfVtkSources) {
    RefusalRows rows("VTK sources");
    const vtkNew<IsosurfaceSource> source;
    rows.add("no grid", [&] { update_source(source); });
    OctreeGrid<3> grid(hexahedra(1));
    std::vector<double> values(8, std::nan(""));
    const NodeField field(grid, values);
    source->SetGrid(grid, field);
    rows.add("a value that is no number", [&] { update_source(source); });
    values.assign(8, 1);
    source->InvalidateField();
    EXPECT_NO_THROW(update_source(source));
    source->SetIsovalue(std::nan(""));
    rows.add("an isovalue that is no number", [&] { update_source(source); });
    source->SetIsovalue(0.5);
    source->SetIndicator("colour");
    rows.add("an indicator that does not exist", [&] { update_source(source); });
    source->SetIndicator("offset");
    source->SetCollapse(true);
    rows.add("collapses without a threshold", [&] { update_source(source); });
    source->SetCollapse(false);
    const vtkNew<IsolinesSource> lines;
    lines->SetGrid(grid, field);
    rows.add("isolines in space", [&] { update_source(lines); });
    grid.refine_uniformly();
    rows.add("a field from before a refinement", [&] { update_source(source); });
}

/// Whatever a projection says, a source draws what the library draws of it.
TEST(GridSource, DrawsAsFinelyAsAProjectionSays) {
    const Cube cube;
    const NodeField field(cube.grid, cube.second);
    Prerolls prerolls(FieldOnGrid(cube.grid, field));
    const auto expect_drawn = [&](IsosurfaceSource* source, const Projection& projection) {
        source->Update();
        const auto direct = isosurface<3>(prerolls, 2.5, projection);
        EXPECT_GT(direct.surface.simplices.size(), 0U);
        EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(),
                  static_cast<vtkIdType>(direct.surface.simplices.size()));
        EXPECT_EQ(source->GetErrorBounds().error_bound, direct.error_bound);
        EXPECT_EQ(source->GetDrawnThreshold(), direct.search.threshold);
    };
    const vtkNew<IsosurfaceSource> source;
    source->SetGrid(cube.grid, field);
    source->SetIsovalue(2.5);
    source->SetError(0.05);
    expect_drawn(source, {.threshold = 0.05, .indicator = "error"});
    source->SetCollapse(true);
    expect_drawn(source, {.threshold = 0.05, .indicator = "error", .collapse = true});
    source->SetDistance(0.05);
    expect_drawn(
        source,
        {.threshold = 0.05, .indicator = "slope", .collapse = true, .keeps_distance = true});
    source->SetCollapse(false);
    source->SetIndicator("visual");
    source->SetBlend(2);
    expect_drawn(source, {.threshold = 0.05, .indicator = "visual", .blend = 2});
    const LensRequest lens{.distance = Ball{{0.5, 0.5, 0.5}, 0.1}, .finest = 0.1};
    source->SetProjection({});
    source->SetLens(lens);
    expect_drawn(source, {.lens = lens});
    source->RemoveLens();
    source->SetMaxTriangles(40);
    expect_drawn(source, {.max_triangles = 40});
}

/// Several isosurfaces of one walk, and the edges of their elements, are those that the library
/// draws one by one.
TEST(IsosurfaceSource, DrawsSeveralAndOutlines) {
    const Cube cube;
    const NodeField field(cube.grid, cube.second);
    Prerolls prerolls(FieldOnGrid(cube.grid, field));
    const std::array<double, 3> isovalues{2.5, 2.25, 2.8};
    const vtkNew<IsosurfaceSource> source;
    source->SetGrid(cube.grid, field);
    source->SetIsovalue(isovalues[0]);
    source->SetMoreIsovalues({isovalues[1], isovalues[2]});
    source->SetThreshold(0.01);
    const auto count = [&](double isovalue) {
        source->Update();
        vtkDataArray* const value = source->GetOutput()->GetCellData()->GetArray("value");
        std::size_t cells = 0;
        for (vtkIdType t = 0; t < source->GetOutput()->GetNumberOfCells(); ++t) {
            if (value->GetTuple1(t) != isovalue) continue;
            ++cells;
            vtkIdType corners = 0;
            const vtkIdType* corner = nullptr;
            source->GetOutput()->GetCellPoints(t, corners, corner);
            for (vtkIdType k = 0; k < corners; ++k) {
                Point x;
                source->GetOutput()->GetPoint(corner[k], x.data());
                EXPECT_NEAR(bent(x), isovalue, 0.02);
            }
        }
        return cells;
    };
    for (const bool outlined : {false, true}) {
        source->SetOutlines(outlined);
        vtkIdType all = 0;
        for (const double isovalue : isovalues) {
            const auto direct = isosurface<3>(prerolls, isovalue, {.threshold = 0.01});
            const std::size_t expected = outlined ? outlines(direct.surface).simplices.size()
                                                  : direct.surface.simplices.size();
            EXPECT_EQ(count(isovalue), expected);
            all += static_cast<vtkIdType>(expected);
        }
        EXPECT_EQ(source->GetOutput()->GetNumberOfCells(), all);
    }
    EXPECT_GT(source->GetOutput()->GetNumberOfLines(), 0);
}

/// The pipeline is told the times of frames, and gets the field at the one that it asks for.
TEST(GridSource, DrawsFramesAtATime) {
    const auto grid = std::make_shared<const OctreeGrid<3>>([] {
        OctreeGrid<3> made(hexahedra(2));
        refine_at_sphere(made, 3);
        return made;
    }());
    const auto values = std::make_shared<std::vector<std::vector<double>>>();
    for (const double shift : {0.0, 1.0}) {
        values->push_back(
            sample_nodes(*grid, [&](const Point& x) { return height(x) + shift * x[2]; }));
    }
    const std::vector<NodeField<OctreeGrid<3>, double>> fields{{*grid, (*values)[0]},
                                                               {*grid, (*values)[1]}};
    const Frames frames = shared_frames(grid, fields, {10, 20}, values);
    const vtkNew<IsosurfaceSource> source;
    source->SetFrames(frames);
    source->SetIsovalue(1);
    source->UpdateInformation();
    vtkInformation* const told = source->GetOutputInformation(0);
    using Pipeline = vtkStreamingDemandDrivenPipeline;
    ASSERT_EQ(told->Length(Pipeline::TIME_STEPS()), 2);
    EXPECT_EQ(told->Get(Pipeline::TIME_STEPS())[1], 20);
    EXPECT_EQ(told->Get(Pipeline::TIME_RANGE())[0], 10);
    const auto expect_at = [&](double time, double shift) {
        vtkPolyData* const drawn = source->GetOutput();
        ASSERT_GT(drawn->GetNumberOfPolys(), 0);
        EXPECT_EQ(drawn->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
        for (vtkIdType v = 0; v < drawn->GetNumberOfPoints(); ++v) {
            Point x;
            drawn->GetPoint(v, x.data());
            EXPECT_NEAR(height(x) + shift * x[2], 1, 1e-5);
        }
    };
    source->Update();
    expect_at(10, 0);
    for (const auto& [asked, time, shift] :
         {std::array{12.5, 12.5, 0.25}, std::array{20.0, 20.0, 1.0}, std::array{99.0, 20.0, 1.0}}) {
        source->UpdateTimeStep(asked);
        expect_at(time, shift);
    }
    // A grid in their place has no times.
    const NodeField field(*grid, (*values)[0]);
    source->SetGrid(*grid, field);
    source->UpdateInformation();
    EXPECT_EQ(told->Has(Pipeline::TIME_STEPS()), 0);
    source->Update();
    EXPECT_GT(source->GetOutput()->GetNumberOfPolys(), 0);
}

/// An observer of progress ends the work: the output is empty, and nothing is an error.
TEST(GridSource, IsAborted) {
    const Cube cube;
    const NodeField field(cube.grid, cube.second);
    const vtkNew<IsosurfaceSource> source;
    source->SetGrid(cube.grid, field);
    source->SetIsovalue(2.5);
    const vtkNew<vtkCallbackCommand> observer;
    observer->SetCallback([](vtkObject* of, unsigned long, void*, void*) {
        auto* const algorithm = static_cast<vtkAlgorithm*>(of);
        EXPECT_GE(algorithm->GetProgress(), 0);
        EXPECT_LE(algorithm->GetProgress(), 1);
        algorithm->SetAbortExecute(1);
    });
    const unsigned long tag = source->AddObserver(vtkCommand::ProgressEvent, observer);
    EXPECT_NO_THROW(update_source(source));
    EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(), 0);
    source->RemoveObserver(tag);
    source->Modified();
    source->Update();
    EXPECT_GT(source->GetOutput()->GetNumberOfPolys(), 0);
}

}  // namespace
