// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Octrees that store nothing of their own: over samples, and over a solver's array of leaves.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/adapters/linear_octree.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
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
        : LinearSample(
              dim == 2 ? shaken(quadrilaterals(2), seed, 0.1) : shaken(hexahedra(2), seed, 0.1),
              seed) {}
    LinearSample(CoarseGrid grid_of_trees, unsigned seed)
        : coarse{std::move(grid_of_trees)}, trees{random_trees<dim>(coarse.element_count(), seed)} {
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

/// Trees of a square or cube, tree t turned t times about z.
template <int dim>
CoarseGrid turned_trees() {
    const CoarseGrid straight = dim == 2 ? quadrilaterals(2) : hexahedra(2);
    CoarseGrid turned;
    turned.dimension = dim;
    turned.nodes = straight.nodes;
    for (std::size_t t = 0; t < straight.element_count(); ++t) {
        const auto corners = straight.element(t);
        std::vector<std::uint32_t> again(corners.begin(), corners.end());
        for (std::size_t turn = 0; turn < t % 4; ++turn) {
            for (std::size_t k = 0; k < again.size(); k += 4) {
                std::array quarter{again[k + 2], again[k], again[k + 3], again[k + 1]};
                std::copy(quarter.begin(), quarter.end(), again.begin() + static_cast<long>(k));
            }
        }
        turned.add(straight.shapes[t], again);
    }
    return turned;
}

/// Two corners of leaves have one key where they are one node, whatever the trees.
template <int dim>
void expect_keys_of_nodes(const LinearSample<dim>& sample) {
    const LinearOctree<dim, Octant> grid = sample.grid();
    std::map<NodeKey, int> node_of;
    std::map<int, NodeKey> key_of;
    const auto visit = [&](const auto& e, const auto& again) -> void {
        std::array<NodeKey, 1U << dim> keys;
        grid.corner_keys(e, keys);
        if (grid.split(e) == nullptr) {
            for (std::size_t c = 0; c < keys.size(); ++c) {
                const int node = sample.element_nodes[keys.size() * grid.leaf_index(e) + c];
                ASSERT_EQ(node_of.try_emplace(keys[c], node).first->second, node);
                ASSERT_EQ(key_of.try_emplace(node, keys[c]).first->second, keys[c]);
            }
            return;
        }
        std::array<typename LinearOctree<dim, Octant>::Element, 1U << dim> children;
        grid.children(e, children);
        for (const auto& child : children) again(child, again);
    };
    for (std::size_t t = 0; t < grid.coarse_count(); ++t) visit(grid.coarse(t).element, visit);
    EXPECT_EQ(node_of.size(), sample.values.size());
}

/// Data of cells that are those of a linear function, in trees that are turned.
template <int dim>
void expect_linear_cells(const LinearSample<dim>& sample) {
    using Grid = LinearOctree<dim, Octant>;
    const Grid grid = sample.grid();
    const auto linear = [](const Point& x) { return 0.3 * x[0] + 0.7 * x[1] - 0.4 * x[2]; };
    std::vector<double> cells;
    for (std::size_t t = 0; t < sample.trees.size(); ++t) {
        const auto corner = sample.coarse.positions(t);
        for (const Octant& o : sample.trees[t]) {
            const int size = 1 << (depth - o.level);
            const auto x = [&](int part) {
                return LinearSample<dim>::place(
                    corner, {o.x + part, o.y + part, dim == 3 ? o.z + part : 0});
            };
            cells.push_back(0.5 * (linear(x(0)) + linear(x(size))));
        }
    }
    const CellAverages field(
        grid, [&](const typename Grid::Element& leaf) { return cells[grid.leaf_index(leaf)]; });
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation) << violation->sentence;
    const auto all = isosurface(grid, field, 0.32, Projection{}, {.verify = true});
    EXPECT_GT(all.surface.simplices.size(), 20U);
    for (const Point& x : all.surface.vertices) ASSERT_NEAR(linear(x), 0.32, 1e-12);
}

