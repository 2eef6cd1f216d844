// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of distributed grids, and isosurfaces with vertices at nodes: the pieces of all ranks,
// after merging, are what one rank draws.
#include <cstdio>

#include <nestgrid/algorithms/boundary_surface.hpp>

#include "long_run.hpp"
#include "program_judge.hpp"
#include "sample_grids.hpp"

using namespace nestgrid_test;

namespace {

/// What is drawn: a slice by a function, or where there is none an isosurface at nodes.
struct Request {
    std::shared_ptr<const LevelFunction> function;
    double epsilon;  ///< below 0: without an indicator
};

template <class Grid, class Field>
Isosurface<3> draw(const Request& request, const Grid& grid, const Field& field,
                   const HierarchicalIndicator& indicator, const Executor& executor) {
    if (request.function == nullptr) {
        return isosurface(grid, field, 0.0, under(indicator, request.epsilon), {.at_nodes = true},
                          {executor});
    }
    if (request.epsilon < 0) return slice(grid, field, *request.function, {}, {}, {executor});
    return slice(grid, field, *request.function, under(indicator, request.epsilon), {}, {executor});
}

/// Draws all requests.
struct DrawAll {
    std::vector<Request> requests;

    template <class Grid, class Field, class Take>
    void operator()(const Grid& grid, const Field& field, const Executor& executor,
                    const Take& take) const {
        const HierarchicalIndicator indicator(grid, field, executor);
        for (const Request& request : requests) {
            take(draw(request, grid, field, indicator, executor));
        }
        for (const double threshold : {0.0, 0.3}) {
            take(boundary_surface(grid, field, {.threshold = threshold}, {}, {executor}));
        }
    }
};
using Judge = ProgramJudge<3, double, DrawAll>;

/// Directions along edges, faces and diagonals of cubes.
constexpr std::array directions{Point{1, 0, 0},  Point{0, 1, 0}, Point{0, 0, 1},  Point{1, 1, 0},
                                Point{1, 0, -1}, Point{0, 1, 1}, Point{1, 1, 1},  Point{1, -1, 1},
                                Point{2, 1, 0},  Point{1, 2, 1}, Point{-1, 1, 1}, Point{1, -1, 0}};

/// Planes and spheres, every second one through nodes.
std::vector<Request> requests_on(const Whole& whole, std::size_t count, std::mt19937& random,
                                 Tally& tally) {
    const auto node = [&] { return whole.positions[random() % whole.positions.size()]; };
    const auto number = [&] { return static_cast<double>(random()) / 0x1p32; };
    std::vector<Request> requests;
    for (std::size_t i = 0; i < count; ++i) {
        const double epsilon = std::array{-1.0, 0.0, 0.2, 0.6}[random() % 4];
        const Point normal{number() - 0.5, number() - 0.5, number() - 0.5};
        std::shared_ptr<const LevelFunction> function;
        const Point x = node();
        switch (i % 5) {
            case 0:
            case 1:
                function = std::make_shared<Plane>(x, directions[random() % directions.size()]);
                break;
            case 2:
                function = std::make_shared<Plane>(x, normal);
                break;
            case 3:
                function = std::make_shared<Plane>(Point{number(), number(), number()}, normal);
                break;
            default:
                function = std::make_shared<Sphere>(x, std::max(0.125, norm(node() - x)));
        }
        tally.through_nodes += i % 5 < 3 ? 1 : 0;
        requests.push_back({std::move(function), epsilon});
    }
    tally.functions += count;
    for (const double epsilon : {0.0, 0.3}) requests.push_back({nullptr, epsilon});
    return requests;
}

template <class Family>
void on_family(const char* name, Tally& all, bool curved = false) {
    Tally tally;
    unsigned seed = 11;
    for (auto& grid : Family::grids()) {
        std::mt19937 random(++seed);
        refine_at_random(grid, random, 3, 4, 3, 200);
        Whole whole(grid);
        if (curved) whole.curve();
        for (unsigned data = 0; data < 3; ++data) {
            auto requests = requests_on(whole, 20, random, tally);
            const Judge judge(whole, some_values(whole, ++seed), {std::move(requests)});
            for (unsigned i = 0; i < (is_long_run() ? 20U : 4U); ++i) {
                const Cutting cut = some_cutting(seed + i, random);
                judge.compare(cut, whole.partition(cut.ranks, cut.how, random), tally);
            }
        }
    }
    tally.expect_none(name);
    all.functions += tally.functions;
    all.through_nodes += tally.through_nodes;
    all.drawn += tally.drawn;
}

TEST(DistributedSlices, PiecesAreTheSliceOfOneRank) {
    Tally all;
    on_family<BalancedOctree>("balanced octrees", all);
    on_family<UnbalancedOctree>("unbalanced octrees", all);
    on_family<Prisms>("prisms", all);
    on_family<RedGreenTetrahedra>("red-green tetrahedra", all);
    on_family<RedGreenMixed3>("red-green mixed, 3-D", all);
    on_family<BisectionTetrahedra>("bisected tetrahedra", all);
    on_family<BalancedOctree>("curved octrees", all, true);
    on_family<RedGreenTetrahedra>("curved red-green tetrahedra", all, true);
    std::printf("slices on ranks: %llu functions, of them %llu through nodes, %llu surfaces\n",
                static_cast<unsigned long long>(all.functions),
                static_cast<unsigned long long>(all.through_nodes),
                static_cast<unsigned long long>(all.drawn));
    EXPECT_GE(all.functions, 500U);
    EXPECT_GE(all.through_nodes, 200U);
}

/// A library that forgets what ranks tell while they merge, from one exchange on. On grids whose
/// elements conform, there is no other exchange in a slice.
class SliceMutants : public testing::TestWithParam<int> {};

TEST_P(SliceMutants, FailTheLaws) {
    Tally tally;
    std::mt19937 random(3);
    for (auto& grid : BisectionTetrahedra::grids()) {
        refine_at_random(grid, random, 3, 4, 3, 200);
        const Whole whole(grid);
        const Judge judge(whole, some_values(whole, 0), {requests_on(whole, 20, random, tally)});
        for (int ranks = 2; ranks <= 5; ++ranks) {
            Cutting cut{ranks, Whole::Cut::in_runs, 24, true, 1};
            cut.omission = {"merging", ForgetfulRanks::Step::draw, GetParam(), false};
            judge.compare(cut, whole.partition(ranks, cut.how, random), tally);
        }
    }
    std::printf(
        "merging from exchange %d on forgotten: of %llu surfaces %llu differ, %llu runs end\n",
        GetParam(), static_cast<unsigned long long>(tally.drawn),
        static_cast<unsigned long long>(tally.other), static_cast<unsigned long long>(tally.ended));
    EXPECT_GT(tally.other + tally.ended, 0U);
}

INSTANTIATE_TEST_SUITE_P(EveryExchange, SliceMutants, testing::Range(0, 7));

}  // namespace
