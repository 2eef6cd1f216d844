// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces from OpenMesh, whose half-edges hold triangles and quadrilaterals in loops.
#pragma once

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <OpenMesh/Core/Utils/vector_traits.hh>

#include <nestgrid/adapters/coarse.hpp>

namespace nestgrid {

/// The faces of any TriMesh or PolyMesh whose points are three doubles or floats. The coordinates
/// stay in the mesh, which must outlive the grid and keep its vertices.
///
/// OpenMesh cannot hold an edge of three faces: its own readers give such a face vertices of its
/// own, which check_and_orient() then reports as duplicate; read_surface() shows the edge itself.
/// \throw InvalidInput for other polygons, and for a mesh with deleted elements in it
template <class Mesh>
CoarseGrid coarse_from_openmesh(const Mesh& mesh) {
    using Traits = OpenMesh::vector_traits<typename Mesh::Point>;
    static_assert(Traits::size_ == 3, "coarse_from_openmesh needs points of three coordinates.");
    static_assert(sizeof(typename Mesh::Point) % sizeof(typename Traits::value_type) == 0);
    const auto refuse_deleted = [&](auto handles, bool has_status) {
        for (const auto handle : handles) {
            if (has_status && mesh.status(handle).deleted()) {
                throw InvalidInput(
                    "the mesh still holds deleted elements; call garbage_collection() first");
            }
        }
    };
    refuse_deleted(mesh.all_vertices(), mesh.has_vertex_status());
    refuse_deleted(mesh.all_faces(), mesh.has_face_status());

    CoarseGrid grid;
    grid.dimension = 2;
    if (mesh.n_vertices() > 0) {
        grid.nodes =
            Coordinates::borrow(&(*mesh.points())[0], mesh.n_vertices(),
                                sizeof(typename Mesh::Point) / sizeof(typename Traits::value_type));
    }
    std::vector<std::uint32_t> loop;
    for (const auto face : mesh.all_faces()) {
        loop.clear();
        for (const auto v : mesh.fv_range(face)) {
            loop.push_back(static_cast<std::uint32_t>(v.idx()));
        }
        grid.add_loop(loop);
    }
    return grid;
}

}  // namespace nestgrid
