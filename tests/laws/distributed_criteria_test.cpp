// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of distributed grids under all indicators and criteria that are made for ranks.
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/region.hpp>

#include <level_sets/leaf_bounds.hpp>

#include "record_judge.hpp"
#include "sample_grids.hpp"

using namespace nestgrid_test;

namespace {

double distance_from_middle(const Point& x) { return norm(x - Point{0.5, 0.5, 0.5}) - 0.2; }

/// A criterion of a user's: stops in a half of space.
struct Half final : Criterion {
    explicit Half(const Region& other) : region{&other} {}
    NodeMask holds(const NewNodes& nodes) const override {
        NodeMask mask = 0;
        for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
            mask |= NodeMask{!region->contains(nodes.keys[n])} << n;
        }
        return mask & ~nodes.outside;
    }
    bool saturated() const override { return true; }
    bool made_for(std::uint64_t epoch) const override { return region->made_for(epoch); }

    const Region* region;
};

struct DrawUnderCriteria {
    template <class Grid, class Field, class Take>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    const Take& take) const {
        const auto draw = [&](const Criterion& s, const Bounds& bounds) {
            take(isosurface(grid, field, 0.1, under(s, bounds), {.cap = true}, {executor}));
        };
        const HierarchicalIndicator deviations(grid, field, NodeError::deviation, executor);
        for (const double epsilon : {0.05, 0.2, 0.6}) {
            draw(Threshold(&deviations, epsilon), deviations);
        }
        for (const double isovalue : {0.0, 0.25}) {
            take(isosurface(grid, field, isovalue, under(deviations, 0.2),
                            {.normals = true, .cap = isovalue > 0}, {executor}));
        }
        take(isosurface(grid, field, 0.0, under(Exact(), deviations), {.normals = true},
                        {executor}));
        const HierarchicalIndicator errors(
            grid, field, [&](const auto& leaf) { return error_of_leaf(leaf); }, executor);
        draw(Threshold(&errors, 0.7), errors);
        const HierarchicalIndicator spread(grid, field, Spread{.factor = 2, .slope = 0.5},
                                           executor);
        draw(Lens(&spread, distance_from_middle, {.finest = 0.05, .coarsest = 0.5}), spread);
        draw(Lens(&spread, distance_from_middle, {.finest = 0.05, .blend = 2}), spread);
        draw(Threshold(&spread, 0.3) && Threshold(&deviations, 0.3), spread);
        draw(Threshold(&spread, 0.1) || Threshold(&deviations, 0.3), deviations);
        const SweptIndicator norms = norm_indicator({grid, field});
        draw(Threshold(&norms, 0.3), deviations);
        const SweptIndicator sizes = mesh_size(grid, Spread{.slope = 1});
        draw(Lens(&sizes, distance_from_middle, {.finest = 0.1}), deviations);
        const Region region(grid, [](const Point& x) { return x[0] < 0.4; });
        draw(fine_inside(region, deviations, 0.4, 0.1), deviations);
        draw(Half(region), deviations);
    }
    template <class Element>
    static double error_of_leaf(const Element& leaf) {
        return static_cast<double>(detail::mix64(leaf.at) >> 40U) * 0x1p-24;
    }
};

template <class Family>
void on_family(const char* name) {
    constexpr int dim = Family::Grid::dimension;
    Tally tally;
    unsigned seed = 30;
    for (auto& grid : Family::grids()) {
        std::mt19937 random(++seed);
        refine_at_random(grid, random, 3, 4, 3, 200);
        const Whole whole(grid);
        for (unsigned data = 0; data < 3; ++data) {
            const ProgramJudge<dim, double, DrawUnderCriteria> judge(
                whole, some_values(whole, ++seed), {});
            for (unsigned i = 0; i < 4; ++i) {
                const Cutting cut = some_cutting(seed + i, random);
                judge.compare(cut, whole.partition(cut.ranks, cut.how, random), tally);
            }
        }
    }
    tally.expect_none(name);
}

TEST(DistributedCriteria, PiecesAreTheSurfaceOfOneRank) {
    on_family<UnbalancedOctree>("unbalanced octrees");
    on_family<Prisms>("prisms");
    on_family<RedGreenMixed3>("red-green mixed, 3-D");
    on_family<BisectionTetrahedra>("bisected tetrahedra");
    on_family<UnbalancedQuadtree>("unbalanced quadtrees");
    on_family<BisectionTriangles>("bisected triangles");
}

