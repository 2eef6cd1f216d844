// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Octrees that store nothing of their own: over samples, and over a solver's array of leaves.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/adapters/linear_octree.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/detail/erase.hpp>
#include <walk/walk.hpp>

#include "counting_allocator.hpp"
#include "refusal.hpp"
#include "sample_grids.hpp"
#include "table_in_c.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

template <class Real>
class LeafSum final : public engine::Visitor<Real> {
public:
    explicit LeafSum(const engine::Walk<Real>& walk) : walk_{&walk} {}

    std::size_t leaves = 0;
    double volume = 0;

    engine::Decision inspect(const engine::ElementView<Real>&, const engine::Split&) override {
        return {};
    }
    void extract(const engine::ElementView<Real>& view) override {
        std::array<Point, max_corners> x;
        walk_->corners(view, nullptr, x.data());
        ++leaves;
        volume += std::abs(measure(view.shape, std::span(x).first(view.corner_count())));
    }

private:
    const engine::Walk<Real>* walk_;
};

template <int dim>
void check_lattice(const std::array<int, static_cast<std::size_t>(dim)>& samples) {
    const LatticeOctree<dim> grid({.samples = samples, .spacing = {0.5, 2, -1}});
    std::vector<float> values(grid.sample_count());
    std::mt19937 random(1);
    for (float& v : values) v = static_cast<float>(random() % 1000);
    const LatticeField field(grid, std::span<const float>(values));
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation) << violation->sentence;
    std::size_t cells = 1;
    for (const int n : samples) cells *= static_cast<std::size_t>(n - 1);
    // The first walk makes some frames for each level.
    const auto hierarchy = erase(grid, field);
    const engine::Walk<float> walk(hierarchy, {.positions = true});
    for (const std::size_t allocations : {std::size_t{8 * 10}, std::size_t{0}}) {
        LeafSum sum(walk);
        const std::size_t before = allocation_count();
        walk.run(sum);
        EXPECT_LE(allocation_count() - before, allocations);
        EXPECT_EQ(sum.leaves, cells);
    }
}

TEST(LatticeOctree, FillsTheDomainForAnyDimensions) {
    check_lattice<3>({17, 17, 17});
    check_lattice<3>({2, 2, 2});
    check_lattice<3>({5, 14, 23});
    check_lattice<3>({18, 33, 20});
    check_lattice<2>({33, 33});
    check_lattice<2>({7, 100});
}

/// No element with a node outside the domain stops: whatever the threshold, leaves at the boundary.
TEST(LatticeOctree, NodesBeyondTheDomainAreMarked) {
    const LatticeOctree<3> grid({.samples = {12, 9, 21}});
    for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
        const auto e = grid.coarse(i).element;
        if (grid.masked(e)) continue;
        std::array<Point, 8> x;
        grid.corner_positions(e, x);
        const bool across = x[7][0] > 11 || x[7][1] > 8 || x[7][2] > 20;
        EXPECT_EQ(grid.outside(e) != 0, across);
    }
}

struct Octant {
    int x, y, z, level;
};

/// Leaves of a tree refined where `wanted` says so, in the order of the curve.
template <int dim, class Function>
void refine_octant(std::vector<Octant>& leaves, const Octant& o, int max_level, Function& wanted) {
    if (o.level == max_level || !wanted(o)) {
        leaves.push_back(o);
        return;
    }
    const int half = 1 << (max_level - o.level - 1);
    for (int c = 0; c < 1 << dim; ++c) {
        refine_octant<dim>(
            leaves,
            {o.x + half * (c & 1), o.y + half * (c >> 1 & 1), o.z + half * (c >> 2), o.level + 1},
            max_level, wanted);
    }
}

constexpr int depth = 7;

template <int dim>
std::vector<std::vector<Octant>> random_trees(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::vector<Octant>> trees(count);
    for (auto& tree : trees) {
        auto wanted = [&](const Octant& o) {
            const double size = std::pow(0.5, o.level);
            const double unit = std::pow(0.5, depth);
            const Point x{o.x * unit, o.y * unit, o.z * unit};
            const double r = norm(x) - 0.8;
            return (std::abs(r) < 1.2 * size && o.level < 6) || random() % 40 == 0;
        };
        refine_octant<dim>(tree, {0, 0, 0, 0}, depth, wanted);
    }
    return trees;
}

/// Leaves, node numbers per leaf, and a value per node.
template <int dim>
struct LinearSample {
    CoarseGrid coarse;
    std::vector<std::vector<Octant>> trees;
    std::vector<int> element_nodes;
    std::vector<double> values;

