// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/merge_across.hpp>

#include <map>
#include <numeric>

#include <ranks/agreement.hpp>
#include <ranks/clusters.hpp>
#include <ranks/surface_parts.hpp>
#include <ranks/vertex_copies.hpp>
#include <surfaces/merge_at_nodes.hpp>

namespace nestgrid::engine {

namespace {

class MergeAcross {
public:
    MergeAcross(Surface<3>& piece, VerticesAtNodes& at_nodes, std::vector<KeyPair>& names,
                const SharedNodes& shared)
        : piece_{piece},
          at_nodes_{at_nodes},
          names_{names},
          shared_{shared},
          ranks_{shared.ranks()} {}

    void run() {
        together(&shared_, "merging at nodes", [&] { begin(); });
        const std::vector<VertexCopy> copies = find_copies<3>(ranks_, piece_.simplices, names_);
        share_places(copies);
        const Clusters clusters(ranks_, piece_, at_nodes_, copies);
        Outbox parts(ranks_.size());
        together(&shared_, "merging at nodes", [&] { take_away(clusters, parts); });
        JoinedParts joined(stride_);
        parts.send(ranks_, [&](int rank, Reader& in) { joined.add(rank, in); });
        Outbox merged(ranks_.size());
        together(&shared_, "merging at nodes", [&] {
            joined.merge();
            joined.give_back(merged);
            merge_rest();
        });
        merged.send(ranks_, [&](int, Reader& in) { put_back(in); });
        finish();
    }

private:
    void begin();
    void share_places(std::span<const VertexCopy> copies);
    void take_away(const Clusters& clusters, Outbox& parts);
    void merge_rest();
    void put_back(Reader& in);
    void finish();
    void drop_unused();

    Surface<3>& piece_;
    VerticesAtNodes& at_nodes_;
    std::vector<KeyPair>& names_;
    const SharedNodes& shared_;
    Ranks& ranks_;
    std::size_t stride_ = 0;                  // attributes of a vertex
    std::vector<std::uint32_t> element_of_;   // of each simplex that was drawn
    KeyTable<KeyPair, std::uint32_t> known_;  // vertices by name, of triangles that were taken away
};

/// Simplices have their own number in the place of their element until finish().
void MergeAcross::begin() {
    element_of_.swap(piece_.element_of);
    piece_.element_of.resize(piece_.simplices.size());
    std::iota(piece_.element_of.begin(), piece_.element_of.end(), 0U);
    if (!piece_.vertices.empty()) stride_ = piece_.attributes.size() / piece_.vertices.size();
}

/// Tells which vertices are at nodes: where an element adopts the contour of finer ones, these know
/// it alone.
void MergeAcross::share_places(std::span<const VertexCopy> copies) {
    std::vector<std::uint32_t> entry(piece_.vertices.size(), dropped);
    for (std::uint32_t i = 0; i < at_nodes_.vertex.size(); ++i) entry[at_nodes_.vertex[i]] = i;
    const auto attributes = [&](std::uint32_t i) {
        return std::span(at_nodes_.attributes).subspan(i * stride_, stride_);
    };
    tell_copies(
        ranks_, copies, [&](std::uint32_t v) { return entry[v] != dropped; },
        [&](Bytes& out, std::uint32_t v) {
            put(out, at_nodes_.node[entry[v]]);
            for (const double a : attributes(entry[v])) put(out, a);
        },
        [&](std::uint32_t v, Reader& in, int) {
            const auto node = in.get<NodePlace>();
            std::vector<double> of_node(stride_);
            for (double& a : of_node) a = in.get<double>();
            if (entry[v] != dropped) return;
            entry[v] = static_cast<std::uint32_t>(at_nodes_.vertex.size());
            at_nodes_.add(v, node, of_node);
        });
}

/// Takes the triangles of clusters that several ranks have out of the piece.
void MergeAcross::take_away(const Clusters& clusters, Outbox& parts) {
    const PartSource source(piece_, names_, at_nodes_, stride_);
    std::map<int, PartWriter> writers;
    RanksOfSides rank_of;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < piece_.simplices.size(); ++t) {
        const auto v = piece_.simplices[t];
        const int rank = clusters.rank_of(v);
        if (rank == Clusters::here) {
            piece_.element_of[kept] = piece_.element_of[t];
            piece_.simplices[kept++] = v;
            continue;
        }
        writers.try_emplace(rank, source).first->second.add_triangle(v, piece_.element_of[t]);
        for (const std::uint32_t k : v) known_.insert(names_[k], k);
        if (!piece_.boundary.empty()) rank_of.add(v, rank);
    }
    piece_.simplices.resize(kept);
    piece_.element_of.resize(kept);
    std::erase_if(piece_.boundary, [&](const Surface<3>::Ridge& ridge) {
        const int* const rank = rank_of.find(ridge);
        if (rank != nullptr) writers.at(*rank).add_boundary(ridge);
        return rank != nullptr;
    });
    for (auto& [rank, writer] : writers) writer.write(parts.to(rank));
}

/// Merges the clusters that this rank alone has.
void MergeAcross::merge_rest() {
    const std::vector<std::uint32_t> number = merge_at_nodes(piece_, at_nodes_);
    if (number.empty()) return;
    std::vector<KeyPair> names(piece_.vertices.size());
    KeyTable<KeyPair, std::uint32_t> known;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] == dropped) continue;
        names[number[v]] = names_[v];
        if (known_.find(names_[v]) != nullptr) known.insert(names_[v], number[v]);
    }
    names_ = std::move(names);
    known_ = std::move(known);
}

