// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The vertices of a piece of a surface that other ranks have in theirs, too.
//
// A surface is a manifold. So around a vertex that two pieces have, none has all triangles, and the
// vertex is an end of an edge that one triangle of the piece alone has. Ranks tell the names of
// these to homes, that find out who has the same ones. Nobody needs to know who has which nodes.
#pragma once

#include <nestgrid/algorithms/join_pieces.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <ranks/wire.hpp>

namespace nestgrid::engine {

/// The name of a vertex between no nodes, as the one of `rank` with this number.
inline KeyPair own_name(int rank, std::uint32_t number) {
    constexpr NodeKey last = ~NodeKey{0};
    return {last - static_cast<NodeKey>(rank), last - (NodeKey{1} << 32U) - number};
}

/// Collective, two exchanges.
/// \param simplices of the piece: triangles or segments
/// \param names of the vertices, the same on all ranks
/// \return in the order of vertices and, for each, of ranks
template <std::size_t corners>
std::vector<VertexCopy> find_copies(Ranks& ranks,
                                    std::span<const std::array<std::uint32_t, corners>> simplices,
                                    std::span<const KeyPair> names);

/// Calls write(bytes, vertex) for each copy of each vertex, and take(vertex, reader, rank) for what
/// other ranks wrote. Collective.
/// \param tells whether a vertex has anything to tell
template <class Tells, class Write, class Take>
void tell_copies(Ranks& ranks, std::span<const VertexCopy> copies, Tells&& tells, Write&& write,
                 Take&& take) {
    Outbox box(ranks.size());
    for (const VertexCopy& copy : copies) {
        if (!tells(copy.vertex)) continue;
        Bytes& out = box.to(copy.rank);
        put(out, copy.there);
        write(out, copy.vertex);
    }
    box.send(ranks, [&](int rank, Reader& in) {
        while (in.more()) {
            const auto vertex = in.get<std::uint32_t>();
            take(vertex, in, rank);
        }
    });
}

}  // namespace nestgrid::engine
