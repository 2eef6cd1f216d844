// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces as OpenMesh meshes, filled while they are extracted.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// A sink (surface.hpp) of an OpenMesh triangle mesh. Normals are requested where they are asked
/// for; attributes are not kept.
template <class Mesh>
class OpenMeshSink {
public:
    /// \param mesh is added to
    explicit OpenMeshSink(Mesh& mesh)
        : mesh_{&mesh}, first_{static_cast<std::uint32_t>(mesh.n_vertices())} {}

    void add_vertex(const Point& x, std::span<const double>) { mesh_->add_vertex(vector(x)); }
    Point position(std::uint32_t vertex) const {
        const auto& p = mesh_->point(handle(vertex));
        return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    }
    template <class Element>
    void add_element(const Element&, Shape, int) {}
    /// \throw GridError where the triangle would make the mesh non-manifold
    void add_simplex(const std::array<std::uint32_t, 3>& v, std::span<const Point>) {
        if (!mesh_->add_face(handle(v[0]), handle(v[1]), handle(v[2])).is_valid()) {
            throw GridError("a triangle would make the surface non-manifold");
        }
    }
    void add_boundary(const std::array<std::uint32_t, 2>&) {}
    void set_normal(std::uint32_t vertex, const Point& n) {
        if (!mesh_->has_vertex_normals()) mesh_->request_vertex_normals();
        mesh_->set_normal(handle(vertex), vector(n));
    }

private:
    static typename Mesh::Point vector(const Point& x) {
        using Scalar = typename Mesh::Scalar;
        return {static_cast<Scalar>(x[0]), static_cast<Scalar>(x[1]), static_cast<Scalar>(x[2])};
    }
    OpenMesh::VertexHandle handle(std::uint32_t vertex) const {
        return OpenMesh::VertexHandle(static_cast<int>(first_ + vertex));
    }

    Mesh* mesh_;
    std::uint32_t first_;
};

}  // namespace nestgrid
