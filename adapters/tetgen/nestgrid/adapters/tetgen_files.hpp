// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TetGen's files, read into its own structure; included by tetgen.hpp. TetGen's own readers trust
// the counts in a file and stop the program.
//
// Invariants: nothing is allocated that the file cannot hold; every index names a point.
#pragma once

#include <algorithm>

#include <tetgen.h>

#include <nestgrid/adapters/tetgen_text.hpp>

namespace nestgrid::detail {

/// Points, from a .node file or from the first part of a .poly or .smesh file.
inline void read_points(TetgenText& file, const TetgenText::Row& header, tetgenio& mesh) {
    const int count = file.count(header, 0, "points");
    if (file.integer(header, 1, 2, 3, 3) != 3) throw file.error("points must have 3 coordinates");
    mesh.pointlist = new double[3 * static_cast<std::size_t>(count)];
    mesh.numberofpoints = count;
    for (int i = 0; i < count; ++i) {
        const auto row = file.row("point " + std::to_string(i + mesh.firstnumber), 4);
        if (i == 0) mesh.firstnumber = file.integer(row, 0, 0, 1, 0);
        if (row[0] != i + mesh.firstnumber) throw file.error("points must be numbered in order");
        std::copy_n(&row[1], 3, mesh.pointlist + 3 * static_cast<std::ptrdiff_t>(i));
    }
}

inline void read_node_file(const std::string& path, tetgenio& mesh) {
    TetgenText file(path);
    const auto header = file.row("the number of points");
    read_points(file, header, mesh);
}

/// Numbers 1 ... count of a row as points of the mesh.
inline int* read_indices(const TetgenText& file, const TetgenText::Row& row, int count,
                         const tetgenio& mesh, int* out) {
    for (int k = 1; k <= count; ++k) {
        *out++ = file.integer(row, static_cast<std::size_t>(k), mesh.firstnumber,
                              mesh.firstnumber + mesh.numberofpoints - 1, 0);
    }
    return out;
}

inline void read_ele_file(const std::string& path, tetgenio& mesh) {
    TetgenText file(path);
    const auto header = file.row("the number of tetrahedra");
    const int count = file.count(header, 0, "tetrahedra");
    const int nodes = file.integer(header, 1, 4, 10, 4);
    if (nodes != 4 && nodes != 10) throw file.error("tetrahedra must have 4 or 10 nodes");
    const auto size = static_cast<std::size_t>(nodes);
    int* out = mesh.tetrahedronlist = new int[static_cast<std::size_t>(count) * size];
    mesh.numberoftetrahedra = count;
    mesh.numberofcorners = nodes;
    for (int i = 0; i < count; ++i) {
        const auto row = file.row("tetrahedron " + std::to_string(i + mesh.firstnumber), size + 1);
        out = read_indices(file, row, nodes, mesh, out);
    }
}

/// \param row starts with the number of corners
inline void read_polygon(TetgenText& file, TetgenText::Row row, const std::string& facet,
                         const tetgenio& plc, tetgenio::polygon& polygon) {
    const int count = file.count(row, 0, "corners of " + facet);
    if (count == 0) throw file.error(facet + " has a polygon without corners");
    file.read_row(row, "corners of " + facet, static_cast<std::size_t>(count) + 1);
    polygon.vertexlist = new int[static_cast<std::size_t>(count)];
    polygon.numberofvertices = count;
    read_indices(file, row, count, plc, polygon.vertexlist);
}

/// Places in holes: number, then coordinates.
inline double* read_places(TetgenText& file, int count, const std::string& what) {
    std::vector<double> places;
    for (int i = 0; i < count; ++i) {
        const auto row = file.row(what + " " + std::to_string(i + 1), 4);
        places.insert(places.end(), row.begin() + 1, row.begin() + 4);
    }
    auto* list = new double[places.size()];
    std::copy(places.begin(), places.end(), list);
    return list;
}

/// A piecewise linear complex; its facets get the marks 1, 2, ...
/// \param simple a .smesh file: every facet is one polygon
inline void read_plc_file(const std::string& path, bool simple, tetgenio& plc) {
    TetgenText file(path);
    const auto header = file.row("the number of points");
    if (file.integer(header, 0, 0, 0x7FFFFFFF, 0) > 0) {
        read_points(file, header, plc);
    } else {
        read_node_file(path.substr(0, path.rfind('.')) + ".node", plc);
    }
    const int facets = file.count(file.row("the number of facets"), 0, "facets");
    plc.facetlist = new tetgenio::facet[static_cast<std::size_t>(facets)];
    plc.facetmarkerlist = new int[static_cast<std::size_t>(facets)];
    plc.numberoffacets = facets;
    for (int i = 0; i < facets; ++i) {
        tetgenio::init(&plc.facetlist[i]);
        plc.facetmarkerlist[i] = i + 1;
    }
    for (int i = 0; i < facets; ++i) {
        const std::string name = "facet " + std::to_string(i + 1);
        const auto row = file.row(name);
        const int polygons = simple ? 1 : file.count(row, 0, "polygons of " + name);
        tetgenio::facet& facet = plc.facetlist[i];
        facet.polygonlist = new tetgenio::polygon[static_cast<std::size_t>(polygons)];
        facet.numberofpolygons = polygons;
        for (int k = 0; k < polygons; ++k) tetgenio::init(&facet.polygonlist[k]);
        for (int k = 0; k < polygons; ++k) {
            read_polygon(file, simple ? row : file.row("polygons of " + name), name, plc,
                         facet.polygonlist[k]);
        }
        const int holes = simple ? 0 : file.count(row, 1, "holes of " + name);
        if (holes > 0) {
            facet.holelist = read_places(file, holes, "hole in " + name);
            facet.numberofholes = holes;
        }
    }
    plc.numberofholes = file.count(file.row("the number of holes"), 0, "holes");
    plc.holelist = read_places(file, plc.numberofholes, "hole");
}

}  // namespace nestgrid::detail
