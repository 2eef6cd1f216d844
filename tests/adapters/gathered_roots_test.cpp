// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Coarse elements on a lattice as parts of larger roots: all data give the surface that they give
// without, thresholds coarsen them, and what is no lattice stays as it is.
#include <gtest/gtest.h>

#include <nestgrid/adapters/gathered_roots.hpp>
#include <nestgrid/adapters/linear_octree.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>

#include "closedness.hpp"
#include "sample_grids.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace gathered_roots_test {

struct Octant {
    int x, y, z, level;
};

/// Trees of which some are divided once or twice, at random, and some hidden.
template <int dim>
class Trees : public LinearOctree<dim, Octant> {
public:
    using Base = LinearOctree<dim, Octant>;
    using Element = typename Base::Element;

    Trees(const CoarseGrid& coarse, const std::vector<std::vector<Octant>>& trees,
          std::vector<bool> is_hidden = {})
        : Base(coarse, {trees.begin(), trees.end()}, 2), is_hidden_{std::move(is_hidden)} {}

    Hidden hidden(const Element& e) const {
        if (is_hidden_.empty()) return Hidden::not_at_all;
        const auto from = is_hidden_.begin() + static_cast<std::ptrdiff_t>(e.first);
        const auto to = is_hidden_.begin() + static_cast<std::ptrdiff_t>(e.last);
        const auto count = std::count(from, to, true);
        if (count == 0) return Hidden::not_at_all;
        return count == to - from ? Hidden::wholly : Hidden::partly;
    }

private:
    std::vector<bool> is_hidden_;
};

template <int dim>
std::vector<std::vector<Octant>> random_trees(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::vector<Octant>> trees(count);
    for (auto& tree : trees) {
        const auto add = [&](const Octant& o, const auto& again) -> void {
            if (o.level == 2 || random() % 3 != 0) {
                tree.push_back(o);
                return;
            }
            const int half = 2 >> o.level;
            for (int c = 0; c < 1 << dim; ++c) {
                again({o.x + half * (c & 1), o.y + half * (c >> 1 & 1), o.z + half * (c >> 2),
                       o.level + 1},
                      again);
            }
        };
        add({0, 0, 0, 0}, add);
    }
    return trees;
}

/// Numbers of leaves, from a wave at random places.
template <int dim>
std::vector<double> random_cells(const Trees<dim>& grid, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> cells;
    for (std::size_t i = 0; i < grid.leaf_count(); ++i) {
        cells.push_back(std::sin(0.05 * static_cast<double>(i)) +
                        0.1 * static_cast<double>(random() % 9) - 0.4);
    }
    return cells;
}

/// Triangles by the positions of their corners, in any order, without their last digits: a lattice
/// of sixths is no other when it is halved from larger roots, up to rounding.
template <int dim>
auto triangles_of(const Surface<dim>& surface) {
    std::vector<std::array<Point, static_cast<std::size_t>(dim)>> all;
    for (const auto& simplex : surface.simplices) {
        auto& corners = all.emplace_back();
        for (std::size_t k = 0; k < corners.size(); ++k) {
            corners[k] = surface.vertices[simplex[k]];
            for (double& x : corners[k]) x = std::round(1e9 * x) / 1e9;
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// \return how many elements the coarsest surface visits, and with the grid's own roots
template <int dim>
std::array<std::uint64_t, 2> expect_same_surface(const Trees<dim>& own, unsigned seed) {
    const std::vector<double> cells = random_cells(own, seed);
    const CellAverages values(own, [&](const auto& leaf) { return cells[own.leaf_index(leaf)]; });
    const GatheredRoots grid(own);
    const GatheredField field(grid, values);
    const auto violation = check_grid(grid, field);
    EXPECT_FALSE(violation) << violation->sentence;
    const IsosurfaceOptions options{.cap = true, .verify = true};
    const auto expected = isosurface(own, values, 0.05, Projection{}, options);
    const auto all = isosurface(grid, field, 0.05, Projection{}, options);
    EXPECT_GT(expected.surface.simplices.size(), 5U);
    EXPECT_EQ(triangles_of(all.surface), triangles_of(expected.surface));
    const Projection coarse{.threshold = 0.6};
    const auto coarsest = isosurface(grid, field, 0.05, coarse, options);
    expect_closed(coarsest.surface, true);
    return {coarsest.counts.visited, isosurface(own, values, 0.05, coarse).counts.visited};
}

TEST(GatheredRoots, HaveTheSurfacesOfAllDataOfTheirGrid) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        for (const int side : {1, 2, 3, 4, 6, 8}) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", side " + std::to_string(side));
            const CoarseGrid plane = quadrilaterals(side);
            const auto leaves = random_trees<2>(plane.element_count(), seed);
            if (side > 2) expect_same_surface(Trees<2>(plane, leaves), seed);
            if (side == 1) continue;
            const CoarseGrid space = hexahedra(side);
            const auto trees = random_trees<3>(space.element_count(), seed);
            expect_same_surface(Trees<3>(space, trees), seed);
            const Trees<3> grid(space, trees);
            EXPECT_EQ(GatheredRoots(grid).levels_above(), std::countr_zero(unsigned(side)));
        }
    }
}

