// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of distributed grids, and isosurfaces with vertices at nodes: the pieces of all ranks,
// after merging, are what one rank draws.
#include <cstdio>
#include <cstdlib>

#include <nestgrid/algorithms/slice.hpp>

#include "distributed_judge.hpp"
#include "sample_grids.hpp"

using namespace nestgrid_test;

namespace {

bool is_long() { return std::getenv("NESTGRID_LONG_TESTS") != nullptr; }

/// Positions and attributes of the corners of a triangle, beginning with the least corner.
using Triangle = std::array<std::array<double, 5>, 3>;

void add_triangles(const Surface<3>& surface, std::vector<Triangle>& all) {
    const std::size_t stride =
        surface.vertices.empty() ? 0 : surface.attributes.size() / surface.vertices.size();
    for (const auto& simplex : surface.simplices) {
        Triangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Point& x = surface.vertices[simplex[k]];
            std::copy(x.begin(), x.end(), triangle[k].begin());
            for (std::size_t c = 0; c < stride; ++c) {
                triangle[k][3 + c] = surface.attributes[simplex[k] * stride + c];
            }
        }
        std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
        all.push_back(triangle);
    }
}

/// Edges on the boundary of the domain, by their ends.
using Ridge = std::array<Point, 2>;

struct Cut {
    std::vector<Triangle> triangles;
    std::vector<Ridge> boundary;
    double error_bound = 0;
    std::uint64_t extracted = 0;
    std::size_t elements = 0;  ///< triangles whose element is kept

    void add(const Isosurface<3>& piece) {
        add_triangles(piece.surface, triangles);
        for (const auto& [a, b] : piece.surface.boundary) {
            Ridge ridge{piece.surface.vertices[a], piece.surface.vertices[b]};
            std::ranges::sort(ridge);
            boundary.push_back(ridge);
        }
        error_bound = piece.error_bound;
        extracted = piece.counts.extracted;
        elements += piece.surface.element_of.size();
        EXPECT_TRUE(std::ranges::all_of(piece.surface.element_of, [&](std::uint32_t e) {
            return e < piece.surface.level_of.size();
        }));
    }
    void sort() {
        std::ranges::sort(triangles);
        std::ranges::sort(boundary);
    }
    bool operator==(const Cut&) const = default;
};

/// What is drawn: a slice by a function, or where there is none an isosurface at nodes.
struct Request {
    std::shared_ptr<const LevelFunction> function;
    double epsilon;  ///< below 0: without an indicator
};

template <class Grid, class Field>
Isosurface<3> draw(const Request& request, const Grid& grid, const Field& field,
                   const HierarchicalIndicator& indicator, const Executor& executor) {
    if (request.function == nullptr) {
        return isosurface(grid, field, 0.0, indicator,
                          {.threshold = request.epsilon, .at_nodes = true}, executor);
    }
    if (request.epsilon < 0) return slice(grid, field, *request.function, {}, executor);
    return slice(grid, field, *request.function, indicator, {.threshold = request.epsilon},
                 executor);
}

struct Tally {
    std::uint64_t slices = 0;
    std::uint64_t through_nodes = 0;
    std::uint64_t drawn = 0;
    std::uint64_t other = 0;
    std::uint64_t triangles = 0;
    std::uint64_t ended = 0;
    std::string first;
};

/// Draws all requests of a whole grid, and of its parts.
class Judge {
public:
    Judge(const Whole& whole, std::vector<double> values, std::vector<Request> requests)
        : whole_{&whole}, values_{std::move(values)}, requests_{std::move(requests)} {
        const CutGrid<3> grid(*whole_, nullptr, true);
        const CutField<3, double> field{&grid, &values_};
        const HierarchicalIndicator indicator(grid, field);
        for (const Request& request : requests_) {
            Cut& cut = expected_.emplace_back();
            cut.add(draw(request, grid, field, indicator, SequentialExecutor{}));
            cut.sort();
        }
    }