/// Adds what became of triangles that were taken away.
void MergeAcross::put_back(Reader& in) {
    const PartReader part(in, stride_);
    std::vector<std::uint32_t> number;
    for (const PartVertex& v : part.vertices) {
        const auto next = static_cast<std::uint32_t>(piece_.vertices.size());
        const auto [known, is_new] = known_.insert(v.name, next);
        number.push_back(*known);
        if (!is_new) continue;
        piece_.vertices.push_back(v.x);
        piece_.attributes.insert(piece_.attributes.end(), v.attributes.begin(), v.attributes.end());
        names_.push_back(v.name);
    }
    for (const NumberedTriangle& t : part.triangles) {
        piece_.simplices.push_back({number[t.v[0]], number[t.v[1]], number[t.v[2]]});
        piece_.element_of.push_back(t.from);
    }
    for (const auto& [a, b] : part.boundary) piece_.boundary.push_back({number[a], number[b]});
}

/// Brings the triangles into the order in which they were drawn, and drops vertices of none.
void MergeAcross::finish() {
    std::vector<std::uint32_t> order(piece_.simplices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t t) { return piece_.element_of[t]; });
    std::vector<Surface<3>::Simplex> simplices;
    std::vector<std::uint32_t> element_of;
    for (const std::uint32_t t : order) {
        simplices.push_back(piece_.simplices[t]);
        if (!element_of_.empty()) element_of.push_back(element_of_[piece_.element_of[t]]);
    }
    piece_.simplices = std::move(simplices);
    piece_.element_of = std::move(element_of);
    drop_unused();
}

void MergeAcross::drop_unused() {
    std::vector<std::uint32_t> number(piece_.vertices.size(), dropped);
    for (const auto& simplex : piece_.simplices) {
        for (const std::uint32_t v : simplex) number[v] = 0;
    }
    std::uint32_t next = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] == dropped) continue;
        number[v] = next;
        piece_.vertices[next] = piece_.vertices[v];
        names_[next] = names_[v];
        std::copy_n(piece_.attributes.data() + v * stride_, stride_,
                    piece_.attributes.data() + next * stride_);
        ++next;
    }
    piece_.vertices.resize(next);
    names_.resize(next);
    piece_.attributes.resize(next * stride_);
    for (auto& simplex : piece_.simplices) {
        for (std::uint32_t& v : simplex) v = number[v];
    }
    for (auto& ridge : piece_.boundary) {
        for (std::uint32_t& v : ridge) v = number[v];
    }
}

}  // namespace

void merge_at_nodes_across(Surface<3>& piece, VerticesAtNodes& at_nodes,
                           std::vector<KeyPair>& names, const SharedNodes& shared) {
    MergeAcross(piece, at_nodes, names, shared).run();
}

}  // namespace nestgrid::engine
