// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/join_lines.hpp>

#include <nestgrid/detail/union_find.hpp>
#include <ranks/connected_parts.hpp>

namespace nestgrid::engine {

namespace {

/// Segments that gather on this rank, with their vertices by name.
class GatheredSegments {
public:
    explicit GatheredSegments(std::size_t attributes) : attributes_{attributes} {}

    void add(Reader& in) {
        Surface<2>::Simplex segment;
        for (std::uint32_t& v : segment) v = vertex(in);
        surface_.simplices.push_back(segment);
    }
    /// Writes a vertex as vertex() reads it.
    static void write(Bytes& out, const KeyPair& name, const Surface<2>& of, std::uint32_t v,
                      std::size_t attributes) {
        put(out, name);
        put(out, of.vertices[v]);
        for (std::size_t c = 0; c < attributes; ++c) put(out, of.attributes[v * attributes + c]);
    }
    Surface<2> take() { return std::move(surface_); }

private:
    std::uint32_t vertex(Reader& in) {
        const auto next = static_cast<std::uint32_t>(surface_.vertices.size());
        const auto [number, is_new] = number_.insert(in.get<KeyPair>(), next);
        const auto x = in.get<Point>();
        if (is_new) surface_.vertices.push_back(x);
        for (std::size_t c = 0; c < attributes_; ++c) {
            const auto value = in.get<double>();
            if (is_new) surface_.attributes.push_back(value);
        }
        return *number;
    }

    std::size_t attributes_;
    Surface<2> surface_;
    KeyTable<KeyPair, std::uint32_t> number_;
};

/// By vertex: the part of the segments that it belongs to, by its least vertex.
std::vector<std::uint32_t> parts_of(const Surface<2>& segments) {
    nestgrid::detail::UnionFind classes(segments.vertices.size());
    for (const auto& [from, to] : segments.simplices) classes.join(from, to);
    std::vector<std::uint32_t> part;
    for (std::uint32_t v = 0; v < segments.vertices.size(); ++v) part.push_back(classes.root(v));
    return part;
}

}  // namespace

void join_lines(Surface<2>& segments, std::span<const std::array<NodeKey, 2>> names,
                const SharedNodes& shared) {
    Ranks& ranks = shared.ranks();
    std::vector<KeyPair> named;
    for (const auto& [a, b] : names) named.emplace_back(a, b);
    const auto copies = find_copies(ranks, std::span(std::as_const(segments.simplices)), named);
    const std::vector<std::uint32_t> part = parts_of(segments);
    const ConnectedParts wholes(
        ranks, copies, [](std::uint32_t) { return true; }, part);
    std::uint64_t most =
        segments.vertices.empty() ? 0 : segments.attributes.size() / segments.vertices.size();
    ranks.reduce(std::span(&most, 1), Ranks::Reduction::max);
    const auto attributes = static_cast<std::size_t>(most);
    Outbox box(ranks.size());
    for (const auto& segment : segments.simplices) {
        const int* const rank = wholes.least_rank(part[segment[0]]);
        Bytes& out = box.to(rank == nullptr ? ranks.rank() : *rank);
        for (const std::uint32_t v : segment) {
            GatheredSegments::write(out, named[v], segments, v, attributes);
        }
    }
    GatheredSegments gathered(attributes);
    box.send(ranks, [&](int, Reader& in) {
        while (in.more()) gathered.add(in);
    });
    segments = gathered.take();
}

}  // namespace nestgrid::engine
