// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkFeatureEdges.h>
#include <vtkSphere.h>

#include <nestgrid/adapters/vtk_boundary_source.hpp>
#include <nestgrid/adapters/vtk_height_field_source.hpp>
#include <nestgrid/adapters/vtk_isoband_source.hpp>
#include <nestgrid/adapters/vtk_isolines_source.hpp>
#include <nestgrid/adapters/vtk_isosurface_source.hpp>
#include <nestgrid/adapters/vtk_slice_source.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>

#include "cut_cube.hpp"
#include "refusal_rows.hpp"
#include "sample_grids.hpp"

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

/// Updates a source, and throws the sentence that it reports, without the name of the source.
void update(vtkAlgorithm* source) {
    std::string text;
    const vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(&text);
    observer->SetCallback([](vtkObject*, unsigned long, void* client, void* said) {
        *static_cast<std::string*>(client) += static_cast<const char*>(said);
    });
    const unsigned long tag = source->AddObserver(vtkCommand::ErrorEvent, observer);
    source->Update();
    source->RemoveObserver(tag);
    const std::size_t begin = text.find("): ");
    if (begin == std::string::npos) return;
    throw InvalidInput(text.substr(begin + 3, text.find('\n', begin) - begin - 3));
}

TEST(Refusals, OfVtkSources) {
    RefusalRows rows("VTK sources");
    const vtkNew<IsosurfaceSource> source;
    rows.add("no grid", [&] { update(source); });
    OctreeGrid<3> grid(hexahedra(1));
    std::vector<double> values(8, std::nan(""));
    const NodeField field(grid, values);
    source->SetGrid(grid, field);
    rows.add("a value that is no number", [&] { update(source); });
    values.assign(8, 1);
    source->InvalidateField();
    EXPECT_NO_THROW(update(source));
    source->SetIsovalue(std::nan(""));
    rows.add("an isovalue that is no number", [&] { update(source); });
    source->SetIsovalue(0.5);
    source->SetIndicator("colour");
    rows.add("an indicator that does not exist", [&] { update(source); });
    source->SetIndicator("offset");
    source->SetCollapse(true);
    rows.add("collapses without a threshold", [&] { update(source); });
    source->SetCollapse(false);
    const vtkNew<IsolinesSource> lines;
    lines->SetGrid(grid, field);
    rows.add("isolines in space", [&] { update(lines); });
    grid.refine_uniformly();
    rows.add("a field from before a refinement", [&] { update(source); });
}

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

double height(const Point& x) { return x[0] + 2 * x[1] - x[2]; }
double bent(const Point& x) { return 3 - x[0] * x[0]; }

/// A refined unit cube, with a linear function and another one.
struct Cube {
    OctreeGrid<3> grid{hexahedra(2)};
    std::vector<double> first;
    std::vector<double> second;

    Cube() {
        refine_at_sphere(grid, 3);
        first = sample_nodes(grid, height);
        second = sample_nodes(grid, bent);
    }
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
    EXPECT_NO_THROW(update(source));
    EXPECT_EQ(source->GetOutput()->GetNumberOfPolys(), 0);
    source->RemoveObserver(tag);
    source->Modified();
    source->Update();
    EXPECT_GT(source->GetOutput()->GetNumberOfPolys(), 0);
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
