// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces from files, by CGAL's readers of polygon soups. Consequence: no face is lost or torn
// off, so that an edge of three faces and a Moebius strip are there for check_and_orient() to find.
#pragma once

#include <fstream>
#include <iterator>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>

#include <nestgrid/adapters/cgal_formats.hpp>
#include <nestgrid/adapters/coarse.hpp>

namespace nestgrid {

namespace detail {

using SoupPoints = std::vector<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
using SoupFaces = std::vector<std::vector<std::size_t>>;

/// \throw IoError, InvalidInput where a header says that the rest cannot be read
inline std::optional<SurfaceText> surface_text(std::string content, const std::string& ending,
                                               const std::string& name) {
    if (ending == ".off") return off_text(content, name);
    if (ending == ".obj") return obj_text(std::move(content), name);
    if (ending == ".ply") return ply_text(content, name);
    return stl_text(std::move(content));
}

/// \return whether CGAL read all of it
inline bool parse_surface(const std::string& ending, std::istream& stream, SoupPoints& points,
                          SoupFaces& faces) {
    const auto quietly = CGAL::parameters::verbose(false);
    if (ending == ".off") return CGAL::IO::read_OFF(stream, points, faces, quietly);
    if (ending == ".obj") return CGAL::IO::read_OBJ(stream, points, faces, quietly);
    if (ending == ".ply") return CGAL::IO::read_PLY(stream, points, faces, quietly);
    return CGAL::IO::read_STL(stream, points, faces, quietly);
}

/// \throw InvalidInput for a face that names a vertex which is not there, and as add_loop()
inline CoarseGrid grid_of(const SoupPoints& points, const SoupFaces& faces,
                          const std::string& name) {
    CoarseGrid grid;
    grid.dimension = 2;
    std::vector<std::uint32_t> loop;
    for (std::size_t face = 0; face < faces.size(); ++face) {
        loop.clear();
        for (const std::size_t corner : faces[face]) {
            if (corner >= points.size()) {
                throw InvalidInput("face " + std::to_string(face) + " of " + name +
                                   " names a vertex that is not there");
            }
            loop.push_back(static_cast<std::uint32_t>(corner));
        }
        try {
            grid.add_loop(loop);
        } catch (const InvalidInput& error) {
            throw InvalidInput(name + ": " + error.what());
        }
    }
    std::vector<Point> nodes;
    for (const auto& p : points) nodes.push_back({p.x(), p.y(), p.z()});
    grid.nodes = Coordinates(std::move(nodes));
    return grid;
}

}  // namespace detail

/// The triangles and quadrilaterals of a file .off, .obj, .ply or .stl, in the precision of the
/// file. Vertices of an .stl at equal coordinates are one, because the format knows no others.
/// \throw IoError for a file that is missing, empty, truncated or of another format
/// \throw InvalidInput for a surface without faces, with faces of other polygons, and with faces
///        that name a vertex which is not there
inline CoarseGrid read_surface(const std::string& path) {
    const std::string name = "'" + path + "'";
    std::ifstream file(path, std::ios::binary);
    if (!file) throw IoError(name + " cannot be opened");
    std::string content{std::istreambuf_iterator<char>(file), {}};
    if (content.find_first_not_of(" \t\r\n") == std::string::npos) {
        throw IoError(name + " is empty");
    }
    const std::string ending =
        detail::lower_case(path.substr(std::min(path.rfind('.'), path.size())));
    if (ending != ".off" && ending != ".obj" && ending != ".ply" && ending != ".stl") {
        throw IoError(name + " is no .off, .obj, .ply or .stl");
    }
    const std::size_t bytes = content.size();
    detail::SoupPoints points;
    detail::SoupFaces faces;
    // CGAL gives no reason; it refuses an .off also for a face that names no vertex.
    const auto truncated = [&] {
        return IoError(name + " is truncated or damaged" +
                       (ending == ".off" ? ", or a face names a vertex that is not there" : ""));
    };
    const auto text = detail::surface_text(std::move(content), ending, name);
    // CGAL makes room for what is declared.
    if (!text || text->vertices.value_or(0) > bytes || text->faces.value_or(0) > bytes) {
        throw truncated();
    }
    if (text->faces.value_or(0) == 0) throw InvalidInput(name + " has no faces");
    std::istringstream stream(text->content);
    bool parsed = false;
    try {
        parsed = detail::parse_surface(ending, stream, points, faces);
    } catch (const std::bad_alloc&) {
        throw truncated();  // a damaged number of corners
    } catch (const std::length_error&) {
        throw truncated();
    }
    if (!parsed || text->vertices.value_or(points.size()) != points.size() ||
        text->faces.value_or(faces.size()) != faces.size()) {
        throw truncated();
    }
    return detail::grid_of(points, faces, name);
}

}  // namespace nestgrid
