// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boxes spread over simulated ranks: what all draw together is what one rank draws, though no rank
// has the arrays of all boxes.
#include <mutex>

#include <gtest/gtest.h>

#include <nestgrid/adapters/block_part.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "block_samples.hpp"
#include "refusal.hpp"
#include "simulated_ranks.hpp"

using namespace nestgrid_test;

namespace block_ranks_test {

/// The corners of a simplex, beginning with the least.
template <int dim>
using Piece = std::array<Point, static_cast<std::size_t>(dim)>;

template <int dim>
void add_pieces(const Surface<dim>& surface, std::vector<Piece<dim>>& all) {
    for (const auto& simplex : surface.simplices) {
        Piece<dim> piece{};
        for (std::size_t k = 0; k < piece.size(); ++k) piece[k] = surface.vertices[simplex[k]];
        std::rotate(piece.begin(), std::min_element(piece.begin(), piece.end()), piece.end());
        all.push_back(piece);
    }
}

/// What is compared: all triangles, in any order, and what is told of the whole.
template <int dim>
struct Drawn {
    std::vector<Piece<dim>> pieces;
    std::array<double, 2> bounds{};
    std::uint64_t visited = 0;

    void add(const Isosurface<dim>& result) {
        add_pieces<dim>(result.surface, pieces);
        bounds = {result.error_bound, result.range_bound};
        visited = result.counts.visited;
        std::sort(pieces.begin(), pieces.end());
    }
    bool operator==(const Drawn&) const = default;
};

template <int dim>
struct Box {
    std::array<std::int64_t, static_cast<std::size_t>(dim)> low{}, high{};
};

/// A box in cells of the last level, with so many cells of its own around it.
template <int dim>
Box<dim> finest(const Blocks<dim>& blocks, std::size_t level, const BlockBox<dim>& box,
                int around) {
    std::int64_t size = 1;
    for (std::size_t l = level + 1; l < blocks.levels.size(); ++l) {
        size *= blocks.levels[l].ratio[0];
    }
    Box<dim> out;
    for (std::size_t d = 0; d < out.low.size(); ++d) {
        out.low[d] = size * (box.lower[d] - around);
        out.high[d] = size * (box.upper[d] + 1 + around);
    }
    return out;
}

template <int dim>
bool meet(const Box<dim>& a, const Box<dim>& b) {
    bool both = true;
    for (std::size_t d = 0; d < a.low.size(); ++d) {
        both = both && a.low[d] <= b.high[d] && b.low[d] <= a.high[d];
    }
    return both;
}

/// The arrays that a rank has: of its boxes, and of those around them.
template <int dim>
BlockArrays<dim, double> arrays_of(const Blocks<dim>& blocks, const BlockOwners& owners, int rank,
                                   BlockArrays<dim, double> arrays, std::size_t& left_out) {
    for (std::size_t l = 0; l < arrays.size(); ++l) {
        for (std::size_t b = 0; b < arrays[l].size(); ++b) {
            const auto around = finest(blocks, l, blocks.levels[l].boxes[b], 3);
            bool is_here = owners[l][b] == rank;
            for (std::size_t m = 0; !is_here && m < arrays.size(); ++m) {
                for (std::size_t c = 0; !is_here && c < arrays[m].size(); ++c) {
                    is_here = owners[m][c] == rank &&
                              meet(around, finest(blocks, m, blocks.levels[m].boxes[c], 3));
                }
            }
            if (is_here) continue;
            arrays[l][b].first = nullptr;
            ++left_out;
        }
    }
    return arrays;
}

template <int dim, class Grid, class Field>
std::vector<Isosurface<dim>> draw(const Grid& grid, const Field& field) {
    const HierarchicalIndicator indicator(grid, field);
    std::vector<Isosurface<dim>> all;
    for (const double threshold : {0.0, 0.05, 0.3}) {
        all.push_back(isosurface(grid, field, 0.0, under(indicator, threshold),
                                 {.cap = threshold > 0, .verify = true}));
    }
    return all;
}

/// \return how many arrays ranks did without
template <int dim>
std::size_t expect_same_on_ranks(unsigned seed, int ranks) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", ranks " + std::to_string(ranks));
    const Blocks<dim> blocks = random_blocks<dim>(
        {.seed = seed, .levels = 1 + static_cast<int>(seed % 3), .side = 12, .rarity = 4});
    const Point middle{0.4, 0.55, dim == 2 ? 0.0 : 0.5};
    const BlockData<dim> data(blocks, [&](const Point& x) { return norm(x - middle) - 0.35; });
    std::mt19937 random(seed);
    BlockOwners owners;
    for (const BlockLevel<dim>& level : blocks.levels) {
        owners.emplace_back();
        for (std::size_t b = 0; b < level.boxes.size(); ++b) {
            owners.back().push_back(static_cast<int>(random() % static_cast<unsigned>(ranks)));
        }
    }
    const BlockGrid<dim> whole(blocks);
    const auto expected = draw<dim>(whole, BlockCells<dim, double>(whole, data.arrays()));
    std::vector<Drawn<dim>> drawn(expected.size());
    std::size_t left_out = 0;
    std::mutex mutex;
    const auto ended = SimulatedRanks::run(ranks, [&](Ranks& all) {
        std::size_t without = 0;
        const BlockPart<dim> mine(blocks, owners, all.rank());
        const Distributed grid(mine, all);
        const BlockCells<dim, double> cells(
            mine, arrays_of(blocks, owners, all.rank(), data.arrays(), without));
        const DistributedField field(grid, cells);
        const auto pieces = draw<dim>(grid, field);
        const std::scoped_lock lock(mutex);
        left_out += without;
        for (std::size_t i = 0; i < pieces.size(); ++i) drawn[i].add(pieces[i]);
    });
    for (const std::string& sentence : ended) EXPECT_EQ(sentence, "");
    for (std::size_t i = 0; i < expected.size(); ++i) {
        Drawn<dim> one;
        one.add(expected[i]);
        EXPECT_GT(one.pieces.size(), 2U);
        EXPECT_EQ(drawn[i].pieces.size(), one.pieces.size());
        EXPECT_TRUE(drawn[i] == one) << "surface " << i;
    }
    return left_out;
}

