// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/meshes/solid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <boost/iterator/function_output_iterator.hpp>

#include <nestgrid/adapters/cgal_domain.hpp>

#include "input/meshes/mesh_file.hpp"

namespace {

namespace fs = std::filesystem;
namespace Processing = CGAL::Polygon_mesh_processing;
using nestgrid::CoarseGrid;
using nestgrid::InvalidInput;
using nestgrid::Point;
using CgalPoint = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<CgalPoint>;

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

using Kernel = CGAL::Kernel_traits<CgalPoint>::Kernel;

Kernel::Triangle_3 triangle_of(const Mesh& mesh, Mesh::Face_index face) {
    const auto edge = mesh.halfedge(face);
    return {mesh.point(mesh.source(edge)), mesh.point(mesh.target(edge)),
            mesh.point(mesh.target(mesh.next(edge)))};
}

/// Whether one triangle has corners on both sides of the plane of the other, farther from it than a
/// distance. None has where the other one is flatter than that.
bool lies_across(const Kernel::Triangle_3& of, const Kernel::Triangle_3& other, double distance) {
    const auto normal = CGAL::normal(other[0], other[1], other[2]);
    const double length = std::sqrt(normal.squared_length());
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
        longest = std::max(longest, CGAL::squared_distance(other[i], other[i + 1]));
    }
    if (length <= distance * std::sqrt(longest)) return false;
    double least = 0;
    double greatest = 0;
    for (int i = 0; i < 3; ++i) {
        const double height = CGAL::scalar_product(of[i] - other[0], normal) / length;
        least = std::min(least, height);
        greatest = std::max(greatest, height);
    }
    return least < -distance && greatest > distance;
}

/// \throw nestgrid::InvalidInput where triangles go through each other by more than what rounding
/// to single precision does, in which most formats keep them
void refuse_crossings(const Mesh& mesh) {
    double size = 0;
    for (const CgalPoint& x : mesh.points()) {
        for (int axis = 0; axis < 3; ++axis) size = std::max(size, std::abs(x[axis]));
    }
    const double rounding = 4 * size * static_cast<double>(std::numeric_limits<float>::epsilon());
    const auto look = [&](const std::pair<Mesh::Face_index, Mesh::Face_index>& met) {
        const auto first = triangle_of(mesh, met.first);
        const auto second = triangle_of(mesh, met.second);
        if (lies_across(first, second, rounding) && lies_across(second, first, rounding)) {
            throw InvalidInput("the surface of a solid goes through itself");
        }
    };
    Processing::self_intersections(mesh, boost::make_function_output_iterator(look));
}

}  // namespace

nestgrid::Distance read_solid(const fs::path& path) {
    try {
        const CoarseGrid faces = read_mesh(path, {}, std::nullopt, 0).grid;
        if (faces.dimension != 2) throw InvalidInput("the mesh is none of a surface");
        const auto mesh = std::make_shared<const Mesh>(join(points_of(faces), triangles_of(faces)));
        const nestgrid::CgalSolid<CgalPoint> solid(*mesh);
        refuse_crossings(*mesh);
        return [mesh, solid](const Point& x) { return solid(x); };
    } catch (const InvalidInput& error) {
        throw InvalidInput("'" + path.string() + "': " + error.what());
    }
}