    explicit LinearSample(unsigned seed)
        : coarse{dim == 2 ? shaken(quadrilaterals(2), seed, 0.1) : shaken(hexahedra(2), seed, 0.1)},
          trees{random_trees<dim>(coarse.element_count(), seed)} {
        std::map<std::array<long, 3>, int> known;  // nodes by their place, rounded
        for (std::size_t t = 0; t < trees.size(); ++t) {
            const auto corner = coarse.positions(t);
            for (const Octant& o : trees[t]) {
                const int size = 1 << (depth - o.level);
                for (int c = 0; c < 1 << dim; ++c) {
                    const Point x = place(corner, {o.x + size * (c & 1), o.y + size * (c >> 1 & 1),
                                                   dim == 3 ? o.z + size * (c >> 2) : 0});
                    std::array<long, 3> rounded{};
                    for (std::size_t d = 0; d < 3; ++d) rounded[d] = std::lround(x[d] * 1e9);
                    const auto [entry, is_new] =
                        known.try_emplace(rounded, static_cast<int>(values.size()));
                    if (is_new) values.push_back(smooth(x));
                    element_nodes.push_back(entry->second);
                }
            }
        }
    }
    LinearOctree<dim, Octant> grid() const {
        std::vector<std::span<const Octant>> spans(trees.begin(), trees.end());
        return {coarse, spans, depth};
    }
    static double smooth(const Point& x) { return x[0] - 2 * x[1] * x[0] + x[2]; }
    static Point place(const std::array<Point, max_corners>& corner, const std::array<int, 3>& at) {
        Point x{0, 0, 0};
        for (std::size_t c = 0; c < 1U << dim; ++c) {
            double weight = 1;
            for (std::size_t d = 0; d < dim; ++d) {
                const double r = at[d] * std::pow(0.5, depth);
                weight *= (c >> d & 1U) != 0 ? r : 1 - r;
            }
            x = x + weight * corner[c];
        }
        return x;
    }
};

template <int dim>
void check_linear(unsigned seed) {
    const LinearSample<dim> sample(seed);
    const LinearOctree<dim, Octant> grid = sample.grid();
    const LinearOctreeField<LinearOctree<dim, Octant>, double, int> field(
        grid, sample.element_nodes, sample.values);
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation) << violation->sentence;
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.keys = false, .positions = true});
    LeafSum sum(walk);
    walk.run(sum);
    EXPECT_EQ(sum.leaves, grid.leaf_count());
    double whole = 0;
    for (std::size_t t = 0; t < sample.coarse.element_count(); ++t) {
        whole += std::abs(measure(sample.coarse.shapes[t], sample.coarse.positions(t)));
    }
    EXPECT_NEAR(sum.volume / whole, 1, 1e-12);

    const BehindTables tables(grid, field);
    const engine::Walk<double> table_walk(*tables.hierarchy, {.keys = false, .positions = true});
    LeafSum table_sum(table_walk);
    table_walk.run(table_sum);
    EXPECT_EQ(table_sum.leaves, sum.leaves);
}

TEST(LinearOctree, WalksUnbalancedTreesInPlace) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        check_linear<2>(seed);
        check_linear<3>(seed);
    }
}

std::string sentence(const std::vector<Octant>& leaves, int levels = depth) {
    return refusal([&] {
        const std::vector<std::span<const Octant>> tree{leaves};
        const LinearOctree<3, Octant> grid(hexahedra(1), tree, levels);
    });
}

TEST(LinearOctree, RefusesWrongArrays) {
    std::vector<Octant> leaves = random_trees<3>(1, 2).front();
    ASSERT_EQ(sentence(leaves), "");
    const auto expect = [](const std::string& got, const std::string& part) {
        EXPECT_NE(got.find(part), std::string::npos) << got;
    };
    auto bad = leaves;
    std::swap(bad[10], bad[11]);
    expect(sentence(bad), "leaf 10 of tree 0 leaves a gap");
    bad = leaves;
    bad.insert(bad.begin() + 5, bad[4]);
    expect(sentence(bad), "leaf 5 of tree 0 overlaps");
    bad = leaves;
    bad.erase(bad.begin() + 7);
    expect(sentence(bad), "leaf 7 of tree 0 leaves a gap");
    bad = leaves;
    bad.pop_back();
    expect(sentence(bad), "do not fill it");
    bad = leaves;
    bad[3].level = depth + 1;
    expect(sentence(bad), "leaf 3 of tree 0 has the level 8");
    bad = leaves;
    bad[3].x = 1 << depth;
    expect(sentence(bad), "outside its tree");
    bad = leaves;
    bad[3].x = -1;
    expect(sentence(bad), "outside its tree");
    bad.assign(1, {1, 0, 0, 0});
    expect(sentence(bad), "not aligned");
    expect(sentence({}), "do not fill it");
    expect(sentence(leaves, 63), "63 levels");

    const std::vector<Octant> root{{0, 0, 0, 0}};
    const std::vector<std::span<const Octant>> tree{root};
    const LinearOctree<3, Octant> grid(hexahedra(1), tree, depth);
    using Field = LinearOctreeField<LinearOctree<3, Octant>, double, int>;
    const std::vector<double> values(8);
    EXPECT_THROW(Field(grid, std::vector<int>(7), values), InvalidInput);
    EXPECT_THROW(Field(grid, std::vector<int>(8, 8), values), InvalidInput);
    EXPECT_THROW(Field(grid, std::vector<int>(8, -1), values), InvalidInput);
}

}  // namespace