template <int dim>
void expect_same_on_ranks() {
    std::size_t left_out = 0;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        for (const int ranks : {1, 2, 5}) left_out += expect_same_on_ranks<dim>(seed, ranks);
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(left_out, 50U);
}

TEST(BlockRanks, DrawWhatOneRankDraws) {
    expect_same_on_ranks<2>();
    expect_same_on_ranks<3>();
}

/// Gradients of cells need cells that a rank may lack, and would be 0 there.
TEST(BlockRanks, DrawNoNormals) {
    Blocks<3> blocks;
    blocks.levels.push_back({{{{0, 0, 0}, {3, 3, 3}}, {{4, 0, 0}, {7, 3, 3}}}, {}});
    const BlockData<3> data(blocks, [](const Point& x) { return norm(x) - 0.4; });
    std::array<bool, 2> talked{true, true};  // until a rank is refused
    const auto ended = SimulatedRanks::run(2, [&](Ranks& all) {
        const BlockPart<3> mine(blocks, {{0, 1}}, all.rank());
        const Distributed grid(mine, all);
        const DistributedField field(grid, BlockCells<3, double>(mine, data.arrays()));
        const HierarchicalIndicator indicator(grid, field);
        const auto before = SimulatedRanks::traffic(all).exchanges;
        try {
            isosurface(grid, field, 0.0, under(indicator, 0.0), {.normals = true});
        } catch (const std::exception&) {
            talked[static_cast<std::size_t>(all.rank())] =
                SimulatedRanks::traffic(all).exchanges != before;
            throw;
        }
    });
    for (const std::string& sentence : ended) {
        EXPECT_NE(sentence.find("a field with gradients of its own is not made for distributed "
                                "grids yet"),
                  std::string::npos)
            << sentence;
    }
    EXPECT_FALSE(talked[0] || talked[1]);
}

TEST(BlockRanks, NeedAnOwnerForEachBox) {
    const Blocks<3> blocks = random_blocks<3>({});
    EXPECT_EQ(refusal([&] { const BlockPart<3> part(blocks, {}, 0); }),
              "there is not one owner for each box of each level");
}

/// Who owns a box is a part of the grid's state.
TEST(BlockRanks, TellStatesApartByOwners) {
    Blocks<3> blocks;
    blocks.levels.push_back({{{{0, 0, 0}, {3, 3, 3}}, {{4, 0, 0}, {7, 3, 3}}}, {}});
    EXPECT_NE(BlockPart<3>(blocks, {{0, 1}}, 0).epoch(), BlockPart<3>(blocks, {{1, 0}}, 0).epoch());
    EXPECT_EQ(BlockPart<3>(blocks, {{0, 1}}, 0).epoch(), BlockPart<3>(blocks, {{0, 1}}, 1).epoch());
}

/// Each leaf is on one rank, each element says of what lies below it.
template <int dim>
void expect_presence() {
    const Blocks<dim> blocks = random_blocks<dim>({.seed = 5, .levels = 3, .side = 8});
    BlockOwners owners;
    for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
        owners.emplace_back();
        for (std::size_t b = 0; b < blocks.levels[l].boxes.size(); ++b) {
            owners[l].push_back(static_cast<int>((l + b) % 3));
        }
    }
    for (int rank = 0; rank < 3; ++rank) {
        const BlockPart<dim> part(blocks, owners, rank);
        using Element = typename BlockPart<dim>::Element;
        const auto visit = [&](const Element& e, const auto& again) -> std::array<bool, 3> {
            std::array<bool, 3> found{};  // some here, some elsewhere, the first here
            if (part.split(e) == nullptr) {
                const auto cell = part.cell_of(e);
                const bool here = owners[static_cast<std::size_t>(cell.level)]
                                        [static_cast<std::size_t>(cell.box)] == rank;
                found = {here, !here, here};
            } else {
                std::array<Element, 1U << dim> child;
                part.children(e, child);
                for (std::size_t c = 0; c < child.size(); ++c) {
                    const auto of = again(child[c], again);
                    found[0] = found[0] || of[0];
                    found[1] = found[1] || of[1];
                    if (c == 0) found[2] = of[2];
                }
            }
            const Presence partly = found[2] ? Presence::partly_first : Presence::partly;
            const Presence all = found[0] ? Presence::here : Presence::elsewhere;
            EXPECT_EQ(part.presence(e), found[0] && found[1] ? partly : all);
            return found;
        };
        for (std::size_t i = 0; i < part.coarse_count(); ++i) visit(part.coarse(i).element, visit);
    }
}

TEST(BlockRanks, KnowWhichLeavesAreHere) {
    expect_presence<2>();
    expect_presence<3>();
}

}  // namespace block_ranks_test
