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
class SurfaceMeshSink {
public:
    using Mesh = CGAL::Surface_mesh<SurfacePoint>;

    /// \param mesh is added to; it must have no removed elements
    explicit SurfaceMeshSink(Mesh& mesh)
        : mesh_{&mesh}, first_{static_cast<std::uint32_t>(mesh.number_of_vertices())} {}

    void add_vertex(const Point& x, std::span<const double>) {
        mesh_->add_vertex(SurfacePoint(x[0], x[1], x[2]));
    }
    Point position(std::uint32_t vertex) const {
        const SurfacePoint& p = mesh_->point(handle(vertex));
        return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
    }
    template <class Element>
    void add_element(const Element&, Shape, int) {}
    /// \throw GridError where the triangle would make the mesh non-manifold
    void add_simplex(const std::array<std::uint32_t, 3>& v, std::span<const Point>) {
        if (mesh_->add_face(handle(v[0]), handle(v[1]), handle(v[2])) == Mesh::null_face()) {
            throw GridError("a triangle would make the surface non-manifold");
        }
    }
    void add_boundary(const std::array<std::uint32_t, 2>&) {}
    void set_normal(std::uint32_t vertex, const Point& n) {
        using Vector = typename CGAL::Kernel_traits<SurfacePoint>::Kernel::Vector_3;
        const auto normals =
            mesh_->template add_property_map<typename Mesh::Vertex_index, Vector>("v:normal").first;
        normals[handle(vertex)] = Vector(n[0], n[1], n[2]);
    }

private:
    typename Mesh::Vertex_index handle(std::uint32_t vertex) const {
        return typename Mesh::Vertex_index(first_ + vertex);
    }

    Mesh* mesh_;
    std::uint32_t first_;
};

}  // namespace nestgrid
