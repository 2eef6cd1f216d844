// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Level sets as indexed meshes, and what else takes a level set while it is extracted.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <nestgrid/detail/elements.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid {

/// An indexed level set: triangles in three dimensions, segments in two.
/// Oriented: the normal (for segments, the right-hand side) points to where U is below the
/// isovalue, so the region U >= C has positive volume when the surface is closed.
template <int dimension>
struct Surface {
    using Simplex = std::array<std::uint32_t, static_cast<std::size_t>(dimension)>;
    using Ridge = std::array<std::uint32_t, static_cast<std::size_t>(dimension - 1)>;

    std::vector<Point> vertices;
    std::vector<Point> normals;      ///< unit length, one per vertex, where asked for
    std::vector<double> attributes;  ///< by vertex: components of the field; isosurfaces: 1 ...
    std::vector<Simplex> simplices;
    std::vector<std::uint32_t> element_of;  ///< per simplex, an index into elements
    std::vector<Point> reference;           ///< per corner of a simplex, where asked for: where it
                                            ///< lies in the reference element
    Elements elements;                      ///< the extracted elements, in traversal order
    std::vector<Shape> shape_of;            ///< shape of each of them
    std::vector<std::uint16_t> level_of;    ///< level of each of them
    std::vector<Ridge> boundary;            ///< edges (points) on the boundary of the domain

    /// Empties the surface and keeps its memory.
    void clear();
    std::size_t memory_bytes() const;
};

/// Takes an indexed surface in parts while it is extracted.
template <int dimension>
class MeshSink {
public:
    virtual ~MeshSink() = default;

    /// Takes the next part. Vertices are numbered over all parts in the order they come; simplices
    /// and boundary name them by these numbers. `element_of` counts the elements of the part.
    /// Normals come at the end, by set_normals().
    virtual void take(const Surface<dimension>& part) = 0;
    /// The position of a vertex that was taken.
    virtual Point position(std::uint32_t vertex) const = 0;
    /// Whether parts are to tell the elements that simplices come from.
    virtual bool keeps_elements() const { return false; }
    /// Unit normals of all vertices, where asked for.
    virtual void set_normals(std::span<const Point> /*normals*/) {}

protected:
    MeshSink() = default;
    MeshSink(const MeshSink&) = default;
    MeshSink& operator=(const MeshSink&) = default;
    MeshSink(MeshSink&&) noexcept = default;
    MeshSink& operator=(MeshSink&&) noexcept = default;
};

/// Triangles (segments) as they lie in the memory of a walk.
struct SimplexBatch {
    const double* positions;  ///< three coordinates of each point
    std::size_t stride;       ///< numbers from one point to the next
    /// Corners, as numbers of points; a segment has two.
    std::span<const std::array<std::uint16_t, 3>> simplices;

    const double* at(std::uint16_t point) const { return positions + point * stride; }
};

/// Takes triangles (segments) in parts while they are extracted, without connections between
/// elements; nothing is kept but what coarse elements beside finer ones are drawn from.
template <int dimension>
class SimplexSink {
public:
    virtual ~SimplexSink() = default;

    /// Takes the next part. Simplices name the vertices, and `element_of` counts the elements, of
    /// the part. Elements share no vertices, so that one may come several times.
    virtual void take(const Surface<dimension>& part) = 0;
    /// Takes the next part without the detour through a Surface, where takes_batches().
    virtual void take_batch(const SimplexBatch& /*batch*/) {}
    /// Whether the sink also takes batches; not where it keeps elements or attributes.
    virtual bool takes_batches() const { return false; }
    /// Whether parts are to tell the elements that simplices come from.
    virtual bool keeps_elements() const { return false; }

protected:
    SimplexSink() = default;
    SimplexSink(const SimplexSink&) = default;
    SimplexSink& operator=(const SimplexSink&) = default;
    SimplexSink(SimplexSink&&) noexcept = default;
    SimplexSink& operator=(SimplexSink&&) noexcept = default;
};

/// Keeps the corners of every triangle (segment) behind each other: what a renderer takes.
/// \tparam Real float or double
template <int dimension, class Real>
class SimplexSoup final : public SimplexSink<dimension> {
public:
    using Simplex = std::array<Real, 3 * static_cast<std::size_t>(dimension)>;

    /// \param target to which they are added; borrowed
    explicit SimplexSoup(std::vector<Simplex>& target) : target_{&target} {}

    void take(const Surface<dimension>& part) override {
        const std::size_t first = target_->size();
        target_->resize(first + part.simplices.size());
        Simplex* to = target_->data() + first;
        for (const auto& corners : part.simplices) {
            for (std::size_t i = 0; i < corners.size(); ++i) {
                const Point& x = part.vertices[corners[i]];
                for (std::size_t d = 0; d < 3; ++d) (*to)[3 * i + d] = static_cast<Real>(x[d]);
            }
            ++to;
        }
    }
    bool takes_batches() const override { return true; }
    void take_batch(const SimplexBatch& batch) override {
        for (const auto& corners : batch.simplices) {
            Simplex simplex;
            for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) {
                const double* const x = batch.at(corners[i]);
                for (std::size_t d = 0; d < 3; ++d) simplex[3 * i + d] = static_cast<Real>(x[d]);
            }
            target_->push_back(simplex);
        }
    }

private:
    std::vector<Simplex>* target_;
};

/// Hands every triangle (segment) to a function and keeps nothing.
template <int dimension>
class SimplexStream final : public SimplexSink<dimension> {
public:
    using Simplex = std::array<Point, static_cast<std::size_t>(dimension)>;

    explicit SimplexStream(std::function<void(const Simplex&)> function)
        : function_{std::move(function)} {}

    void take(const Surface<dimension>& part) override {
        Simplex corners;
        for (const auto& simplex : part.simplices) {
            for (std::size_t i = 0; i < corners.size(); ++i) {
                corners[i] = part.vertices[simplex[i]];
            }
            function_(corners);
        }
    }

private:
    std::function<void(const Simplex&)> function_;
};

}  // namespace nestgrid
