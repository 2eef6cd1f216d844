// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/join_pieces.hpp>

#include <algorithm>
#include <set>

#include <nestgrid/detail/union_find.hpp>
#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>
#include <ranks/component_sums.hpp>
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

/// Numbers connected parts: those of the piece, joined by copies of vertices. The rank that has the
/// least vertex of a whole numbers it, and tells the others.
template <int dimension>
void number_components(Ranks& ranks, const Surface<dimension>& piece, JoinedPiece& joined) {
    nestgrid::detail::UnionFind classes(piece.vertices.size());
    for (const auto& v : piece.simplices) {
        for (std::size_t k = 1; k < v.size(); ++k) classes.join(v[0], v[k]);
    }
    std::vector<std::uint32_t> part;
    for (std::uint32_t v = 0; v < piece.vertices.size(); ++v) part.push_back(classes.root(v));
    const ConnectedParts across(
        ranks, joined.copies, [](std::uint32_t) { return true; }, part);
    std::vector<bool> stands;  // by vertex: whether it is the least of a whole
    for (std::uint32_t v = 0; v < part.size(); ++v) {
        const int* const least = across.least_rank(v);
        stands.push_back(part[v] == v && (least == nullptr || *least == ranks.rank()));
    }
    for (const ConnectedParts::Member& member : across.of_own_wholes()) {
        if (member.other.rank == ranks.rank()) stands[member.other.number] = false;
    }
    const auto own = static_cast<std::uint64_t>(std::ranges::count(stands, true));
    const Before before = count_before(ranks, own);
    joined.components = before.all;
    Numbers number(part.size());
    std::uint64_t next = before.lesser;
    for (std::uint32_t v = 0; v < part.size(); ++v) {
        if (stands[v]) number[v] = next++;
    }
    Outbox box(ranks.size());
    for (const ConnectedParts::Member& member : across.of_own_wholes()) {
        Bytes& out = box.to(member.other.rank);
        put(out, member.other.number);
        put(out, number[member.whole]);
    }
    box.send(ranks, [&](int, Reader& in) {
        while (in.more()) {
            const auto root = in.get<std::uint32_t>();
            number[root] = in.get<std::uint64_t>();
        }
    });
    for (const auto& v : piece.simplices) joined.component_of.push_back(number[part[v[0]]]);
}

/// A ridge that one simplex of a piece alone has.
template <class Ends>
struct LooseRidge {
    Ends ends;
    std::uint64_t component;
    std::uint64_t on_boundary;  ///< 1, else 0
};

/// Counts the ridges that one simplex alone has. Those of one simplex of a piece go to homes.
template <int dimension>
void count_open(Ranks& ranks, const Surface<dimension>& piece, JoinedPiece& joined) {
    using Ends = std::array<std::uint64_t, static_cast<std::size_t>(dimension - 1)>;
    using Ridge = LooseRidge<Ends>;
    const auto global = [&](auto ridge) {
        Ends named;
        for (std::size_t k = 0; k < named.size(); ++k) named[k] = joined.number[ridge[k]];
        std::ranges::sort(named);
        return named;
    };
    std::set<Ends> boundary;
    for (const auto& ridge : piece.boundary) boundary.insert(global(ridge));
    std::vector<Ridge> all;
    for (std::size_t s = 0; s < piece.simplices.size(); ++s) {
        const auto& v = piece.simplices[s];
        for (std::size_t k = 0; k < v.size(); ++k) {
            typename Surface<dimension>::Ridge ridge;
            for (std::size_t i = 0; i < ridge.size(); ++i) ridge[i] = v[(k + i) % v.size()];
            all.push_back({global(ridge), joined.component_of[s], 0});
        }
    }
    // Calls take(ridge) for those that occur once.
    const auto for_each_loose = [](std::vector<Ridge>& ridges, const auto& take) {
        std::ranges::sort(ridges, {}, &Ridge::ends);
        for (std::size_t i = 0; i < ridges.size();) {
            const std::size_t first = i;
            while (i < ridges.size() && ridges[i].ends == ridges[first].ends) ++i;
            if (i - first == 1) take(ridges[first]);
        }
    };
    Outbox box(ranks.size());
    for_each_loose(all, [&](Ridge& ridge) {
        const auto home =
            nestgrid::detail::mix64(ridge.ends[0]) % static_cast<std::uint64_t>(ranks.size());
        ridge.on_boundary = boundary.contains(ridge.ends) ? 1 : 0;
        put(box.to(static_cast<int>(home)), ridge);
    });
    std::vector<Ridge> at_home;
    box.send(ranks, [&](int, Reader& in) {
        while (in.more()) at_home.push_back(in.get<Ridge>());
    });
    std::array<std::uint64_t, 2> counts{};
    std::set<std::uint64_t> not_closed;
    for_each_loose(at_home, [&](const Ridge& ridge) {
        ++counts[ridge.on_boundary != 0 ? 1 : 0];
        not_closed.insert(ridge.component);
    });
    ranks.reduce(counts, Ranks::Reduction::sum);
    joined.open = counts[0];
    joined.on_boundary = counts[1];
    Bytes told;
    for (const std::uint64_t component : not_closed) put(told, component);
    for (const Bytes& of_rank : ranks.gather(std::move(told))) {
        for (Reader in(of_rank); in.more();) not_closed.insert(in.get<std::uint64_t>());
    }
    joined.not_closed.assign(not_closed.begin(), not_closed.end());
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
    number_components(ranks, surface, joined);
    count_open(ranks, surface, joined);
    return joined;
}

