// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/vertex_copies.hpp>

#include <algorithm>
#include <tuple>

#include <surfaces/triangle_sides.hpp>

namespace nestgrid::engine {

namespace {

/// By vertex: whether it is an end of an edge that one triangle alone has.
std::vector<bool> at_open_edges(std::span<const std::array<std::uint32_t, 3>> triangles,
                                std::size_t vertices) {
    std::vector<bool> open(vertices, false);
    const std::vector<OrientedSide> sides = sorted_sides(triangles);
    for_each_edge(sides, [&](std::span<const OrientedSide> edge) {
        if (edge.size() == 1) open[edge[0].low] = open[edge[0].high] = true;
    });
    return open;
}

/// By vertex: whether one segment alone has it.
std::vector<bool> at_open_edges(std::span<const std::array<std::uint32_t, 2>> all,
                                std::size_t vertices) {
    std::vector<std::uint8_t> segments(vertices, 0);
    for (const auto& segment : all) {
        for (const std::uint32_t v : segment) segments[v] = segments[v] == 0 ? 1 : 2;
    }
    std::vector<bool> open;
    for (const std::uint8_t count : segments) open.push_back(count == 1);
    return open;
}

struct Holder {
    int rank;
    std::uint32_t vertex;
};

/// Which ranks have a vertex with a name.
using Holders = KeyTable<KeyPair, std::vector<Holder>>;

void answer(const Holders& all, Outbox& box) {
    all.for_each([&](const KeyPair&, const std::vector<Holder>& holders) {
        for (const Holder& to : holders) {
            for (const Holder& other : holders) {
                if (other.rank != to.rank) {
                    put(box.to(to.rank), VertexCopy{to.vertex, other.rank, other.vertex});
                }
            }
        }
    });
}

}  // namespace

template <std::size_t corners>
std::vector<VertexCopy> find_copies(Ranks& ranks,
                                    std::span<const std::array<std::uint32_t, corners>> simplices,
                                    std::span<const KeyPair> names) {
    const std::vector<bool> open = at_open_edges(simplices, names.size());
    Outbox question(ranks.size());
    for (std::uint32_t v = 0; v < names.size(); ++v) {
        if (!open[v]) continue;
        const auto home = hash(names[v]) % static_cast<std::uint64_t>(ranks.size());
        Bytes& out = question.to(static_cast<int>(home));
        put(out, names[v]);
        put(out, v);
    }
    Holders holders;
    question.send(ranks, [&](int rank, Reader& in) {
        while (in.more()) {
            const auto name = in.get<KeyPair>();
            holders.insert(name, {}).first->push_back({rank, in.get<std::uint32_t>()});
        }
    });
    Outbox told(ranks.size());
    answer(holders, told);
    std::vector<VertexCopy> copies;
    told.send(ranks, [&](int, Reader& in) {
        while (in.more()) copies.push_back(in.get<VertexCopy>());
    });
    std::sort(copies.begin(), copies.end(), [](const VertexCopy& a, const VertexCopy& b) {
        return std::tie(a.vertex, a.rank) < std::tie(b.vertex, b.rank);
    });
    return copies;
}

template std::vector<VertexCopy> find_copies(Ranks&, std::span<const std::array<std::uint32_t, 2>>,
                                             std::span<const KeyPair>);
template std::vector<VertexCopy> find_copies(Ranks&, std::span<const std::array<std::uint32_t, 3>>,
                                             std::span<const KeyPair>);

}  // namespace nestgrid::engine
