// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What OpenMesh's readers fill instead of half-edges; included by openmesh_files.hpp.
//
// Invariants: faces name vertices that are there; nothing is larger than the file can hold.
#pragma once

#include <optional>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <nestgrid/adapters/coarse.hpp>

namespace nestgrid::detail {

/// The mesh that OpenMesh's own importer wants; it stays empty.
struct EmptyMesh {
    using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;
    Mesh mesh;
};

/// Takes points and faces; everything else ends in the empty mesh, which has no properties.
class SurfaceImporter : private EmptyMesh, public OpenMesh::IO::ImporterT<EmptyMesh::Mesh> {
public:
    using Point = nestgrid::Point;
    using ImporterT<Mesh>::add_face;

    /// \param bytes size of the file
    SurfaceImporter(std::string path, std::size_t bytes)
        : ImporterT<Mesh>(mesh), path_{std::move(path)}, bytes_{bytes} {
        grid.dimension = 2;
    }

    void reserve(unsigned vertices, unsigned, unsigned faces) override {
        if (vertices > bytes_ || faces > bytes_) throw truncated();
        declared_ = {vertices, faces};
    }
    OpenMesh::VertexHandle add_vertex() override { return add({0, 0, 0}); }
    OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f& x) override { return add(point(x)); }
    OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3d& x) override { return add(point(x)); }
    void set_point(OpenMesh::VertexHandle v, const OpenMesh::Vec3f& x) override {
        points.at(static_cast<std::size_t>(v.idx())) = point(x);
    }
    OpenMesh::FaceHandle add_face(const VHandles& loop) override {
        const std::size_t face = grid.element_count();
        if (face >= bytes_) throw truncated();
        corners_.clear();
        for (const auto v : loop) {
            if (v.idx() < 0 || static_cast<std::size_t>(v.idx()) >= points.size()) {
                throw InvalidInput("face " + std::to_string(face) + " of '" + path_ +
                                   "' names a vertex that is not there");
            }
            corners_.push_back(static_cast<std::uint32_t>(v.idx()));
        }
        try {
            grid.add_loop(corners_);
        } catch (const InvalidInput& error) {
            throw InvalidInput("'" + path_ + "': " + error.what());
        }
        return OpenMesh::FaceHandle(static_cast<int>(face));
    }
    void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle,
                            const std::vector<OpenMesh::Vec2f>&) override {}
    void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle,
                            const std::vector<OpenMesh::Vec3f>&) override {}
    std::size_t n_vertices() const override { return points.size(); }
    std::size_t n_faces() const override { return grid.element_count(); }

    /// Whether everything is there that the file declares.
    bool complete() const {
        return !declared_ || *declared_ == std::pair(points.size(), grid.element_count());
    }
    IoError truncated() const {
        IoError result("'" + path_ + "' is truncated or damaged after " +
                       std::to_string(points.size()) + " vertices and " +
                       std::to_string(grid.element_count()) + " faces");
        return result;
    }

    CoarseGrid grid;
    std::vector<Point> points;

private:
    template <class Vector>
    static Point point(const Vector& x) {
        return {double{x[0]}, double{x[1]}, double{x[2]}};
    }
    OpenMesh::VertexHandle add(const Point& x) {
        if (points.size() >= bytes_) throw truncated();
        points.push_back(x);
        return OpenMesh::VertexHandle(static_cast<int>(points.size()) - 1);
    }

    std::string path_;
    std::size_t bytes_;
    std::optional<std::pair<std::size_t, std::size_t>> declared_;  // vertices, faces
    std::vector<std::uint32_t> corners_;
};

}  // namespace nestgrid::detail
