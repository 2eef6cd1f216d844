// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces as CGAL::Surface_mesh, filled while they are extracted.
#pragma once

#include <string>

#include <CGAL/Surface_mesh.h>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// A sink (surface.hpp) of a CGAL::Surface_mesh with points of any kernel. Normals become the
/// vertex property "v:normal"; attributes are not kept.
template <class SurfacePoint>
class SurfaceMeshSink final : public MeshSink<3> {
public:
    using Mesh = CGAL::Surface_mesh<SurfacePoint>;

    /// \param mesh is added to; it must have no removed elements
    explicit SurfaceMeshSink(Mesh& mesh)
        : mesh_{&mesh}, first_{static_cast<std::uint32_t>(mesh.number_of_vertices())} {}

    /// \throw GridError where a triangle would make the mesh non-manifold
    void take(const Surface<3>& part) override {
        for (const Point& x : part.vertices) mesh_->add_vertex(SurfacePoint(x[0], x[1], x[2]));
        for (const auto& [a, b, c] : part.simplices) {
            if (mesh_->add_face(handle(a), handle(b), handle(c)) == Mesh::null_face()) {
                throw GridError("a triangle would make the surface non-manifold");
            }
        }
    }
    Point position(std::uint32_t vertex) const override {
        const SurfacePoint& p = mesh_->point(handle(vertex));
        return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
    }
    void set_normals(std::span<const Point> normals) override {
        using Vector = typename CGAL::Kernel_traits<SurfacePoint>::Kernel::Vector_3;
        const auto to =
            mesh_->template add_property_map<typename Mesh::Vertex_index, Vector>("v:normal").first;
        for (std::uint32_t v = 0; v < normals.size(); ++v) {
            to[handle(v)] = Vector(normals[v][0], normals[v][1], normals[v][2]);
        }
    }

private:
    typename Mesh::Vertex_index handle(std::uint32_t vertex) const {
        return typename Mesh::Vertex_index(first_ + vertex);
    }

    Mesh* mesh_;
    std::uint32_t first_;
};

}  // namespace nestgrid
