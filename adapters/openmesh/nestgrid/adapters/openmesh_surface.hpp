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
class OpenMeshSink final : public MeshSink<3> {
public:
    /// \param mesh is added to
    explicit OpenMeshSink(Mesh& mesh)
        : mesh_{&mesh}, first_{static_cast<std::uint32_t>(mesh.n_vertices())} {}

    /// \throw GridError where a triangle would make the mesh non-manifold
    void take(const Surface<3>& part) override {
        for (const Point& x : part.vertices) mesh_->add_vertex(vector(x));
        for (const auto& [a, b, c] : part.simplices) {
            if (!mesh_->add_face(handle(a), handle(b), handle(c)).is_valid()) {
                throw GridError("a triangle would make the surface non-manifold");
            }
        }
    }
    Point position(std::uint32_t vertex) const override {
        const auto& p = mesh_->point(handle(vertex));
        return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    }
    void set_normals(std::span<const Point> normals) override {
        if (!mesh_->has_vertex_normals()) mesh_->request_vertex_normals();
        for (std::uint32_t v = 0; v < normals.size(); ++v) {
            mesh_->set_normal(handle(v), vector(normals[v]));
        }
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