    void compare(const Cutting& cutting, const std::vector<int>& owner, Tally& tally) const {
        std::vector<Cut> drawn(requests_.size());
        std::mutex mutex;
        const auto ended = SimulatedRanks::run(cutting.ranks, [&](Ranks& all) {
            ForgetfulRanks ranks(all, cutting.omission);
            ranks.begin(ForgetfulRanks::Step::share);
            const Part part(*whole_, owner, ranks.rank());
            const CutGrid<3> mine(*whole_, &part, cutting.own_keys);
            const Distributed grid(mine, ranks, cutting.most_sharers);
            const DistributedField field(grid, CutField<3, double>{&mine, &values_});
            const ThreadExecutor threads(cutting.threads);
            const HierarchicalIndicator indicator(grid, field, threads);
            for (std::size_t i = 0; i < requests_.size(); ++i) {
                ranks.begin(ForgetfulRanks::Step::draw);
                const auto piece = draw(requests_[i], grid, field, indicator, threads);
                const std::scoped_lock lock(mutex);
                drawn[i].add(piece);
            }
        });
        for (const std::string& sentence : ended) {
            if (sentence.empty()) continue;
            ++tally.ended;
            if (tally.first.empty()) tally.first = sentence;
            return;
        }
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            ++tally.drawn;
            drawn[i].sort();
            tally.triangles += drawn[i].triangles.size();
            if (drawn[i] == expected_[i]) continue;
            ++tally.other;
            if (!tally.first.empty()) continue;
            tally.first = std::to_string(cutting.ranks) + " ranks, cut " +
                          std::to_string(int(cutting.how)) + ", request " + std::to_string(i) +
                          ": " + std::to_string(drawn[i].triangles.size()) + " triangles for " +
                          std::to_string(expected_[i].triangles.size()) + ", boundary " +
                          std::to_string(drawn[i].boundary.size()) + " for " +
                          std::to_string(expected_[i].boundary.size());
        }
    }
    std::span<const Cut> expected() const { return expected_; }

private:
    const Whole* whole_;
    std::vector<double> values_;
    std::vector<Request> requests_;
    std::vector<Cut> expected_;
};

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
    tally.slices += count;
    for (const double epsilon : {0.0, 0.3}) requests.push_back({nullptr, epsilon});
    return requests;
}

std::vector<double> values_of(const Whole& whole, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> values;
    for (const Point& x : whole.positions) {
        const double noise = static_cast<double>(random()) / 0x1p32;
        values.push_back(seed % 3 == 0   ? std::floor(3 * noise) - 1
                         : seed % 3 == 1 ? 0.3 * noise + std::sin(5 * x[0]) * x[1] - x[2] * x[2]
                                         : std::floor(4 * (x[0] + x[1] - x[2])) / 4);
        values.push_back(x[0] + 2 * x[1] - x[2]);
    }
    return values;
}

template <class Family>
void on_family(const char* name, Tally& all) {
    Tally tally;
    unsigned seed = 11;
    for (auto& grid : Family::grids()) {
        std::mt19937 random(++seed);
        refine_at_random(grid, random, 3, 4, 3, 200);
        const Whole whole(grid);
        for (unsigned data = 0; data < 3; ++data) {
            auto requests = requests_on(whole, 20, random, tally);
            const Judge judge(whole, values_of(whole, ++seed), std::move(requests));
            for (unsigned i = 0; i < (is_long() ? 20U : 4U); ++i) {
                const Cutting cut{std::array{2, 3, 5, 8, 1, 13, 4}[(seed + i) % 7],
                                  static_cast<Whole::Cut>(random() % 4),
                                  std::array<std::size_t, 2>{24, 2}[i % 2], i % 2 == 0,
                                  i % 4 == 3 ? std::size_t{2} : std::size_t{1}};
                judge.compare(cut, whole.partition(cut.ranks, cut.how, random), tally);
            }
        }
    }
    EXPECT_EQ(tally.other, 0U) << name << ": " << tally.first;
    EXPECT_EQ(tally.ended, 0U) << name << ": " << tally.first;
    std::printf(
        "%-26s %4llu slices, %3llu through nodes, drawn %5llu times, %llu other, %llu "
        "ended, %llu triangles\n",
        name, static_cast<unsigned long long>(tally.slices),
        static_cast<unsigned long long>(tally.through_nodes),
        static_cast<unsigned long long>(tally.drawn), static_cast<unsigned long long>(tally.other),
        static_cast<unsigned long long>(tally.ended),
        static_cast<unsigned long long>(tally.triangles));
    std::fflush(stdout);
    all.slices += tally.slices;
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
    std::printf("slices on ranks: %llu functions, of them %llu through nodes, %llu surfaces\n",
                static_cast<unsigned long long>(all.slices),
                static_cast<unsigned long long>(all.through_nodes),
                static_cast<unsigned long long>(all.drawn));
    EXPECT_GE(all.slices, 500U);
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
        const Judge judge(whole, values_of(whole, 0), requests_on(whole, 20, random, tally));
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
