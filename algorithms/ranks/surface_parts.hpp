// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Some triangles of a surface, as ranks send them to each other.
#pragma once

#include <nestgrid/detail/key_table.hpp>
#include <ranks/wire.hpp>
#include <surfaces/collinear_triangles.hpp>
#include <surfaces/surface_builder.hpp>

namespace nestgrid::engine {

/// A surface from which triangles are sent. All is borrowed.
struct PartSource {
    const Surface<3>* surface;
    std::span<const KeyPair> names;  ///< of the vertices, the same on all ranks
    const VerticesAtNodes* at_nodes;
    std::size_t stride;                ///< attributes of a vertex
    std::vector<std::uint32_t> entry;  ///< by vertex: its place in at_nodes, or none

    PartSource(const Surface<3>& of, std::span<const KeyPair> named, const VerticesAtNodes& at,
               std::size_t attributes);
};

class PartWriter {
public:
    explicit PartWriter(const PartSource& source) : source_{&source} {}

    /// \param from a number of the triangle
    void add_triangle(const Surface<3>::Simplex& v, std::uint32_t from);
    void add_boundary(const Surface<3>::Ridge& v);
    void write(Bytes& out) const;

private:
    std::uint32_t number_of(std::uint32_t vertex);

    const PartSource* source_;
    KeyTable<std::uint32_t, std::uint32_t> number_;
    std::uint32_t vertex_count_ = 0;
    Bytes vertices_;
    std::vector<NumberedTriangle> triangles_;
    std::vector<Surface<3>::Ridge> boundary_;
};

struct PartVertex {
    KeyPair name;
    Point x;
    bool at_node;
    NodePlace node;
    std::vector<double> attributes;
    std::vector<double> of_node;  ///< attributes at the node
};

/// What a PartWriter wrote.
struct PartReader {
    PartReader(Reader& in, std::size_t stride);

    std::vector<PartVertex> vertices;
    std::vector<NumberedTriangle> triangles;
    std::vector<Surface<3>::Ridge> boundary;
};

/// To which rank triangles go, by their sides.
class RanksOfSides {
public:
    void add(const Surface<3>::Simplex& v, int rank) {
        for (std::size_t k = 0; k < 3; ++k) rank_.insert({v[k], v[(k + 1) % 3]}, rank);
    }
    const int* find(const Surface<3>::Ridge& side) const { return rank_.find({side[0], side[1]}); }

private:
    KeyTable<KeyPair, int> rank_;
};

/// Parts from several ranks, as one surface.
class JoinedParts {
public:
    explicit JoinedParts(std::size_t stride) : stride_{stride} {}

    void add(int rank, Reader& in);
    void merge();
    /// Writes what became of the triangles of each rank.
    void give_back(Outbox& box) const;

private:
    struct Origin {
        int rank;
        std::uint32_t from;
    };

    std::size_t stride_;
    Surface<3> surface_;  // element_of: the numbers of origins
    VerticesAtNodes at_nodes_;
    std::vector<KeyPair> names_;
    std::vector<Origin> origins_;
    KeyTable<KeyPair, std::uint32_t> number_of_;
    std::vector<bool> is_at_node_;
};

}  // namespace nestgrid::engine
