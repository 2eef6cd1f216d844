// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pieces of a surface that ranks have drawn, as parts of one indexed surface: global numbers of
// vertices, who owns them, and what the whole surface is like (docs/distributed.md).
#pragma once

#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>

namespace nestgrid {

/// A vertex of a piece that another rank has in its own piece, too.
struct VertexCopy {
    std::uint32_t vertex;  ///< its number in this piece
    int rank;              ///< the other rank
    std::uint32_t there;   ///< its number in that rank's piece
};

/// A piece as a part of the whole surface. All totals are the same on all ranks.
struct JoinedPiece {
    /// By vertex of the piece: its number in the whole. Vertices that one rank owns are numbered
    /// one behind the other, ranks in their order.
    std::vector<std::uint64_t> number;
    std::vector<int> owner;          ///< by vertex: the least rank that has it
    std::vector<VertexCopy> copies;  ///< in the order of vertices and, for each, of ranks
    int ranks = 1;                   ///< that have pieces, or might have

    std::uint64_t first_vertex = 0;   ///< the number of the first vertex that this rank owns
    std::uint64_t first_simplex = 0;  ///< how many triangles (segments) lesser ranks have
    std::uint64_t vertices = 0;       ///< in all
    std::uint64_t simplices = 0;      ///< in all
    std::uint64_t components = 0;     ///< connected parts of the whole
    /// By triangle (segment) of the piece: its connected part. Parts are numbered in the order of
    /// their least vertices.
    std::vector<std::uint64_t> component_of;
    /// Parts with an edge (point) of one triangle (segment) alone, in their order.
    std::vector<std::uint64_t> not_closed;
    /// Edges (of plane grids: points) of one triangle (segment) alone, beside those on the boundary
    /// of the domain: 0 where all pieces are there.
    std::uint64_t open = 0;
    std::uint64_t on_boundary = 0;  ///< edges (points) of one alone, on the boundary of the domain
};

namespace detail {

template <int dimension>
JoinedPiece join_pieces(const Surface<dimension>& piece,
                        std::span<const std::array<NodeKey, 2>> names,
                        const engine::SharedNodes& shared);
SurfaceMeasurement measure_pieces(const Surface<3>& piece, const JoinedPiece& joined,
                                  const engine::SharedNodes& shared);
std::vector<double> flux_of_pieces(const Surface<3>& piece, const JoinedPiece& joined,
                                   const engine::SharedNodes& shared, std::size_t first);

}  // namespace detail

/// Numbers the vertices of the pieces of a surface. Collective.
/// \param piece as it was drawn on the grid: an Isosurface, a slice or a Shading
///
/// \throw InvalidInput, on all ranks alike, where a piece has other vertices than those drawn, or
///        was drawn into a sink
template <class Grid, class Piece>
JoinedPiece join_pieces(const Piece& piece, const Distributed<Grid>& grid) {
    return detail::join_pieces(piece.surface, piece.names, *grid.shared_nodes());
}

/// Measures the whole triangle surface, component by component: what measure_surface() says of the
/// surface of one process, to the last bit, but in the order of JoinedPiece's components.
/// Collective, one exchange and one gathering of the measures.
/// \param joined as join_pieces() numbered the piece
/// \return the same on all ranks, but that `component_of` is of the triangles of the piece
///
/// \throw InvalidInput, on all ranks alike, where a piece is not the one that was joined
template <class Grid, class Piece>
SurfaceMeasurement measure_pieces(const Piece& piece, const JoinedPiece& joined,
                                  const Distributed<Grid>& grid) {
    return detail::measure_pieces(piece.surface, joined, *grid.shared_nodes());
}

/// Flux of a vector field through each component of the whole, out of U >= C, as flux().
/// Collective, as measure_pieces().
///
/// \throw InvalidInput, on all ranks alike, where there are not so many attributes, or a piece is
///        not the one that was joined
template <class Grid, class Piece>
std::vector<double> flux_of_pieces(const Piece& piece, const JoinedPiece& joined,
                                   const Distributed<Grid>& grid, std::size_t first = 0) {
    return detail::flux_of_pieces(piece.surface, joined, *grid.shared_nodes(), first);
}

}  // namespace nestgrid
