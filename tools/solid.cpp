// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLPolyDataReader.h>

#include <nestgrid/adapters/cgal_domain.hpp>
#include <nestgrid/adapters/openmesh.hpp>

#include "child_process.hpp"
#include "coarse_file.hpp"
#include "end_checks.hpp"
#include "input_file.hpp"
#include "vtk_errors.hpp"

namespace {

namespace fs = std::filesystem;
namespace Processing = CGAL::Polygon_mesh_processing;
using nestgrid::CoarseGrid;
using nestgrid::InvalidInput;
using nestgrid::IoError;
using nestgrid::Point;
using CgalPoint = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<CgalPoint>;

/// The triangles of a VTK file; polygons and strips are divided.
CoarseGrid read_vtp(const fs::path& path) {
    const std::string name = "'" + path.string() + "'";
    const vtkNew<vtkXMLPolyDataReader> reader;
    const vtkNew<ErrorCollector> errors;
    reader->AddObserver(vtkCommand::ErrorEvent, errors);
    reader->AddObserver(vtkCommand::WarningEvent, errors);
    if (reader->CanReadFile(path.c_str()) == 0) throw IoError(name + " is no VTK poly data file");
    check_xml_end(path);
    reader->SetFileName(path.c_str());
    const vtkNew<vtkTriangleFilter> filter;
    filter->SetInputConnection(reader->GetOutputPort());
    filter->PassVertsOff();
    filter->PassLinesOff();
    filter->Update();
    if (!errors->message.empty()) throw IoError(name + " cannot be read: " + errors->message);
    vtkPolyData* const surface = filter->GetOutput();
    CoarseGrid grid;
    grid.dimension = 2;
    std::vector<Point> points(static_cast<std::size_t>(surface->GetNumberOfPoints()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        surface->GetPoint(static_cast<vtkIdType>(i), points[i].data());
    }
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    vtkCellArray* const cells = surface->GetPolys();
    for (cells->InitTraversal(); cells->GetNextCell(count, corners) != 0;) {
        std::vector<std::uint32_t> loop;
        for (vtkIdType i = 0; i < count; ++i) {
            if (corners[i] < 0 || corners[i] >= surface->GetNumberOfPoints()) {
                throw InvalidInput(name + " has a face that names a point which is not there");
            }
            loop.push_back(static_cast<std::uint32_t>(corners[i]));
        }
        grid.add_loop(loop);
    }
    grid.nodes = nestgrid::Coordinates(std::move(points));
    return grid;
}

/// \throw nestgrid::IoError for a file that cannot be read
CoarseGrid read_faces(const fs::path& path) {
    const std::string name = "'" + path.string() + "'";
    require_file(path);
    const std::string ending = ending_of(path);
    std::error_code error;
    constexpr std::array known{".off", ".obj", ".ply", ".stl", ".vtp"};
    if (std::ranges::find(known, ending) == known.end()) {
        throw IoError(name + " is no .off, .obj, .ply, .stl or .vtp");
    }
    return read_grid_apart(name, reading_time(fs::file_size(path, error)), [&] {
        return ending == ".vtp" ? read_vtp(path) : nestgrid::read_surface(path.string());
    });
}

/// The triangles of a grid, each three numbers of nodes.
std::vector<std::vector<std::size_t>> triangles_of(const CoarseGrid& grid) {
    std::vector<std::vector<std::size_t>> triangles;
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        const auto of = grid.element(e);
        triangles.push_back({of[0], of[1], of[of.size() - 1]});
        if (of.size() == 4) triangles.push_back({of[0], of[3], of[2]});
    }
    return triangles;
}

/// \throw nestgrid::InvalidInput for a coordinate that is no finite number
std::vector<CgalPoint> points_of(const CoarseGrid& grid) {
    std::vector<CgalPoint> points;
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
        const Point x = grid.nodes[i];
        for (const double coordinate : x) {
            if (!std::isfinite(coordinate)) {
                throw InvalidInput("a coordinate of the surface is no finite number");
            }
        }
        points.emplace_back(x[0], x[1], x[2]);
    }
    return points;
}

using Points = std::vector<CgalPoint>;
using Triangles = std::vector<std::vector<std::size_t>>;

Mesh mesh_of(const Points& points, const Triangles& triangles) {
    Mesh mesh;
    Processing::polygon_soup_to_polygon_mesh(points, triangles, mesh);
    return mesh;
}

/// Joins triangles at the points that they name, or, where this does not close the surface,
/// whatever their orientation at points with equal coordinates.
Mesh join(Points points, Triangles triangles) {
    if (Processing::is_polygon_soup_a_polygon_mesh(triangles)) {
        Mesh mesh = mesh_of(points, triangles);
        if (CGAL::is_closed(mesh)) return mesh;
    }
    Processing::repair_polygon_soup(points, triangles,
                                    CGAL::parameters::erase_all_duplicates(true));
    Processing::orient_polygon_soup(points, triangles);
    Mesh mesh = mesh_of(points, triangles);
    Processing::stitch_borders(mesh);
    return mesh;
}

}  // namespace

nestgrid::Distance read_solid(const fs::path& path) {
    try {
        const CoarseGrid faces = read_faces(path);
        const auto mesh = std::make_shared<const Mesh>(join(points_of(faces), triangles_of(faces)));
        const nestgrid::CgalSolid<CgalPoint> solid(*mesh);
        if (Processing::does_self_intersect(*mesh)) {
            throw InvalidInput("the surface of a solid intersects or touches itself");
        }
        return [mesh, solid](const Point& x) { return solid(x); };
    } catch (const InvalidInput& error) {
        throw InvalidInput("'" + path.string() + "': " + error.what());
    }
}