/// \return how many attributes a vertex has, also of a piece without any
std::size_t agree_on_pieces(const Surface<3>& piece, const JoinedPiece& joined,
                            const SharedNodes& shared, const std::string& asked) {
    together(&shared, asked.c_str(), [&] {
        if (joined.number.size() != piece.vertices.size() ||
            joined.component_of.size() != piece.simplices.size()) {
            throw InvalidInput("join_pieces() numbered another piece than is measured");
        }
    });
    std::uint64_t attributes =
        piece.vertices.empty() ? 0 : piece.attributes.size() / piece.vertices.size();
    shared.ranks().reduce(std::span(&attributes, 1), Ranks::Reduction::max);
    return static_cast<std::size_t>(attributes);
}

SurfaceMeasurement measure_all(const Surface<3>& piece, const JoinedPiece& joined,
                               const SharedNodes& shared) {
    const std::size_t terms =
        first_integral + agree_on_pieces(piece, joined, shared, "the measures of a surface");
    Point origin = origin_of(piece);
    for (double& along : origin) along = -along;
    std::array<double*, 3> each{&origin[0], &origin[1], &origin[2]};
    take_greatest(shared.ranks(), each);
    for (double& along : origin) along = -along;
    const std::vector<double> sums = sum_up(
        shared.ranks(), joined, terms,
        [&](std::size_t t, std::span<double> out) { measure_triangle(piece, t, origin, out); });
    SurfaceMeasurement result;
    for (std::size_t c = 0; c <= static_cast<std::size_t>(joined.components); ++c) {
        result.components.push_back(measures_of(std::span(sums).subspan(c * terms, terms)));
    }
    for (const std::uint64_t c : joined.not_closed) {
        result.components[static_cast<std::size_t>(c)].closed = false;
    }
    result.total = std::move(result.components.back());
    result.total.closed = joined.not_closed.empty();
    result.components.pop_back();
    for (const std::uint64_t c : joined.component_of) {
        result.component_of.push_back(static_cast<std::uint32_t>(c));
    }
    return result;
}

std::vector<double> flux_through_pieces(const Surface<3>& piece, const JoinedPiece& joined,
                                        const SharedNodes& shared, std::size_t first) {
    const std::size_t attributes =
        agree_on_pieces(piece, joined, shared,
                        "the flux of attributes from number " + std::to_string(first) + " on");
    if (joined.simplices > 0) require_vector(attributes, first);
    std::vector<double> result =
        sum_up(shared.ranks(), joined, 1, [&](std::size_t t, std::span<double> out) {
            out[0] = flux_through(piece, t, attributes, first);
        });
    result.pop_back();
    return result;
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

SurfaceMeasurement measure_pieces(const Surface<3>& piece, const JoinedPiece& joined,
                                  const engine::SharedNodes& shared) {
    return engine::measure_all(piece, joined, shared);
}

std::vector<double> flux_of_pieces(const Surface<3>& piece, const JoinedPiece& joined,
                                   const engine::SharedNodes& shared, std::size_t first) {
    return engine::flux_through_pieces(piece, joined, shared, first);
}

template JoinedPiece join_pieces(const Surface<2>&, std::span<const std::array<NodeKey, 2>>,
                                 const engine::SharedNodes&);
template JoinedPiece join_pieces(const Surface<3>&, std::span<const std::array<NodeKey, 2>>,
                                 const engine::SharedNodes&);

}  // namespace nestgrid::detail