/// Where a part is hidden, no root that has it stops.
TEST(GatheredRoots, HideWhatTheirGridHides) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const CoarseGrid coarse = hexahedra(4);
        const auto trees = random_trees<3>(coarse.element_count(), seed);
        std::size_t leaves = 0;
        for (const auto& tree : trees) leaves += tree.size();
        std::vector<bool> is_hidden(leaves);
        for (std::size_t i = leaves / 3; i < leaves / 2; ++i) is_hidden[i] = true;
        expect_same_surface(Trees<3>(coarse, trees, is_hidden), seed);
    }
}

/// Half of the trees are there: a smaller cube is gathered where not all of a large one are.
TEST(GatheredRoots, TakeCubesThatTheirGridHasWholly) {
    const CoarseGrid all = hexahedra(4);
    for (const int kept : {2, 3}) {
        CoarseGrid part;
        part.dimension = 3;
        part.nodes = all.nodes;
        for (std::size_t i = 0; i < all.element_count(); ++i) {
            const Point low = all.positions(i)[0];
            if (low[0] < kept / 4.0 - 0.1 || low[2] < 0.4) part.add(all.shapes[i], all.element(i));
        }
        const auto trees = random_trees<3>(part.element_count(), 3);
        const Trees<3> grid(part, trees);
        EXPECT_EQ(GatheredRoots(grid).levels_above(), kept == 2 ? 1 : 0);
        expect_same_surface(grid, 3);
    }
}

TEST(GatheredRoots, LeaveWhatIsNoLattice) {
    const CoarseGrid coarse = shaken(hexahedra(4), 1, 0.1);
    const auto trees = random_trees<3>(coarse.element_count(), 1);
    const Trees<3> grid(coarse, trees);
    EXPECT_EQ(GatheredRoots(grid).levels_above(), 0);
    expect_same_surface(grid, 1);
}

/// A surface of few triangles looks at few of the coarse elements.
TEST(GatheredRoots, AreVisitedWhereTheSurfaceIs) {
    const CoarseGrid coarse = hexahedra(16);
    std::vector<std::vector<Octant>> trees(coarse.element_count(), {{0, 0, 0, 0}});
    const Trees<3> own(coarse, trees);
    std::vector<double> cells;
    for (std::size_t i = 0; i < coarse.element_count(); ++i) {
        const auto corners = coarse.positions(i);
        cells.push_back(0.5 * (corners[0][0] + corners[7][0]));
    }
    const CellAverages values(own, [&](const auto& leaf) { return cells[own.leaf_index(leaf)]; });
    const GatheredRoots grid(own);
    const GatheredField field(grid, values);
    const Projection coarsest{.threshold = 1e-3};  // the data are linear
    EXPECT_EQ(isosurface(own, values, 0.4, coarsest).counts.visited, 256U);
    EXPECT_EQ(isosurface(grid, field, 0.4, coarsest).counts.visited, 1U);
    EXPECT_EQ(isosurface(own, values, 0.4, coarsest).counts.calls, 4096U);
    EXPECT_LE(isosurface(grid, field, 0.4, coarsest).counts.calls, 8U);
}

}  // namespace gathered_roots_test
