// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where a level set cuts edges between nodes of a batch of patches (patch_batch.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include <contours/cut_fraction.hpp>
#include <nestgrid/detail/pack.hpp>
#include <patches/known_bisection.hpp>
#include <surfaces/wide_point.hpp>

namespace nestgrid::engine {

/// Where a level set cuts edges.
struct CutLevel {
    double value;
    double least_fraction;  ///< the least distance from both ends, in lengths of the edge
};

/// An edge between two places of a batch.
struct BatchEdge {
    std::uint16_t low;   ///< the place where U < isovalue
    std::uint16_t high;  ///< the place where U >= isovalue
};

/// The cut of an edge.
/// \param low, high positions of its ends
template <class Batch>
NESTGRID_INLINE WidePoint cut_between(const Batch& batch, const BatchEdge& edge, const Point& low,
                                      const Point& high, const CutLevel& cut) {
    const auto value = [&](std::size_t place) {
        return static_cast<double>(batch.values.all[place]);
    };
    const WidePoint a(low);
    const double fraction = cut_fraction(cut.value, value(edge.low), value(edge.high),
                                         cut.least_fraction, 1 - cut.least_fraction);
    return a + fraction * (WidePoint(high) - a);
}

/// Cuts edges in packs.
/// \param positions positions(pack of nodes) gives their positions
/// \param edges their number is a multiple of doubles_at_once
template <class Batch, class Positions>
NESTGRID_INLINE void cut_in_packs(const Batch& batch, const Positions& positions,
                                  std::span<const BatchEdge> edges, const CutLevel& cut,
                                  WidePoint* to) {
    using Numbers = Pack<double, doubles_at_once>;
    using Nodes = Pack<typename Batch::Node, doubles_at_once>;
    const auto value = Numbers::all(cut.value);
    const auto least = Numbers::all(cut.least_fraction);
    const auto most = Numbers::all(1 - cut.least_fraction);
    for (const BatchEdge* edge = edges.data(); edge != edges.data() + edges.size();
         edge += doubles_at_once, to += doubles_at_once) {
        const auto values = [&](auto end) NESTGRID_INLINE_LAMBDA {
            return Numbers::make([&](auto i) NESTGRID_INLINE_LAMBDA {
                return static_cast<double>(batch.values.all[edge[i].*end]);
            });
        };
        const auto ends = [&](auto end) NESTGRID_INLINE_LAMBDA {
            return positions(Nodes::make(
                [&](auto i) NESTGRID_INLINE_LAMBDA { return batch.nodes.all[edge[i].*end]; }));
        };
        const Numbers fraction =
            cut_fraction(value, values(&BatchEdge::low), values(&BatchEdge::high), least, most);
        const auto low = ends(&BatchEdge::low);
        const auto high = ends(&BatchEdge::high);
        PackedPoint<doubles_at_once> x;
        for (std::size_t d = 0; d < 3; ++d) x[d] = low[d] + fraction * (high[d] - low[d]);
        unrolled<doubles_at_once>([&](auto i) NESTGRID_INLINE_LAMBDA {
            to[i] = WidePoint(
                {x[0].template number<i>(), x[1].template number<i>(), x[2].template number<i>()});
        });
    }
}

/// Cuts edges, and asks the grid for rows of positions.
template <class Batch>
void cut_in_rows(const Batch& batch, std::span<const BatchEdge> edges, const CutLevel& cut,
                 WidePoint* to) {
    constexpr std::size_t at_once = 128;
    std::array<typename Batch::Node, 2 * at_once> of{};
    std::array<Point, 2 * at_once> x;
    while (!edges.empty()) {
        const std::size_t count = std::min(edges.size(), at_once);
        for (std::size_t i = 0; i < count; ++i) {
            of[2 * i] = batch.nodes.all[edges[i].low];
            of[2 * i + 1] = batch.nodes.all[edges[i].high];
        }
        batch.grid->positions(std::span(of).first(2 * count), std::span(x).first(2 * count));
        for (std::size_t i = 0; i < count; ++i) {
            *to++ = cut_between(batch, edges[i], x[2 * i], x[2 * i + 1], cut);
        }
        edges = edges.subspan(count);
    }
}

/// Sets to[i] to the point at which a level set cuts edges[i]. The points have the same bits
/// whether the grid gives positions one by one, in packs or in rows.
/// \param to has room for edges.size() points
template <class Batch>
void cut_edges(const Batch& batch, std::span<const BatchEdge> edges, const CutLevel& cut,
               WidePoint* to) {
    using Grid = std::remove_cvref_t<decltype(*batch.grid)>;
    if constexpr (PacksPositions<Grid>) {
        const std::size_t rest = edges.size() % doubles_at_once;
        const auto whole = edges.first(edges.size() - rest);
        std::array<BatchEdge, doubles_at_once> last;
        std::array<WidePoint, doubles_at_once> x;
        for (std::size_t i = 0; i < rest; ++i) last[i] = edges[whole.size() + i];
        batch.grid->template with_packed_positions<doubles_at_once>([&](const auto& positions) {
            cut_in_packs(batch, positions, whole, cut, to);
            if (rest == 0) return;
            std::fill(last.begin() + rest, last.end(), last[0]);
            cut_in_packs(batch, positions, last, cut, x.data());
            std::copy_n(x.begin(), rest, to + whole.size());
        });
    } else if constexpr (AnswersInRows<Grid>) {
        cut_in_rows(batch, edges, cut, to);
    } else {
        for (const BatchEdge& edge : edges) {
            *to++ =
                cut_between(batch, edge, batch.position(edge.low), batch.position(edge.high), cut);
        }
    }
}

}  // namespace nestgrid::engine
