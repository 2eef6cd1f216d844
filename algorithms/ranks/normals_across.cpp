// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/normals_across.hpp>

#include <algorithm>
#include <tuple>

#include <ranks/agreement.hpp>
#include <surfaces/settle_normals.hpp>

namespace nestgrid::engine {

void SharedGradients::sum_up(const SharedNodes& shared, NodeGradients& sums) {
    Outbox box(shared.ranks().size());
    for (const Term& term : terms_) {
        shared.route(std::span(&term.node, 1), box, [&](Bytes& out, int) {
            put(out, term.node);
            put(out, term.gradient);
            put(out, static_cast<std::uint8_t>(term.place.size()));
            for (const char step : term.place) put(out, step);
        });
    }
    shared.send(box, [&](int, Reader& in) {
        while (in.more()) {
            const auto node = in.get<NodeKey>();
            const auto gradient = in.get<CornerGradient>();
            WalkPlace place(in.get<std::uint8_t>(), '\0');
            for (char& step : place) step = in.get<char>();
            if (shared.is_shared(node)) terms_.push_back({node, std::move(place), gradient});
        }
    });
    std::ranges::sort(terms_, [](const Term& a, const Term& b) {
        return std::tie(a.node, a.place) < std::tie(b.node, b.place);
    });
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        const auto slot = sums.slot(terms_[i].node);
        if (i == 0 || terms_[i - 1].node != terms_[i].node) sums.forget(slot);
        sums.add(slot, terms_[i].gradient);
    }
}

void share_normals(Ranks& ranks, std::span<const VertexCopy> copies, std::span<std::uint8_t> known,
                   std::span<Point> normals) {
    const std::vector<std::uint8_t> own(known.begin(), known.end());
    tell_copies(
        ranks, copies, [&](std::uint32_t v) { return own[v] > 0; },
        [&](Bytes& out, std::uint32_t v) {
            put(out, own[v]);
            put(out, normals[v]);
        },
        [&](std::uint32_t v, Reader& in, int) {
            const auto there = in.get<std::uint8_t>();
            const auto normal = in.get<Point>();
            if (there <= known[v]) return;
            known[v] = there;
            normals[v] = normal;
        });
}

void settle_normals_across(Ranks& ranks, std::span<const VertexCopy> copies,
                           std::span<const std::array<std::uint32_t, 3>> triangles,
                           std::span<const Point> x, std::vector<Point>& normals) {
    Outbox box(ranks.size());
    for (const auto& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            auto copy = std::ranges::lower_bound(copies, t[k], {}, &VertexCopy::vertex);
            for (; copy != copies.end() && copy->vertex == t[k]; ++copy) {
                Bytes& out = box.to(copy->rank);
                put(out, copy->there);
                put(out, static_cast<std::uint8_t>(k));
                put(out, x[t[(k + 1) % 3]]);
                put(out, x[t[(k + 2) % 3]]);
            }
        }
    }
    std::vector<Point> at(x.begin(), x.end());
    std::vector<std::array<std::uint32_t, 3>> all(triangles.begin(), triangles.end());
    box.send(ranks, [&](int, Reader& in) {
        while (in.more()) {
            const auto next = static_cast<std::uint32_t>(at.size());
            const auto vertex = in.get<std::uint32_t>();
            // In the order of the corners as drawn: rounding depends on it.
            const std::size_t k = in.get<std::uint8_t>();
            auto& triangle = all.emplace_back();
            triangle[k] = vertex;
            triangle[(k + 1) % 3] = next;
            triangle[(k + 2) % 3] = next + 1;
            at.push_back(in.get<Point>());
            at.push_back(in.get<Point>());
        }
    });
    double extent = extent_of(x);
    std::array<double*, 1> greatest{&extent};
    take_greatest(ranks, greatest);
    const std::size_t own = normals.size();
    normals.resize(at.size(), Point{0, 0, 0});
    settle_normals(all, at, normals, extent);
    normals.resize(own);
}

}  // namespace nestgrid::engine