/// Draws with normals, at full resolution, so that elements that are drawn conform.
struct DrawNormals {
    template <class Grid, class Field, class Take>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    const Take& take) const {
        const engine::LeafBounds bounds(erase(grid, field));
        for (const double isovalue : {0.0, 0.2}) {
            take(isosurface(grid, field, isovalue, under(Exact(), bounds), {.normals = true},
                            {executor}));
        }
    }
};

/// A library that forgets what ranks tell for normals, from one exchange on.
class NormalMutants : public testing::TestWithParam<int> {};

TEST_P(NormalMutants, FailTheLaws) {
    Tally tally;
    std::mt19937 random(3);
    for (auto& grid : BisectionTetrahedra::grids()) {
        refine_at_random(grid, random, 3, 4, 3, 200);
        const Whole whole(grid);
        for (unsigned data = 0; data < 3; ++data) {
            const ProgramJudge<3, double, DrawNormals> judge(whole, some_values(whole, data), {});
            for (int ranks = 2; ranks <= 5; ++ranks) {
                Cutting cut{ranks, Whole::Cut::in_runs, 24, true, 1};
                cut.omission = {"normals", ForgetfulRanks::Step::draw, GetParam(), false};
                judge.compare(cut, whole.partition(ranks, cut.how, random), tally);
            }
        }
    }
    std::printf(
        "normals from exchange %d on forgotten: of %llu surfaces %llu differ, %llu runs end\n",
        GetParam(), static_cast<unsigned long long>(tally.drawn),
        static_cast<unsigned long long>(tally.other), static_cast<unsigned long long>(tally.ended));
    EXPECT_EQ(tally.other + tally.ended > 0, GetParam() < 5);
}

// Five exchanges, and none behind them.
INSTANTIATE_TEST_SUITE_P(EveryExchange, NormalMutants, testing::Range(0, 6));

/// Surfaces of data of cells: noise, and steps with plateaus.
struct DrawCells {
    template <class Grid, class Field>
    void operator()(const Grid& grid, const Field&, const Executor& executor,
                    Record& record) const {
        const auto noise = [](const auto& leaf) {
            return static_cast<double>(detail::mix64(leaf.at) >> 11U) * 0x1p-53 - 0.5;
        };
        const auto steps = [&](const auto& leaf) { return std::floor(4 * noise(leaf)) / 4; };
        draw(grid, CellAverages(grid, noise), executor, record);
        draw(grid, CellAverages(grid, steps, CellRule::sharp_centres), executor, record);
        draw(grid, CellAverages(grid, noise, CellRule::sharp_means), executor, record);
    }
    template <class Grid, class Field>
    static void draw(const Grid& grid, const Field& cells, const Executor& executor,
                     Record& record) {
        if constexpr (requires { grid.shared_nodes(); }) {
            draw_field(grid, DistributedField(grid, cells), executor, record);
        } else {
            draw_field(grid, cells, executor, record);
        }
    }
    template <class Grid, class Field>
    static void draw_field(const Grid& grid, const Field& field, const Executor& executor,
                           Record& record) {
        const HierarchicalIndicator indicator(grid, field, executor);
        for (const double threshold : {0.0, 0.1}) {
            const auto drawn = isosurface(grid, field, 0.0, under(indicator, threshold),
                                          {.cap = threshold > 0}, {executor});
            record.put({drawn.error_bound, static_cast<double>(drawn.counts.extracted)});
            record.put_surface(drawn.surface);
        }
    }
};

template <class Family>
void compare_cells(const char* name, unsigned cuttings) {
    Tally tally;
    unsigned seed = 70;
    for (auto& grid : Family::grids()) {
        std::mt19937 random(++seed);
        refine_at_random(grid, random, 3, 4, 3, 200);
        const Whole whole(grid);
        const RecordJudge<Family::Grid::dimension, DrawCells> judge(whole, some_values(whole, 0),
                                                                    DrawCells{});
        for (unsigned i = 0; i < cuttings; ++i) {
            Cutting cut = some_cutting(seed + i, random);
            cut.own_keys = true;
            judge.compare(cut, whole.partition(cut.ranks, cut.how, random), tally);
        }
    }
    tally.expect_none(name);
}

TEST(DistributedCriteria, CellsHaveTheMeansOfOneRank) {
    compare_cells<UnbalancedOctree>("cells, unbalanced octrees", 14);
    compare_cells<BalancedOctree>("cells, balanced octrees", 14);
    compare_cells<Prisms>("cells, prisms", 7);
    compare_cells<RedGreenMixed3>("cells, red-green mixed", 7);
    compare_cells<BisectionTetrahedra>("cells, bisections", 7);
    compare_cells<UnbalancedQuadtree>("cells, quadtrees", 14);
}

}  // namespace
