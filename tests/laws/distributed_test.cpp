// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of distributed grids: the pieces of all ranks are the surface of one rank.
#include <cstdio>
#include <optional>

#include <nestgrid/check_grid.hpp>

#include "anisotropic_grids.hpp"
#include "distributed_judge.hpp"
#include "long_run.hpp"
#include "refusal.hpp"
#include "sample_grids.hpp"

using namespace nestgrid_test;

namespace {

constexpr std::array six_thresholds{0.0, 0.05, 0.1, 0.3, 0.7, 1.5};

enum class Data { noise, gyroid, integers, plateaus };
constexpr std::array all_data{Data::noise, Data::gyroid, Data::integers, Data::plateaus};

double value_at(Data data, const Point& x, std::mt19937& random) {
    const double noise = static_cast<double>(random()) / 0x1p32 - 0.5;
    switch (data) {
        case Data::noise:
            return noise;
        case Data::gyroid:
            return std::sin(9 * x[0]) * std::cos(9 * x[1]) +
                   std::sin(9 * x[1]) * std::cos(9 * x[2]) +
                   std::sin(9 * x[2]) * std::cos(9 * x[0]) + 1e-3;
        case Data::integers:
            return std::floor(3 * (noise + 0.5)) - 1;
        case Data::plateaus:
            return std::clamp(std::floor(8 * (x[0] + x[1] * x[2] - 0.8)) / 4, -0.5, 0.5);
    }
    return 0;
}

template <class Real>
std::vector<Real> values_of(const Whole& whole, Data data, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Real> values;
    for (const Point& x : whole.positions) {
        values.push_back(static_cast<Real>(value_at(data, x, random)));
        values.push_back(static_cast<Real>(x[0] + 2 * x[1] - x[2]));
    }
    return values;
}

constexpr std::array counts_of_ranks{1, 2, 3, 4, 5, 7, 8, 11, 13, 17};

/// Random cuttings, with every count of ranks, way to cut and limit of sharers in turn.
Cutting cutting(unsigned i, std::mt19937& random) {
    constexpr std::array sharers{std::size_t{24}, std::size_t{1}, std::size_t{2}};
    return {counts_of_ranks[i % counts_of_ranks.size()], static_cast<Whole::Cut>(random() % 4),
            sharers[i % 3], random() % 2 == 0, random() % 8 == 0 ? std::size_t{2} : std::size_t{1}};
}

template <int dim, class Real>
void compare(const Whole& whole, Data data, unsigned seed, unsigned cuttings, Runs& runs) {
    std::mt19937 random(seed);
    // Three thresholds a field, all six in turn.
    std::vector<double> epsilons;
    for (unsigned i = 0; i < 3; ++i) epsilons.push_back(six_thresholds[2 * i + seed % 2]);
    const DistributedJudge<dim, Real> judge(whole, values_of<Real>(whole, data, seed), epsilons);
    for (unsigned i = 0; i < cuttings; ++i) {
        const Cutting cut = cutting(i + seed, random);
        judge.compare(cut, whole.partition(cut.ranks, cut.how, random), runs);
    }
}

/// Random refinement that neighbours share in parts.
template <class Family, class Mark_>
void refine(typename Family::Grid& grid, std::mt19937& random, std::size_t enough,
            const Mark_& mark) {
    for (int i = 0; i < 8 && grid.leaf_count() < enough; ++i) {
        try {
            grid.adapt(
                [&](const Leaf& leaf) { return random() % 5 < 2 ? mark(leaf) : Mark::keep; });
        } catch (const InvalidInput&) {  // prisms refuse some mixtures of directions
        }
    }
}

Mark in_all_directions(const Leaf&) { return Mark::refine; }
Mark in_two_directions(const Leaf& leaf) {
    return leaf.centre()[0] < 0.5 ? Mark::refine_horizontally : Mark::refine_vertically;
}

template <class Family, class Mark_>
void on_family(const char* name, const Mark_& mark, Runs& all, bool curved = false) {
    constexpr int dim = Family::Grid::dimension;
    const unsigned cuttings = is_long_run() ? 60 : 9;
    Runs runs;
    unsigned seed = 1;
    std::size_t leaves = 0;
    for (auto& grid : Family::grids()) {
        std::mt19937 random(++seed);
        refine<Family>(grid, random, dim == 3 ? 250 : 100, mark);
        Whole whole(grid);
        if (curved) whole.curve();
        leaves += whole.leaves;
        for (const Data data : all_data) {
            ++seed;
            if (seed % 3 == 0) {
                compare<dim, float>(whole, data, seed, cuttings, runs);
            } else {
                compare<dim, double>(whole, data, seed, cuttings, runs);
            }
        }
    }
    EXPECT_EQ(runs.mistakes(), 0U) << name << ": " << runs.first;
    std::printf(
        "%-32s %6zu leaves, %5llu surfaces (%llu other), %4llu prerolls (%llu other), %llu "
        "ended, %llu simplices, %llu common nodes\n",
        name, leaves, static_cast<unsigned long long>(runs.surfaces),
        static_cast<unsigned long long>(runs.other), static_cast<unsigned long long>(runs.prerolls),
        static_cast<unsigned long long>(runs.other_nodes),
        static_cast<unsigned long long>(runs.ended),
        static_cast<unsigned long long>(runs.triangles),
        static_cast<unsigned long long>(runs.common));
    std::fflush(stdout);
    all.surfaces += runs.surfaces;
}

TEST(Distributed, PiecesAreTheSurfaceOfOneRank) {
    Runs all;
    on_family<BalancedOctree>("balanced octrees", in_all_directions, all);
    on_family<UnbalancedOctree>("unbalanced octrees", in_all_directions, all);
    on_family<Prisms>("prisms", in_all_directions, all);
    on_family<Prisms>("prisms in two directions", in_two_directions, all);
    on_family<RedGreenTetrahedra>("red-green tetrahedra", in_all_directions, all);
    on_family<RedGreenMixed3>("red-green mixed, 3-D", in_all_directions, all);
    on_family<BisectionTetrahedra>("bisected tetrahedra", in_all_directions, all);
    on_family<BalancedQuadtree>("balanced quadtrees", in_all_directions, all);
    on_family<UnbalancedQuadtree>("unbalanced quadtrees", in_all_directions, all);
    on_family<RedGreenTriangles>("red-green triangles", in_all_directions, all);
    on_family<RedGreenMixed2>("red-green mixed, 2-D", in_all_directions, all);
    on_family<BisectionTriangles>("bisected triangles", in_all_directions, all);
    on_family<UnbalancedOctree>("curved octrees", in_all_directions, all, true);
    on_family<RedGreenMixed3>("curved red-green, mixed, 3-D", in_all_directions, all, true);
    on_family<BisectionTriangles>("curved bisected triangles", in_all_directions, all, true);
    std::printf("surfaces drawn by ranks and compared: %llu\n",
                static_cast<unsigned long long>(all.surfaces));
    EXPECT_GE(all.surfaces, is_long_run() ? 20000U : 3000U);
}

/// What each rank of a cutting says when it finds out which nodes it shares; empty where nothing.
template <int dim>
std::vector<std::string> refused(const Whole& whole, const Cutting& cut,
                                 const std::vector<int>& owner) {
    return SimulatedRanks::run(cut.ranks, [&](Ranks& ranks) {
        const Part part(whole, owner, ranks.rank());
        const CutGrid<dim> mine(whole, &part, cut.own_keys);
        const Distributed grid(mine, ranks, cut.most_sharers);
    });
}

TEST(Distributed, AnisotropicGridsAreDrawnOrRefusedAsOnOneRank) {
    Runs runs;
    unsigned refused_grids = 0;
    unsigned refused_runs = 0;
    unsigned drawn_grids = 0;
    for (unsigned seed = 0; seed < (is_long_run() ? 2000U : 250U); ++seed) {
        std::mt19937 random(seed);
        const Forest<3> forest = random_anisotropic_grid(random);
        const Whole whole(forest);
        if (whole.leaves > 400) continue;
        std::optional<DistributedJudge<3, double>> judge;
        const std::string sentence = refusal<GridError>([&] {
            judge.emplace(whole, values_of<double>(whole, Data::noise, seed), std::array{0.0, 0.3});
        });
        ++(judge ? drawn_grids : refused_grids);
        for (unsigned i = 0; i < 3; ++i) {
            Cutting cut = cutting(i + seed, random);
            cut.ranks = 2 + cut.ranks % 7;
            const std::vector<int> owner = whole.partition(cut.ranks, cut.how, random);
            if (judge) {
                judge->compare(cut, owner, runs);
                continue;
            }
            ++refused_runs;
            for (const std::string& each : refused<3>(whole, cut, owner)) {
                EXPECT_NE(each.find("in different directions first"), std::string::npos)
                    << seed << ": '" << each << "', not '" << sentence << "'";
            }
        }
    }
    EXPECT_EQ(runs.mistakes(), 0U) << runs.first;
    EXPECT_GT(refused_grids, 20U);
    EXPECT_GT(drawn_grids, 20U);
    std::printf("anisotropic: %u grids refused in %u runs, %u drawn, %llu surfaces\n",
                refused_grids, refused_runs, drawn_grids,
                static_cast<unsigned long long>(runs.surfaces));
}

/// The law that check_grid finds violated on a rank of a random cut, where `change` was done to
/// what it has.
template <class Change>
std::optional<GridViolation> check_part(unsigned seed, const Change& change) {
    std::mt19937 random(seed);
    OctreeGrid<3> grid = UnbalancedOctree::grids()[0];
    refine<UnbalancedOctree>(grid, random, 60, in_all_directions);
    const Whole whole(grid);
    Part part(whole, whole.partition(3, Whole::Cut::in_runs, random), 1);
    if (!change(whole, part)) return std::nullopt;
    const CutGrid<3> mine(whole, &part, seed % 2 == 0);
    const std::vector<double> values(2 * whole.positions.size(), 0.5);
    return check_grid(mine, CutField<3, double>{&mine, &values});
}

TEST(Distributed, CheckGridLooksAtPresence) {
    for (unsigned seed = 0; seed < 10; ++seed) {
        EXPECT_FALSE(check_part(seed, [](const Whole&, Part&) { return true; })) << seed;
    }
    const auto becomes = [](Presence from, Presence to, bool leaf) {
        return [=](const Whole& whole, Part& part) {
            for (std::size_t e = 0; e < part.presence.size(); ++e) {
                if (part.presence[e] != from || leaf != (whole.elements[e].rule == nullptr))
                    continue;
                part.presence[e] = to;
                return true;
            }
            return false;
        };
    };
    const auto expect_found = [](const auto& change, const std::string& sentence) {
        unsigned changed = 0;
        for (unsigned seed = 0; seed < 20; ++seed) {
            bool does = false;
            const auto found = check_part(
                seed, [&](const Whole& whole, Part& part) { return does = change(whole, part); });
            if (!does) continue;
            ++changed;
            ASSERT_TRUE(found) << sentence;
            EXPECT_EQ(found->law, Law::presence) << found->sentence;
            EXPECT_NE(found->sentence.find(sentence), std::string::npos) << found->sentence;
        }
        EXPECT_GT(changed, 5U) << sentence;
    };
    expect_found(becomes(Presence::here, Presence::partly, true), "");
    expect_found(becomes(Presence::partly, Presence::here, false), "");
    expect_found(becomes(Presence::partly, Presence::partly_first, false), "first");
    expect_found(becomes(Presence::partly_first, Presence::partly, false), "first");
}

struct Mutant {
    ForgetfulRanks::Omission omission;
    std::size_t most_sharers;
    bool all_draw;
};

using Omit = ForgetfulRanks::Step;
constexpr std::array mutants{
    Mutant{{"hanging nodes not told", Omit::share, 2, false}, 24, false},
    Mutant{{"common nodes not told", Omit::share, 0, true}, 1, false},
    Mutant{{"values not told", Omit::values, 0, false}, 24, false},
    Mutant{{"maxima not told", Omit::preroll, 0, false}, 24, false},
    Mutant{{"maxima told once", Omit::preroll, 1, false}, 24, false},
    Mutant{{"contours not told", Omit::draw, 0, false}, 24, false},
    Mutant{{"contours on common faces not told", Omit::draw, 0, true}, 1, false},
    Mutant{{"elements in part drawn by all", Omit::none, 0, false}, 24, true},
};

/// A library without a step, on octrees and on prisms in two directions.
class Mutants : public testing::TestWithParam<std::size_t> {};

TEST_P(Mutants, FailTheLaws) {
    const Mutant& mutant = mutants[GetParam()];
    const auto grids = [](auto&& test) {
        for (auto& grid : UnbalancedOctree::grids())
            test.template operator()<UnbalancedOctree>(grid, in_all_directions);
        for (auto& grid : Prisms::grids())
            test.template operator()<Prisms>(grid, in_two_directions);
    };
    Runs runs;
    unsigned seed = 40;
    grids([&]<class Family>(typename Family::Grid& grid, const auto& mark) {
        std::mt19937 random(++seed);
        refine<Family>(grid, random, 120, mark);
        const Whole whole(grid);
        const DistributedJudge<3, double> judge(whole, values_of<double>(whole, Data::noise, seed),
                                                std::array{0.1, 0.3});
        for (int ranks = 2; ranks <= 5; ++ranks) {
            const Cutting cut{ranks, Whole::Cut::in_runs, mutant.most_sharers, false,
                              1,     mutant.omission,     mutant.all_draw};
            judge.compare(cut, whole.partition(ranks, cut.how, random), runs);
        }
    });
    std::printf(
        "%-36s of %llu surfaces %llu differ, of %llu prerolls %llu, and of 16 programs %llu end\n",
        mutant.omission.what, static_cast<unsigned long long>(runs.surfaces),
        static_cast<unsigned long long>(runs.other), static_cast<unsigned long long>(runs.prerolls),
        static_cast<unsigned long long>(runs.other_nodes),
        static_cast<unsigned long long>(runs.ended));
    EXPECT_GT(runs.mistakes(), 0U);
}

INSTANTIATE_TEST_SUITE_P(EveryStep, Mutants, testing::Range(std::size_t{0}, mutants.size()));

}  // namespace
