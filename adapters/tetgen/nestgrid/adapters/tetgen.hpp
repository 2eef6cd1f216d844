// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TetGen (AGPL): its tetrahedra as a coarse grid, its files, and its mesher. TetGen keeps globals:
// nothing here but coarse_from_tetgen() may run in two threads at a time.
#pragma once

#include <algorithm>
#include <cctype>

#include <nestgrid/adapters/tetgen_files.hpp>
#include <nestgrid/adapters/tetgen_mesher.hpp>

namespace nestgrid {

/// The tetrahedra of a mesh; of second-order ones the corners. The coordinates stay in pointlist,
/// which must outlive the grid.
/// \throw InvalidInput without tetrahedra, and for corners that are no points, as they seem to be
///        where TetGen's switch z has been used and firstnumber not been set to 0 thereafter
inline CoarseGrid coarse_from_tetgen(const tetgenio& mesh) {
    if (mesh.numberoftetrahedra <= 0) throw InvalidInput("TetGen's mesh has no tetrahedra");
    CoarseGrid grid;
    grid.nodes = Coordinates::borrow(static_cast<const double*>(mesh.pointlist),
                                     static_cast<std::size_t>(mesh.numberofpoints));
    for (std::ptrdiff_t i = 0; i < mesh.numberoftetrahedra; ++i) {
        const int* from = mesh.tetrahedronlist + i * mesh.numberofcorners;
        std::array<std::uint32_t, 4> nodes{};
        for (std::size_t k = 0; k < 4; ++k) {
            const int node = from[k] - mesh.firstnumber;
            if (node < 0 || node >= mesh.numberofpoints) {
                throw InvalidInput("tetrahedron " + std::to_string(i) + " has the corner " +
                                   std::to_string(from[k]) + ", but points are numbered from " +
                                   std::to_string(mesh.firstnumber) + " on");
            }
            nodes[k] = static_cast<std::uint32_t>(node);
        }
        grid.add(Shape::tetrahedron, nodes);
    }
    return grid;
}

/// The tetrahedra of a pair of files .node and .ele, either of which may be named, or those with
/// which TetGen fills the piecewise linear complex of a file .poly or .smesh, holes left out.
/// Regions are not read.
/// \throw IoError for a file that is missing, empty, truncated, or holds what is no number
/// \throw InvalidInput as tetrahedralize()
inline CoarseGrid read_tetgen(const std::string& path, const TetgenOptions& options = {}) {
    const std::size_t dot = std::min(path.rfind('.'), path.size());
    const std::string stem = path.substr(0, dot);
    const std::string given = path.substr(dot);
    std::string ending = given;
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const bool capital = ending != given;
    tetgenio mesh;
    if (ending == ".node" || ending == ".ele") {
        detail::read_node_file(stem + (capital ? ".NODE" : ".node"), mesh);
        detail::read_ele_file(stem + (capital ? ".ELE" : ".ele"), mesh);
        if (mesh.numberoftetrahedra == 0) throw InvalidInput("'" + path + "' has no tetrahedra");
    } else if (ending == ".poly" || ending == ".smesh") {
        tetgenio plc;
        detail::read_plc_file(path, ending == ".smesh", plc);
        try {
            tetrahedralize(plc, mesh, options);
        } catch (const InvalidInput& error) {
            throw InvalidInput("'" + path + "': " + error.what());
        }
    } else {
        throw IoError("'" + path + "' is no .node, .ele, .poly or .smesh");
    }
    CoarseGrid grid = coarse_from_tetgen(mesh);
    std::vector<Point> points(grid.nodes.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = grid.nodes[i];
    grid.nodes = Coordinates(std::move(points));
    return grid;
}

}  // namespace nestgrid
