// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What changed is refused: whatever was made for a grid, and is used after the grid was refined,
// says so in a sentence, on every family. Made anew, it works.
#include <nestgrid/adapters/union.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/compressed_field.hpp>

#include "changed_laws.hpp"
#include "families.hpp"

using namespace nestgrid_test;

namespace changed_grid_test {

double f(const Point& x) { return x[0] + x[1] * x[1] - 0.4; }

template <class Family>
class ChangedGrids : public testing::Test {};
TYPED_TEST_SUITE(ChangedGrids, Families);

TYPED_TEST(ChangedGrids, AreRefusedByWhatWasMadeForThem) {
    using Grid = typename TypeParam::Grid;
    using Field = NodeField<Grid, double>;
    for (Grid& grid : TypeParam::grids()) {
        const std::vector<double> values = sample_nodes(grid, f);
        const Field field(grid, values);
        MadeOnce<Grid, Field> before(grid, field);
        const CellAverages averages(grid, [](const ElementOf<Grid>&) { return 1.0; });
        const CompressedValues<double> compressed(erase(grid, field));
        const CompressedField<Grid, double> decoded(grid, compressed);
        refine_at_sphere(grid, 1);
        const std::vector<double> finer_values = sample_nodes(grid, f);
        const Field finer(grid, finer_values);
        expect_refused_after_change(before, grid, finer);
        expect_changed("averages", [&] { HierarchicalIndicator(grid, averages); });
        expect_changed("compressed field", [&] { HierarchicalIndicator(grid, decoded); });
        expect_usable(grid, finer);
    }
}

/// Another grid in the place of the first one is a change, too, although it was adapted as often.
TYPED_TEST(ChangedGrids, AreRefusedWhenTheyAreReplaced) {
    using Grid = typename TypeParam::Grid;
    using Field = NodeField<Grid, double>;
    Grid grid = std::move(TypeParam::grids().front());
    grid.adapt([](const Leaf&) { return Mark::refine; });
    const std::vector<double> values = sample_nodes(grid, f);
    const Field field(grid, values);
    MadeOnce<Grid, Field> before(grid, field);
    Grid other = std::move(TypeParam::grids().front());
    other.adapt([](const Leaf&) { return Mark::keep; });
    grid = std::move(other);
    ASSERT_NE(grid.node_count(), values.size());
    const std::vector<double> other_values = sample_nodes(grid, f);
    expect_refused_after_change(before, grid, Field(grid, other_values));
}

/// One frame that was told of the change does not make the others those of the grid.
TEST(ChangedGridCases, EveryFrameCounts) {
    OctreeGrid<3> grid(hexahedra(2));
    const std::vector<double> values = sample_nodes(grid, f);
    const NodeField<OctreeGrid<3>, double> field(grid, values);
    HierarchicalIndicator first(grid, field);
    const HierarchicalIndicator second(grid, field);
    const KeyFrames frames({&first, &second}, std::array{1.0F, 0.0F});
    refine_at_sphere(grid, 1);
    const std::vector<double> finer_values = sample_nodes(grid, f);
    const NodeField<OctreeGrid<3>, double> finer(grid, finer_values);
    first = HierarchicalIndicator(grid, finer);
    expect_changed("frames", [&] { isosurface(grid, finer, 0.1, under(Exact{}, frames)); });
}

TEST(ChangedGridCases, UnionsRefuseChangedSides) {
    OctreeGrid<3> grid(hexahedra(2));
    OctreeGrid<3> other(hexahedra(2));
    refine_at_sphere(other, 2);
    const auto one = [](const Point&) { return 1.0; };
    const std::vector<double> values = sample_nodes(grid, one);
    const std::vector<double> other_values = sample_nodes(other, one);
    const NodeField<OctreeGrid<3>, double> field(grid, values);
    const NodeField<OctreeGrid<3>, double> other_field(other, other_values);
    const Union both(grid, field, other, other_field);
    refine_at_sphere(other, 1);
    auto context = both.make_context();
    EXPECT_EQ(refusal<GridError>([&] { both.coarse(0, context); }),
              "the grid has changed since the union was made for it: make another one");
}

/// Compressed values do not know their grid, but how many nodes it had.
TEST(ChangedGridCases, CompressedValuesOfFewerNodesAreRefused) {
    OctreeGrid<3> grid(hexahedra(1));
    const std::vector<double> values = sample_nodes(grid, f);
    const NodeField<OctreeGrid<3>, double> field(grid, values);
    const CompressedValues<double> compressed(erase(grid, field));
    grid.adapt([](const Leaf&) { return Mark::refine; });
    EXPECT_EQ(refusal([&] { CompressedField(grid, compressed); }),
              "the compressed values are those of 8 nodes, but the grid has 27");
}

}  // namespace changed_grid_test
