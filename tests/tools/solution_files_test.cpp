// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Solutions of higher degree in files, written by deal.II and by VTK, read by the program: what it
// draws is what the library draws of the same numbers in place. VTK's own filter beside it.
#include <deal.II/base/function_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/vector_tools.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <unistd.h>
#include <vtkCleanPolyData.h>
#include <vtkContourFilter.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/adapters/vtk_cells.hpp>
#include <nestgrid/algorithms/high_order.hpp>

#include "../adapters/lagrange_meshes.hpp"
#include "closedness.hpp"

using namespace nestgrid_test;

namespace {

namespace fs = std::filesystem;

constexpr double tolerance = 0.05;

struct Folder {
    fs::path path = fs::temp_directory_path() / ("nestgrid_solutions_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
};

Surface<3> surface_in(vtkPolyData* data) {
    Surface<3> surface;
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
        data->GetPoint(i, surface.vertices.emplace_back().data());
    }
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    for (data->GetPolys()->InitTraversal(); data->GetPolys()->GetNextCell(count, corners) != 0;) {
        surface.simplices.push_back(
            {std::uint32_t(corners[0]), std::uint32_t(corners[1]), std::uint32_t(corners[2])});
    }
    return surface;
}

/// What the program draws of a file.
Surface<3> drawn_by_program(const fs::path& file, double isovalue, double error) {
    const fs::path out = file.parent_path() / "out.vtp";
    const std::string command = std::string(NESTGRID_PROGRAM) + " isosurface " + file.string() +
                                " --field u --value " + std::to_string(isovalue) + " --error " +
                                std::to_string(error) + " -o " + out.string() + " > " +
                                (file.parent_path() / "said").string();
    EXPECT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(*-env33-c,cert-*)
    const vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(out.c_str());
    reader->Update();
    return surface_in(reader->GetOutput());
}

void expect_same(const Surface<3>& from_file, const Surface<3>& in_place, double rounding) {
    ASSERT_EQ(from_file.simplices, in_place.simplices);
    double off = 0;
    for (std::size_t i = 0; i < from_file.vertices.size(); ++i) {
        off = std::max(off, norm(from_file.vertices[i] - in_place.vertices[i]));
    }
    EXPECT_LE(off, rounding);
}

/// Edges with one triangle that do not lie on the boundary of the unit cube.
std::size_t edges_inside(const Surface<3>& surface) {
    std::map<std::array<std::uint32_t, 2>, int> count;
    for (const auto& t : surface.simplices) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
            ++count[{a, b}];
        }
    }
    std::size_t open = 0;
    for (const auto& [edge, triangles] : count) {
        bool outside = false;
        for (std::size_t d = 0; d < 3; ++d) {
            const double a = surface.vertices[edge[0]][d];
            const double b = surface.vertices[edge[1]][d];
            outside = outside || (a == b && (std::abs(a) < 1e-6 || std::abs(a - 1) < 1e-6)) ||
                      std::max(a, b) < 1e-6 || std::min(a, b) > 1 - 1e-6;
        }
        if (triangles == 1 && !outside) ++open;
    }
    return open;
}

double waves(const Point& x) {
    return std::sin(7 * x[0]) * std::cos(6 * x[1]) + std::sin(6 * x[1]) * std::cos(7 * x[2]) +
           std::sin(6 * x[2]) * std::cos(7 * x[0]);
}

class Waves final : public dealii::Function<3> {
public:
    double value(const dealii::Point<3>& x, unsigned) const override {
        return waves({x[0], x[1], x[2]});
    }
};

/// deal.II's solution in the vector, and its file.
void expect_file_of_dealii(unsigned degree, bool distorted) {
    SCOPED_TRACE("degree " + std::to_string(degree));
    const Folder folder;
    dealii::Triangulation<3> triangulation;
    dealii::GridGenerator::subdivided_hyper_cube(triangulation, 4);
    if (distorted) dealii::GridTools::distort_random(0.2, triangulation, true);
    dealii::DoFHandler<3> dofs(triangulation);
    const dealii::FE_Q<3> fe(degree);
    dofs.distribute_dofs(fe);
    dealii::Vector<double> u(dofs.n_dofs());
    dealii::VectorTools::interpolate(dofs, Waves(), u);
    for (double& value : u) value = double(float(value));  // as the file keeps it
    dealii::DataOut<3> out;
    dealii::DataOutBase::VtkFlags flags;
    flags.write_higher_order_cells = true;
    out.set_flags(flags);
    out.add_data_vector(dofs, u, "u");
    out.build_patches(degree);
    const fs::path file = folder.path / "solution.vtu";
    std::ofstream stream(file);
    out.write_vtu(stream);
    stream.close();

    const DealiiGrid<3> grid(triangulation);
    const DealiiField<3, dealii::Vector<double>> field(grid, dofs, u);
    const HighOrder data(grid, field);
    const VirtualRefinement fine(data, {.tolerance = tolerance});
    const auto in_place = isosurface<3>(fine, 0.3, under(fine.criterion(), fine.bounds()));
    const Surface<3> read = drawn_by_program(file, 0.3, tolerance);
    EXPECT_GT(read.simplices.size(), 2000U);
    EXPECT_EQ(edges_inside(read), 0U);
    std::printf("deal.II, degree %u: %zu triangles from the file, %zu in place\n", degree,
                read.simplices.size(), in_place.surface.simplices.size());
    expect_same(read, in_place.surface, 1e-4);
}

TEST(SolutionFiles, OfDealiiAreDrawnAsInPlace) {
    for (const unsigned degree : {2U, 3U, 4U}) {
        expect_file_of_dealii(degree, false);
        expect_file_of_dealii(degree, true);
    }
}

