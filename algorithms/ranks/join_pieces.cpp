// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/join_pieces.hpp>

#include <algorithm>
#include <set>

#include <nestgrid/detail/union_find.hpp>
#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>
#include <ranks/connected_parts.hpp>
#include <ranks/vertex_copies.hpp>

namespace nestgrid::engine {

namespace {

using Numbers = std::vector<std::uint64_t>;

/// How many of each the ranks before this one have, and all of them.
struct Before {
    std::uint64_t lesser = 0;
    std::uint64_t all = 0;
};

Before count_before(Ranks& ranks, std::uint64_t own) {
    Bytes told;
    put(told, own);
    Before before;
    const std::vector<Bytes> counts = ranks.gather(std::move(told));
    for (int rank = 0; rank < ranks.size(); ++rank) {
        const auto count = Reader(counts[static_cast<std::size_t>(rank)]).get<std::uint64_t>();
        if (rank < ranks.rank()) before.lesser += count;
        before.all += count;
    }
    return before;
}

/// Numbers the vertices that this rank owns, and asks the owners of others.
void number(Ranks& ranks, JoinedPiece& joined) {
    for (const VertexCopy& copy : joined.copies) {
        int& owner = joined.owner[copy.vertex];
        owner = std::min(owner, copy.rank);
    }
    const auto is_own = [&](std::uint32_t v) { return joined.owner[v] == ranks.rank(); };
    std::uint64_t own = 0;
    for (std::uint32_t v = 0; v < joined.owner.size(); ++v) own += is_own(v) ? 1 : 0;
    const Before before = count_before(ranks, own);
    joined.first_vertex = before.lesser;
    joined.vertices = before.all;
    std::uint64_t next = before.lesser;
    for (std::uint32_t v = 0; v < joined.owner.size(); ++v) {
        if (is_own(v)) joined.number[v] = next++;
    }
    tell_copies(
        ranks, joined.copies, is_own,
        [&](Bytes& out, std::uint32_t v) { put(out, joined.number[v]); },
        [&](std::uint32_t v, Reader& in, int) { joined.number[v] = in.get<std::uint64_t>(); });
}

/// Counts the ridges that one simplex alone has. Those of one simplex of a piece go to homes.
template <int dimension>
void count_open(Ranks& ranks, const Surface<dimension>& piece, JoinedPiece& joined) {
    using Ridge = std::array<std::uint64_t, static_cast<std::size_t>(dimension - 1)>;
    const auto global = [&](auto ridge) {
        Ridge named;
        for (std::size_t k = 0; k < named.size(); ++k) named[k] = joined.number[ridge[k]];
        std::ranges::sort(named);
        return named;
    };
    std::vector<Ridge> all;
    for (const auto& v : piece.simplices) {
        for (std::size_t k = 0; k < v.size(); ++k) {
            typename Surface<dimension>::Ridge ridge;
            for (std::size_t i = 0; i < ridge.size(); ++i) ridge[i] = v[(k + i) % v.size()];
            all.push_back(global(ridge));
        }
    }
    std::ranges::sort(all);
    std::set<Ridge> boundary;
    for (const auto& ridge : piece.boundary) boundary.insert(global(ridge));
    Outbox box(ranks.size());
    for (std::size_t i = 0; i < all.size();) {
        const std::size_t first = i;
        while (i < all.size() && all[i] == all[first]) ++i;
        if (i - first > 1) continue;
        const auto home =
            nestgrid::detail::mix64(all[first][0]) % static_cast<std::uint64_t>(ranks.size());
        Bytes& out = box.to(static_cast<int>(home));
        put(out, all[first]);
        put(out, boundary.contains(all[first]));
    }
    struct Use {
        Ridge ridge;
        bool on_boundary;
    };
    std::vector<Use> uses;
    box.send(ranks, [&](int, Reader& in) {
        while (in.more()) {
            const auto ridge = in.get<Ridge>();
            uses.push_back({ridge, in.get<bool>()});
        }
    });
    std::ranges::sort(uses, {}, &Use::ridge);
    std::array<std::uint64_t, 2> counts{};
    for (std::size_t i = 0; i < uses.size();) {
        const std::size_t first = i;
        bool on_boundary = false;
        for (; i < uses.size() && uses[i].ridge == uses[first].ridge; ++i) {
            on_boundary = on_boundary || uses[i].on_boundary;
        }
        if (i - first == 1) ++counts[on_boundary ? 1 : 0];
    }
    ranks.reduce(counts, Ranks::Reduction::sum);
    joined.open = counts[0];
    joined.on_boundary = counts[1];
}

/// Counts connected parts: those of the piece, less what copies of vertices join.
template <int dimension>
void count_components(Ranks& ranks, const Surface<dimension>& piece, JoinedPiece& joined) {
    nestgrid::detail::UnionFind classes(piece.vertices.size());
    for (const auto& v : piece.simplices) {
        for (std::size_t k = 1; k < v.size(); ++k) classes.join(v[0], v[k]);
    }
    std::vector<std::uint32_t> part;
    std::uint64_t own = 0;
    for (std::uint32_t v = 0; v < piece.vertices.size(); ++v) {
        part.push_back(classes.root(v));
        own += part.back() == v ? 1 : 0;
    }
    const ConnectedParts across(
        ranks, joined.copies, [](std::uint32_t) { return true; }, part);
    std::uint64_t all = own - across.own_less_whole();
    ranks.reduce(std::span(&all, 1), Ranks::Reduction::sum);
    joined.components = all;
}

template <int dimension>
JoinedPiece join(const Surface<dimension>& surface,
                 std::span<const std::array<NodeKey, 2>> vertex_names, const SharedNodes& shared) {
    Ranks& ranks = shared.ranks();
    JoinedPiece joined;
    joined.ranks = ranks.size();
    std::vector<KeyPair> names;
    together(&shared, "the joined pieces of a surface", [&] {
        if (vertex_names.size() != surface.vertices.size()) {
            throw InvalidInput("the piece has " + std::to_string(surface.vertices.size()) +
                               " vertices, but was drawn on ranks with " +
                               std::to_string(vertex_names.size()));
        }
        for (const auto& [a, b] : vertex_names) names.emplace_back(a, b);
        joined.number.resize(names.size());
        joined.owner.assign(names.size(), ranks.rank());
    });
    const std::span<const typename Surface<dimension>::Simplex> simplices = surface.simplices;
    joined.copies = find_copies(ranks, simplices, names);
    number(ranks, joined);
    const Before before = count_before(ranks, simplices.size());
    joined.first_simplex = before.lesser;
    joined.simplices = before.all;
    count_open(ranks, surface, joined);
    count_components(ranks, surface, joined);
    return joined;
}

}  // namespace

}  // namespace nestgrid::engine

namespace nestgrid::detail {

template <int dimension>
JoinedPiece join_pieces(const Surface<dimension>& piece,
                        std::span<const std::array<NodeKey, 2>> names,
                        const engine::SharedNodes& shared) {
    return engine::join(piece, names, shared);
}

template JoinedPiece join_pieces(const Surface<2>&, std::span<const std::array<NodeKey, 2>>,
                                 const engine::SharedNodes&);
template JoinedPiece join_pieces(const Surface<3>&, std::span<const std::array<NodeKey, 2>>,
                                 const engine::SharedNodes&);

}  // namespace nestgrid::detail