TEST(LinearOctree, NamesNodesForTreesThatAreTurned) {
    expect_keys_of_nodes(LinearSample<2>(1));
    expect_keys_of_nodes(LinearSample<3>(1));
    expect_keys_of_nodes(LinearSample<2>(turned_trees<2>(), 2));
    expect_keys_of_nodes(LinearSample<3>(turned_trees<3>(), 2));
}

TEST(LinearOctree, TakesDataOfCells) {
    expect_linear_cells(LinearSample<2>(turned_trees<2>(), 1));
    expect_linear_cells(LinearSample<3>(turned_trees<3>(), 1));
}

constexpr int thirds_depth = 3;

/// One tree, divided by three at random.
template <int dim>
std::vector<Octant> random_thirds(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Octant> leaves;
    const auto add = [&](const Octant& o, const auto& again) -> void {
        if (o.level == thirds_depth || (o.level > 0 && random() % 4 != 0)) {
            leaves.push_back(o);
            return;
        }
        const int part = o.level == 0 ? 9 : (o.level == 1 ? 3 : 1);
        for (int c = 0; c < (dim == 2 ? 9 : 27); ++c) {
            again(
                {o.x + part * (c % 3), o.y + part * (c / 3 % 3), o.z + part * (c / 9), o.level + 1},
                again);
        }
    };
    add({0, 0, 0, 0}, add);
    return leaves;
}

/// Offers the nodes that hang, for which it looks at all leaves.
template <int dim>
class Thirds : public LinearOctree<dim, Octant, 3> {
public:
    using Base = LinearOctree<dim, Octant, 3>;
    using Element = typename Base::Element;

    explicit Thirds(std::span<const Octant> leaves)
        : Base(dim == 2 ? quadrilaterals(1) : hexahedra(1), {leaves}, thirds_depth),
          leaves_{leaves} {}

    NodeMask constrained(const Element& e) const {
        const Octant& first = leaves_[e.first];
        const int width = static_cast<int>(Base::cells_in(thirds_depth - e.level));
        return nodes_.hanging([&](const std::array<int, 3>& steps) {
            const std::array<int, 3> at{first.x + steps[0] * width, first.y + steps[1] * width,
                                        first.z + steps[2] * width};
            return std::ranges::any_of(leaves_, [&](const Octant& leaf) {
                const int side = static_cast<int>(Base::cells_in(thirds_depth - leaf.level));
                const auto holds = [&](int low, int x) { return low <= x && x < low + side; };
                return leaf.level <= e.level && holds(leaf.x, at[0]) && holds(leaf.y, at[1]) &&
                       (dim == 2 || holds(leaf.z, at[2]));
            });
        });
    }

private:
    std::span<const Octant> leaves_;
    detail::NodesOfTrees<dim, 3> nodes_;
};

template <int dim>
void expect_thirds(unsigned seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<Octant> leaves = random_thirds<dim>(seed);
    const Thirds<dim> grid(leaves);
    const auto centre = [&](const auto& leaf) {
        const Octant& o = leaves[grid.leaf_index(leaf)];
        const double half = std::pow(3, thirds_depth - o.level) / 2;
        return Point{o.x + half, o.y + half, dim == 2 ? 0 : o.z + half};
    };
    const CellAverages values(grid, [&](const auto& leaf) {
        return norm((1.0 / 27) * centre(leaf) - Point{0.4, 0.5, dim == 2 ? 0 : 0.55});
    });
    const auto violation = check_grid(grid, values);
    EXPECT_FALSE(violation) << violation->sentence;
    const HierarchicalIndicator indicator(grid, values);
    for (const double threshold : {0.0, 0.02, 0.2}) {
        const auto result =
            isosurface(grid, values, 0.3, under(indicator, threshold), {.verify = true});
        EXPECT_GT(result.surface.simplices.size(), 5U);
    }
    const CellAverages plane(grid, [&](const auto& leaf) { return centre(leaf)[0]; });
    for (const Point& x : isosurface(grid, plane, 10.1, Projection{}).surface.vertices) {
        ASSERT_NEAR(27 * x[0], 10.1, 1e-10);
    }
}

TEST(LinearOctree, DividesByThree) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        expect_thirds<2>(seed);
        expect_thirds<3>(seed);
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