/// |U - isovalue| at 15 points of every triangle of a surface in a box of n^3 cells.
double measured_error(const Surface<3>& surface, const LagrangeField<3>& field, int n,
                      double isovalue) {
    double greatest = 0;
    for (const auto& t : surface.simplices) {
        for (int i = 0; i <= 4; ++i) {
            for (int j = 0; i + j <= 4; ++j) {
                const Point x = (i / 4.0) * surface.vertices[t[0]] +
                                (j / 4.0) * surface.vertices[t[1]] +
                                ((4 - i - j) / 4.0) * surface.vertices[t[2]];
                std::array<Point, 1> in{};
                std::uint32_t cell = 0;
                for (std::size_t d = 3; d-- > 0;) {
                    const double scaled = std::clamp(x[d] * n, 0.0, n - 1e-12);
                    cell = cell * std::uint32_t(n) + std::uint32_t(scaled);
                    in[0][d] = scaled - std::floor(scaled);
                }
                std::array<double, 1> u{};
                field.evaluate(cell, in, u);
                greatest = std::max(greatest, std::abs(u[0] - isovalue));
            }
        }
    }
    return greatest;
}

void expect_file_of_vtk(int degree, bool own_points, int mode) {
    SCOPED_TRACE("degree " + std::to_string(degree));
    const Folder folder;
    constexpr int n = 4;
    const Mesh mesh = lagrange_box(3, n, degree, {.own_points = own_points});
    vtkNew<vtkUnstructuredGrid> unstructured;
    to_vtk(mesh, *unstructured);
    add_values(*unstructured, "u", waves);
    add_values(*unstructured, "x", [](const Point& x) { return x[0]; });
    const fs::path file = folder.path / "solution.vtu";
    const vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName(file.c_str());
    writer->SetInputData(unstructured);
    writer->SetDataMode(mode);
    ASSERT_EQ(writer->Write(), 1);

    const LagrangeGrid<3> grid(mesh.arrays());
    const std::vector<double> values = mesh.sampled(waves);
    const LagrangeField<3> field(grid, values);
    const HighOrder data(grid, field);
    const VirtualRefinement fine(data, {.tolerance = tolerance});
    const auto in_place = isosurface<3>(fine, 0.3, under(fine.criterion(), fine.bounds()));
    const Surface<3> read = drawn_by_program(file, 0.3, tolerance);
    EXPECT_EQ(edges_inside(read), 0U);
    expect_same(read, in_place.surface, 1e-6);
    const double error = measured_error(read, field, n, 0.3);
    EXPECT_LE(error, tolerance * (1 + 1e-6));

    unstructured->GetPointData()->SetActiveScalars("u");
    const vtkNew<vtkContourFilter> contour;
    contour->SetInputData(unstructured);
    contour->SetValue(0, 0.3);
    const vtkNew<vtkCleanPolyData> clean;
    clean->SetInputConnection(contour->GetOutputPort());
    const vtkNew<vtkTriangleFilter> triangles;
    triangles->SetInputConnection(clean->GetOutputPort());
    triangles->PassLinesOff();
    triangles->PassVertsOff();
    triangles->Update();
    const Surface<3> others = surface_in(triangles->GetOutput());
    std::printf(
        "degree %d, %s points: nestgrid %zu triangles, 0 open edges, error %.4f; "
        "vtkContourFilter %zu triangles, %zu open edges, error %.4f\n",
        degree, own_points ? "own" : "shared", read.simplices.size(), error,
        others.simplices.size(), edges_inside(others), measured_error(others, field, n, 0.3));
}

/// Hexahedra as VTK numbered them before its version 9: two vertical edges change places.
TEST(SolutionFiles, OfOlderVersionsAreTurned) {
    const Folder folder;
    const int degree = 3;
    const auto m = static_cast<std::int64_t>(degree - 1);
    Mesh mesh = lagrange_box(3, 2, degree, {});
    const Mesh now = mesh;
    for (std::size_t c = 0; c < mesh.types.size(); ++c) {
        const auto edges = mesh.points.begin() + mesh.first[c] + 8 + 10 * m;
        std::swap_ranges(edges, edges + m, edges + m);
    }
    ASSERT_NE(mesh.points, now.points);
    vtkNew<vtkUnstructuredGrid> unstructured;
    to_vtk(mesh, *unstructured);
    add_values(*unstructured, "u", waves);
    const fs::path file = folder.path / "solution.vtu";
    const vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName(file.c_str());
    writer->SetInputData(unstructured);
    writer->SetDataModeToBinary();
    writer->Write();
    std::ifstream written(file);
    std::string text{std::istreambuf_iterator<char>(written), {}};
    const std::size_t version = text.find("version=\"", text.find("<VTKFile"));
    ASSERT_NE(version, std::string::npos);
    text.replace(version, text.find('"', version + 9) + 1 - version, "version=\"1.0\"");
    std::ofstream(file) << text;

    const LagrangeGrid<3> grid(now.arrays());
    const std::vector<double> values = now.sampled(waves);
    const LagrangeField<3> field(grid, values);
    const HighOrder data(grid, field);
    const VirtualRefinement fine(data, {.tolerance = tolerance});
    expect_same(drawn_by_program(file, 0.3, tolerance),
                isosurface<3>(fine, 0.3, under(fine.criterion(), fine.bounds())).surface, 1e-6);
}

TEST(SolutionFiles, OfVtkAreDrawnAsInPlace) {
    expect_file_of_vtk(2, false, vtkXMLWriter::Ascii);
    expect_file_of_vtk(3, true, vtkXMLWriter::Binary);
    expect_file_of_vtk(4, false, vtkXMLWriter::Appended);
    expect_file_of_vtk(4, true, vtkXMLWriter::Appended);
}

}  // namespace
